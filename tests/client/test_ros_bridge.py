"""The ROS 2 bridge's decoding, without ROS; its node against a stand-in for rclpy."""

from __future__ import annotations

import math
import re
import sys
from dataclasses import fields
from types import ModuleType, SimpleNamespace

import pytest
from conftest import PROJECT

ROS = PROJECT / "tools" / "client" / "ros2"
sys.path.insert(0, str(ROS / "brace_bridge"))

from brace_bridge.decode import Decoder, LimbStiffness  # noqa: E402

from brace.bus.frame import Frame  # noqa: E402
from brace.errors import VersionMismatchError  # noqa: E402
from brace.wire.frames import DICTIONARY_HASH, MESSAGES  # noqa: E402


def frame(name: str, node: int = 3, time_s: float = 100.0, **values: float | None) -> Frame:
    layout = MESSAGES[name]
    filled = {field.name: values.get(field.name, 0) for field in layout.fields}
    return Frame(time_s, layout.identifier + node, layout.encode(filled))


def whole(sequence: int = 7, **changes: float | None) -> list[LimbStiffness]:
    decoder = Decoder()
    frames = [
        frame("stiffness_a", sequence=sequence, flags=0b1001, **{"k_xx": 4.0, "k_xz": -0.5, **changes}),
        frame("stiffness_b", sequence=sequence, k_zz=0.25, age=2.0, play_femur=2, play_tibia=4, parameter_tag=1),
        frame("eigenvalues", sequence=sequence, lambda_min=0.2, lambda_max=4.1, stiff_axis=-0.13),
        frame("posture", sequence=sequence, theta1=1.0, theta2=1.4, mode=1, faults=0b10000001),
    ]
    return [message for message in map(decoder.add, frames) if message is not None]


def test_fields_are_the_messages() -> None:
    text = (ROS / "brace_msgs" / "msg" / "LimbStiffness.msg").read_text()
    named = re.findall(r"^(?!std_msgs)\w+ +([a-z]\w*) *(?:#|$)", text, re.MULTILINE)
    assert named == [field.name for field in fields(LimbStiffness) if field.name != "stamp_s"]


def test_constants_are_the_dictionarys() -> None:
    text = (ROS / "brace_msgs" / "msg" / "LimbStiffness.msg").read_text()
    constants = {name: int(value) for name, value in re.findall(r"^uint8 ([A-Z_]+)=(\d+)", text, re.MULTILINE)}
    of = {(name, field.name): field for name, layout in MESSAGES.items() for field in layout.fields}
    wanted = {f"FLAG_{name}": 1 << bit for bit, name in enumerate(of["stiffness_a", "flags"].bit_names)}
    wanted |= {f"PLAY_{name}": code for code, name in of["stiffness_b", "play_femur"].names.items()}
    wanted |= {f"MODE_{name}": code for code, name in of["posture", "mode"].names.items()}
    assert constants == wanted


def test_a_whole_snapshot_in_si_units() -> None:
    first, last = whole()
    assert (first.has_posture, first.mode) == (False, 0) and math.isnan(first.theta1)
    assert last.k_is_valid and last.has_posture and last.node == 3 and last.sequence == 7
    assert (last.k_xx, last.k_xz, last.k_zz) == pytest.approx((4000.0, -500.0, 250.0))
    assert (last.lambda_min, last.lambda_max) == pytest.approx((200.0, 4100.0))
    assert (last.stiff_axis, last.theta1, last.theta2) == pytest.approx((-0.13, 1.0, 1.4))
    assert (last.flags, last.play_femur, last.play_tibia, last.mode, last.faults) == (0b1001, 2, 4, 1, 0b10000001)
    assert last.stamp_s == pytest.approx(100.0 - 0.002)


def test_unknown_is_nan_and_not_valid() -> None:
    last = whole(k_xx=None)[-1]
    assert not last.k_is_valid and math.isnan(last.k_xx)


def test_halves_of_two_snapshots_give_nothing() -> None:
    decoder = Decoder()
    assert decoder.add(frame("stiffness_a", sequence=1)) is None
    assert decoder.add(frame("stiffness_b", sequence=2)) is None


def test_another_dictionary_is_refused() -> None:
    decoder = Decoder()
    assert decoder.add(frame("heartbeat", dictionary_hash=DICTIONARY_HASH)) is None
    with pytest.raises(VersionMismatchError) as refusal:
        decoder.add(frame("heartbeat", dictionary_hash=0x1234ABCD))
    assert "0x1234abcd" in refusal.value.why and f"0x{DICTIONARY_HASH:08x}" in refusal.value.why


def test_the_node_publishes_what_is_decoded(monkeypatch: pytest.MonkeyPatch) -> None:
    published: list[tuple[str, SimpleNamespace]] = []

    class StandInNode:
        def __init__(self, name: str) -> None:
            assert name == "brace_bridge"

        def declare_parameter(self, name: str, default: str) -> SimpleNamespace:
            return SimpleNamespace(value={"bus": "can0"}.get(name, default))

        def create_publisher(self, kind: type, topic: str, qos: object) -> SimpleNamespace:
            return SimpleNamespace(publish=lambda message: published.append((topic, message)))

    def module(name: str, **content: object) -> None:
        made = ModuleType(name)
        made.__dict__.update(content)
        monkeypatch.setitem(sys.modules, name, made)

    frames = [frame("stiffness_a", sequence=1, k_xx=4.0), frame("stiffness_b", sequence=1, k_zz=0.25)]
    running = iter([True, True, True, False])
    module("rclpy", ok=lambda: next(running), try_shutdown=lambda: None)
    module("rclpy.node", Node=StandInNode)
    module("rclpy.publisher", Publisher=object)
    module("rclpy.qos", qos_profile_sensor_data=object())
    stamp = SimpleNamespace(sec=0, nanosec=0)
    module("brace_msgs")
    module("brace_msgs.msg", LimbStiffness=lambda: SimpleNamespace(header=SimpleNamespace(stamp=stamp, frame_id="")))
    sys.modules.pop("brace_bridge.node", None)
    import brace_bridge.node as bridge

    bus = SimpleNamespace(receive=lambda timeout_s: frames.pop(0) if frames else None)
    monkeypatch.setattr(bridge, "open_bus", lambda url: bus)
    node = bridge.Bridge()
    node._listener.join(timeout=5)
    assert node.failure is None
    [(topic, message)] = published
    assert topic == "limb_3/stiffness" and message.header.frame_id == "limb_3" and stamp.sec == 100
    assert (message.k_xx, message.k_zz) == pytest.approx((4000.0, 250.0))


@pytest.mark.parametrize(("name", "build", "needed"), [("brace_msgs", "ament_cmake", {"std_msgs"}),
                                                       ("brace_bridge", "ament_python", {"brace_msgs", "rclpy"})])
def test_packages_as_ros_reads_them(name: str, build: str, needed: set[str]) -> None:
    from catkin_pkg.package import parse_package  # what ament and colcon read package.xml with

    warnings: list[str] = []
    package = parse_package(str(ROS / name), warnings=warnings)
    package.validate(warnings=warnings)
    assert (package.name, package.get_build_type(), warnings) == (name, build, [])
    assert needed <= {d.name for d in package.exec_depends}
    assert (name == "brace_msgs") == ("rosidl_interface_packages" in [g.name for g in package.member_of_groups])
