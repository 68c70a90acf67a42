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

from brace_bridge.decode import ERROR, OK, WARN, Decoder, LimbHealth, LimbLoad  # noqa: E402
from brace_bridge.decode import LimbStiffness, LimbStiffnessInSpace, LimbUncertainty  # noqa: E402

from brace.bus.frame import Frame  # noqa: E402
from brace.wire.frames import DICTIONARY_HASH, GROUPS, MESSAGES  # noqa: E402


def frame(name: str, node: int = 3, time_s: float = 100.0, **values: float | None) -> Frame:
    layout = GROUPS[name][0] if name in GROUPS else MESSAGES[name]
    filled = {field.name: values.get(field.name, 0) for field in layout.fields}
    return Frame(time_s, layout.identifier + node, layout.encode(filled))


def whole(sequence: int = 7, **changes: float | None) -> list[LimbStiffness]:
    decoder = Decoder()
    frames = [
        frame("condition", faults=0b10000001),
        frame("stiffness_a", sequence=sequence, age=2.0, **{"k_xx": 4.0, "k_xz": -0.5, **changes}),
        frame("stiffness_b", sequence=sequence, k_zz=0.25, flags=0b1001, play_femur=2, play_tibia=4, mode=1),
        frame("eigenvalues", sequence=sequence, lambda_min=0.2, lambda_max=4.1, stiff_axis=-0.13),
        frame("posture", sequence=sequence, theta1=1.0, theta2=1.4, parameter_tag=1),
    ]
    messages = [message for one in frames for message in decoder.add(one)][1:]
    assert all(isinstance(message, LimbStiffness) for message in messages)
    return messages  # type: ignore[return-value]


def space_frames(sequence: int = 7, node: int = 3, time_s: float = 100.0, **changes: float | None) -> list[Frame]:
    values = {"sequence": sequence, "flags": 8, "age": 2.0, "play_coxa": 3, "theta0": 0.25, "k_across": 0.5}
    values |= {"k_xx": 4.0, "k_xy": -1.5, "k_xz": -0.5, "k_yy": 0.75, "k_yz": 0.125, "k_zz": 0.25}
    values |= {"lambda_1": 0.2, "lambda_2": 0.5, "lambda_3": 4.5}
    values |= {"stiff_axis_x": 1.0, "stiff_axis_y": -0.5, "stiff_axis_z": 0.0, **changes}
    return [Frame(time_s, layout.identifier + node, layout.encode(values)) for layout in GROUPS["space"]]


def load_frames(sequence: int = 7, node: int = 3, time_s: float = 100.0, **changes: float | None) -> list[Frame]:
    values = {"sequence": sequence, "unloaded_k_xx": 4.5, "unloaded_k_xz": -0.25, "unloaded_k_zz": 0.5}
    values |= {"counted_force_x": 2.0, "counted_force_z": -3.0, "moved_x": 1.5, "moved_z": -12.0}
    values |= {"buckling_factor": 4.0, "gravity_direction": -1.5, "gravity_lean": 0.25, "flags": 0, **changes}
    return [Frame(time_s, layout.identifier + node, layout.encode(values)) for layout in GROUPS["load"]]


def across_frames(sequence: int = 7, node: int = 3, time_s: float = 100.0, **changes: float | None) -> list[Frame]:
    values = {"sequence": sequence, "counted_force_y": -2.5, "moved_y": -7.0, "unloaded_k_across": 0.5, "flags": 0}
    values |= changes
    return [Frame(time_s, layout.identifier + node, layout.encode(values)) for layout in GROUPS["load_across"]]


@pytest.mark.parametrize("kind", [LimbStiffness, LimbStiffnessInSpace, LimbLoad, LimbUncertainty])
def test_fields_are_the_messages(kind: type) -> None:
    text = (ROS / "brace_msgs" / "msg" / f"{kind.__name__}.msg").read_text()
    named = re.findall(r"^(?!std_msgs)\w+ +([a-z]\w*) *(?:#|$)", text, re.MULTILINE)
    assert named == [field.name for field in fields(kind) if field.name != "stamp_s"]


@pytest.mark.parametrize("kind", [LimbStiffness, LimbStiffnessInSpace])
def test_constants_are_the_dictionarys(kind: type) -> None:
    text = (ROS / "brace_msgs" / "msg" / f"{kind.__name__}.msg").read_text()
    constants = {name: int(value) for name, value in re.findall(r"^uint(?:8|16) ([A-Z_]+)=(\d+)", text, re.MULTILINE)}
    of = {(name, field.name): field for name, layout in MESSAGES.items() for field in layout.fields}
    wanted = {f"FLAG_{name}": 1 << bit for bit, name in enumerate(of["stiffness_b", "flags"].bit_names)}
    wanted |= {f"PLAY_{name}": code for code, name in of["stiffness_b", "play_femur"].names.items()}
    if kind is LimbStiffness:
        wanted |= {f"MODE_{name}": code for code, name in of["stiffness_b", "mode"].names.items()}
    assert constants == wanted


def test_a_whole_snapshot_in_si_units() -> None:
    first, last = whole()
    assert (first.has_posture, first.mode) == (False, 1) and math.isnan(first.theta1)
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
    assert decoder.add(frame("stiffness_a", sequence=1)) == []
    assert decoder.add(frame("stiffness_b", sequence=2)) == []


def test_a_controller_with_another_dictionary_is_reported_and_not_read() -> None:
    decoder = Decoder()
    assert decoder.add(frame("heartbeat", dictionary_hash=DICTIONARY_HASH)) == []
    [health] = decoder.add(frame("condition"))
    assert isinstance(health, LimbHealth) and (health.level, health.text) == (OK, "No fault is there.")
    k = [frame("stiffness_a", sequence=1, k_xx=4.0), frame("stiffness_b", sequence=1, k_zz=0.25)]
    [health] = decoder.add(frame("heartbeat", dictionary_hash=0x1234ABCD))
    assert isinstance(health, LimbHealth) and health.level == ERROR
    assert "0x1234abcd" in health.text and f"0x{DICTIONARY_HASH:08x}" in health.text
    assert [decoder.add(one) for one in k] == [[], []]
    decoder.add(frame("heartbeat", dictionary_hash=DICTIONARY_HASH))  # flashed
    assert decoder.add(k[0]) == [] and len(decoder.add(k[1])) == 1


def test_k_in_space_in_si_units() -> None:
    decoder = Decoder()
    a, b = frame("stiffness_a", sequence=7, k_xx=4.0, age=2.0), frame("stiffness_b", sequence=7)
    messages = [m for one in (a, b, *space_frames()) for m in decoder.add(one)]
    assert [type(m) for m in messages] == [LimbStiffness, LimbStiffnessInSpace]
    space = messages[1]
    assert isinstance(space, LimbStiffnessInSpace) and space.k_is_valid and (space.node, space.sequence) == (3, 7)
    reported = (space.k_xx, space.k_xy, space.k_xz, space.k_yy, space.k_yz, space.k_zz)
    assert reported == pytest.approx((4000.0, -1500.0, -500.0, 750.0, 125.0, 250.0))
    assert (space.lambda_1, space.lambda_2, space.lambda_3) == pytest.approx((200.0, 500.0, 4500.0))
    assert (space.stiff_axis_x, space.stiff_axis_y, space.stiff_axis_z) == pytest.approx((1.0, -0.5, 0.0))
    assert (space.theta0, space.k_across) == pytest.approx((0.25, 500.0))
    assert (space.flags, space.play_coxa) == (8, 3) and space.stamp_s == pytest.approx(100.0 - 0.002)


def test_k_in_space_that_comes_first_is_given_with_its_k_in_the_plane() -> None:
    decoder = Decoder()
    a, b = frame("stiffness_a", sequence=7, k_xx=4.0, age=2.0), frame("stiffness_b", sequence=7)
    messages = [m for one in (a, *space_frames(k_yz=None), b) for m in decoder.add(one)]
    assert [type(m) for m in messages] == [LimbStiffness, LimbStiffnessInSpace]
    assert isinstance(messages[1], LimbStiffnessInSpace)
    assert not messages[1].k_is_valid and math.isnan(messages[1].k_yz)


@pytest.mark.parametrize("comes_first", [True, False])
def test_a_load_in_si_units(comes_first: bool) -> None:
    """Before its K, as its identifier is the lower one, or behind it: given once, and its K once."""
    decoder = Decoder()
    k = [frame("stiffness_a", sequence=7, k_xx=4.0, age=2.0), frame("stiffness_b", sequence=7)]
    frames = [*load_frames(), *k] if comes_first else [*k, *load_frames()]
    messages = [m for one in frames for m in decoder.add(one)]
    assert [type(m) for m in messages] == [LimbStiffness, LimbLoad]
    load = messages[1]
    assert isinstance(load, LimbLoad) and load.is_counted and (load.node, load.sequence) == (3, 7)
    assert (load.force_x, load.force_z, load.moved_x, load.moved_z) == pytest.approx((2.0, -3.0, 0.0015, -0.012))
    unloaded = (load.unloaded_k_xx, load.unloaded_k_xz, load.unloaded_k_zz)
    assert (load.buckling_factor, *unloaded) == pytest.approx((4.0, 4500.0, -250.0, 500.0))
    assert (load.gravity_direction, load.gravity_lean) == pytest.approx((-1.5, 0.25))
    assert load.stamp_s == pytest.approx(100.0 - 0.002)


def test_a_load_that_is_not_counted_is_nan() -> None:
    decoder = Decoder()
    k = [frame("stiffness_a", sequence=7, k_xx=4.0), frame("stiffness_b", sequence=7, flags=64)]
    frames = [*load_frames(counted_force_x=None, counted_force_z=None, buckling_factor=math.nan), *k]
    load = [m for one in frames for m in decoder.add(one)][1]
    assert isinstance(load, LimbLoad) and not load.is_counted
    assert math.isnan(load.force_x) and math.isnan(load.buckling_factor)


@pytest.mark.parametrize("order", [(0, 1, 2), (1, 0, 2), (2, 0, 1), (0, 2, 1)])
def test_the_load_across_the_plane_comes_with_the_load(order: tuple[int, ...]) -> None:
    """Whichever comes first, the load is given once and whole: one across has come before, so it is waited for. Of a
    node that sends it no more the load comes without it, from the second one on."""
    decoder = Decoder()

    def messages_of(sequence: int, with_across: bool = True) -> list[object]:
        k = [frame("stiffness_a", sequence=sequence, k_xx=4.0), frame("stiffness_b", sequence=sequence)]
        parts = (load_frames(sequence), across_frames(sequence) if with_across else [], k)
        return [m for i in order for one in parts[i] for m in decoder.add(one)]

    messages_of(6)
    messages = messages_of(7)
    assert sorted(type(m).__name__ for m in messages) == ["LimbLoad", "LimbStiffness"]
    load = next(m for m in messages if isinstance(m, LimbLoad))
    assert (load.force_x, load.force_y, load.moved_y) == pytest.approx((2.0, -2.5, -0.007))
    assert load.unloaded_k_across == pytest.approx(500.0)
    assert LimbLoad not in [type(m) for m in messages_of(8, with_across=False)]
    later = [m for m in messages_of(9, with_across=False) if isinstance(m, LimbLoad)]
    assert len(later) == 1 and math.isnan(later[0].force_y) and later[0].force_x == pytest.approx(2.0)


def test_an_uncertainty_in_si_units_and_k_but_once() -> None:
    decoder = Decoder()
    k = [frame("stiffness_a", sequence=7, k_xx=4.0, age=2.0), frame("stiffness_b", sequence=7)]
    values = {"sequence": 7, "k_xx": 0.1, "k_xz": 0.05, "k_zz": 0.2}
    values |= {"lambda_min": 0.01, "lambda_max": 0.3, "stiff_axis": 0.25}
    sigma = [Frame(100.0, layout.identifier + 3, layout.encode(values)) for layout in GROUPS["sigma"]]
    messages = [m for one in (*k, *sigma) for m in decoder.add(one)]
    assert [type(m) for m in messages] == [LimbStiffness, LimbUncertainty]
    reported = messages[1]
    assert isinstance(reported, LimbUncertainty) and (reported.node, reported.sequence, reported.stiff_axis) == (3, 7, 0.25)
    assert (reported.k_xx, reported.k_xz, reported.k_zz) == pytest.approx((100.0, 50.0, 200.0))
    assert (reported.lambda_min, reported.lambda_max) == pytest.approx((10.0, 300.0), rel=0.05)
    assert math.isnan(reported.space_k_yy) and math.isnan(reported.k_across)
    of_space = {"sequence": 7} | {f"k_{name}": 0.5 for name in ("xx", "xy", "xz", "yy", "yz", "zz", "across")}
    of_space |= {f"lambda_{number}": 0.4 for number in (1, 2, 3)}
    later = [m for layout in GROUPS["sigma_space"]
             for m in decoder.add(Frame(100.0, layout.identifier + 3, layout.encode(of_space)))]
    assert len(later) == 1 and isinstance(later[0], LimbUncertainty)
    assert (later[0].k_xx, later[0].space_k_yy, later[0].k_across) == pytest.approx((100.0, 500.0, 500.0))


def test_space_and_load_of_one_snapshot() -> None:
    decoder = Decoder()
    k = [frame("stiffness_a", sequence=7, k_xx=4.0, age=2.0), frame("stiffness_b", sequence=7)]
    messages = [m for one in (*load_frames(), *space_frames(), *k) for m in decoder.add(one)]
    assert [type(m) for m in messages] == [LimbStiffness, LimbStiffnessInSpace, LimbLoad]


def test_health_names_the_cause_of_a_drift() -> None:
    decoder = Decoder()
    drifted = 1 << 7
    [early] = decoder.add(frame("condition", faults=drifted))
    assert isinstance(early, LimbHealth) and (early.level, early.drift_cause) == (WARN, "")
    [health] = decoder.add(frame("emergency", error_code=0xFF01, drift_cause=1, faults=drifted))
    assert isinstance(health, LimbHealth) and health.faults == ("model_drift",) and health.drift_cause == "femur_link"
    assert "likeliest cause is femur_link: The femur's bending has changed." in health.text
    [later] = decoder.add(frame("condition", faults=drifted | 1))
    assert isinstance(later, LimbHealth) and (later.level, later.drift_cause) == (ERROR, "femur_link")
    [over] = decoder.add(frame("emergency", drift_cause=0, faults=0))
    assert isinstance(over, LimbHealth) and (over.level, over.drift_cause) == (OK, "none")


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
    frames += [*space_frames(sequence=1), *load_frames(sequence=1)]
    known = dict.fromkeys(("k_xx", "k_xz", "k_zz", "lambda_min", "lambda_max", "stiff_axis"), 0.1) | {"sequence": 1}
    frames += [Frame(100.0, layout.identifier + 3, layout.encode(known)) for layout in GROUPS["sigma"]]
    frames.append(frame("emergency", error_code=0xFF01, drift_cause=1, faults=1 << 7))
    running = iter([True] * (len(frames) + 1) + [False])
    module("rclpy", ok=lambda: next(running), try_shutdown=lambda: None)
    module("rclpy.node", Node=StandInNode)
    module("rclpy.publisher", Publisher=object)
    module("rclpy.qos", qos_profile_sensor_data=object())

    def message(**content: object) -> SimpleNamespace:
        stamp = SimpleNamespace(sec=0, nanosec=0)
        return SimpleNamespace(header=SimpleNamespace(stamp=stamp, frame_id=""), **content)

    module("brace_msgs")
    module("brace_msgs.msg", LimbLoad=message, LimbStiffness=message, LimbStiffnessInSpace=message,
           LimbUncertainty=message, Stance=message, StanceFoot=message)
    module("geometry_msgs")
    module("geometry_msgs.msg", Vector3=SimpleNamespace)
    module("diagnostic_msgs")
    module("diagnostic_msgs.msg", DiagnosticArray=message, DiagnosticStatus=message, KeyValue=SimpleNamespace)
    sys.modules.pop("brace_bridge.node", None)
    import brace_bridge.node as bridge

    bus = SimpleNamespace(receive=lambda timeout_s: frames.pop(0) if frames else None)
    monkeypatch.setattr(bridge, "open_bus", lambda url: bus)
    node = bridge.Bridge()
    node._listener.join(timeout=5)
    assert node.failure is None
    topics = [topic for topic, _ in published]
    limb = ["stiffness", "stiffness_in_space", "load", "uncertainty"]
    assert topics == [*(f"limb_3/{name}" for name in limb), "/diagnostics"]
    plane, space, load, sigma, diagnostic = (content for _, content in published)
    assert (plane.header.frame_id, space.header.frame_id) == ("limb_3", "base_link") and plane.header.stamp.sec == 100
    assert (plane.k_xx, plane.k_zz) == pytest.approx((4000.0, 250.0)) and space.k_xy == pytest.approx(-1500.0)
    assert load.header.frame_id == "limb_3" and load.force_z == pytest.approx(-3.0)
    assert sigma.header.frame_id == "limb_3" and sigma.k_zz == pytest.approx(100.0)
    [status] = diagnostic.status
    assert (status.level, status.hardware_id) == (bytes([WARN]), "limb_3") and "femur_link" in status.message
    assert {pair.key: pair.value for pair in status.values} == {"faults": "model_drift", "drift_cause": "femur_link"}


@pytest.mark.parametrize(
    ("name", "build", "needed"),
    [
        ("brace_msgs", "ament_cmake", {"geometry_msgs", "std_msgs"}),
        ("brace_bridge", "ament_python", {"brace_msgs", "diagnostic_msgs", "geometry_msgs", "rclpy"}),
    ],
)
def test_packages_as_ros_reads_them(name: str, build: str, needed: set[str]) -> None:
    from catkin_pkg.package import parse_package  # what ament and colcon read package.xml with

    warnings: list[str] = []
    package = parse_package(str(ROS / name), warnings=warnings)
    package.validate(warnings=warnings)
    assert (package.name, package.get_build_type(), warnings) == (name, build, [])
    assert needed <= {d.name for d in package.exec_depends}
    assert (name == "brace_msgs") == ("rosidl_interface_packages" in [g.name for g in package.member_of_groups])
