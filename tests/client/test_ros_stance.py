"""The bridge's message of a stance, from the frames of a simulated robot, without ROS."""

from __future__ import annotations

import contextlib
import json
import math
import re
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import fields
from types import ModuleType, SimpleNamespace

import pytest
from conftest import PROJECT

ROS = PROJECT / "tools" / "client" / "ros2"
sys.path.insert(0, str(ROS / "brace_bridge"))

from brace_bridge.stance import Stance, StanceDecoder, StanceFoot  # noqa: E402

from brace.bus.open import open_bus  # noqa: E402
from brace.bus.url import parse  # noqa: E402

STANCE = PROJECT / "examples" / "stance" / "stance.toml"
NAMES = ["front left", "front right", "rear left", "rear right"]
START_S = 60.0
WEIGHT_N = 30.0 + 4 * 1.7  # of body and limbs


@contextlib.contextmanager
def robot() -> Iterator[str]:
    """A simulated robot in step with the clock, without a payload; where its bus is."""
    command = [sys.executable, "-m", "brace", "sim", "--stance", STANCE, "--json", "--modbus", "none",
               "--can", "tcp://127.0.0.1:0", "--payload", "0@0", "--seconds", "300"]  # fmt: skip
    process = subprocess.Popen([str(part) for part in command], stdout=subprocess.PIPE, text=True)
    try:
        assert process.stdout is not None
        yield str(json.loads(process.stdout.readline())["limbs"][0]["can"])
    finally:
        process.kill()
        process.wait()


@pytest.fixture(scope="module")
def message() -> Stance:
    with robot() as where:
        bus, decoder = open_bus(parse(where)), StanceDecoder(str(STANCE), where)
        until = time.monotonic() + START_S
        found = None
        while found is None and time.monotonic() < until:
            frame = bus.receive(0.2)
            found = None if frame is None else decoder.add(frame)
        bus.close()
    assert found is not None
    return found


@pytest.mark.parametrize("kind", [Stance, StanceFoot])
def test_fields_are_the_messages(kind: type) -> None:
    text = (ROS / "brace_msgs" / "msg" / f"{kind.__name__}.msg").read_text()
    named = re.findall(r"^(?!std_msgs)[\w/]+(?:\[\d*\])? +([a-z]\w*) *(?:#|$)", text, re.MULTILINE)
    assert named == [field.name for field in fields(kind) if field.name != "stamp_s"]


def test_the_feet_bear_the_weight_in_si_units(message: Stance) -> None:
    assert [foot.name for foot in message.feet] == NAMES and [foot.node for foot in message.feet] == [1, 2, 3, 4]
    half_n = 1.645 * sum(math.sqrt(foot.force_covariance[8]) for foot in message.feet)
    assert abs(sum(foot.force[2] for foot in message.feet) - WEIGHT_N) < half_n < 0.3 * WEIGHT_N
    for foot in message.feet:
        covariance = [foot.force_covariance[3 * i : 3 * i + 3] for i in range(3)]
        assert all(covariance[i][j] == pytest.approx(covariance[j][i]) for i in range(3) for j in range(3))
        assert foot.is_down and foot.margin > 0.0 and foot.margin_sigma > 0.0 and foot.age < 1.0
    assert max(map(abs, message.displacement)) < 1e-3  # m, at the start
    assert max(map(abs, message.carried[1])) < 3.0  # N m: a moment in N mm would be hundreds
    assert message.next_to_let_go in NAMES and message.further_payload_factor > 1.0


def test_the_node_publishes_it(monkeypatch: pytest.MonkeyPatch, message: Stance) -> None:
    published: list[tuple[str, SimpleNamespace]] = []

    class StandInNode:
        def __init__(self, name: str) -> None:
            pass

        def declare_parameter(self, name: str, default: str) -> SimpleNamespace:
            return SimpleNamespace(value={"bus": "can0", "stance": str(STANCE)}.get(name, default))

        def create_publisher(self, kind: type, topic: str, qos: object) -> SimpleNamespace:
            return SimpleNamespace(publish=lambda message: published.append((topic, message)))

    def module(name: str, **content: object) -> None:
        made = ModuleType(name)
        made.__dict__.update(content)
        monkeypatch.setitem(sys.modules, name, made)

    def vector() -> SimpleNamespace:
        return SimpleNamespace(x=0.0, y=0.0, z=0.0)

    def stance_message() -> SimpleNamespace:
        header = SimpleNamespace(stamp=SimpleNamespace(sec=0, nanosec=0), frame_id="")
        carried = SimpleNamespace(force=vector(), torque=vector())
        return SimpleNamespace(header=header, feet=[], carried=carried, carried_sigma=vector(), displacement=vector(),
                               rotation=vector())  # fmt: skip

    running = iter([True, False])
    module("rclpy", ok=lambda: next(running), try_shutdown=lambda: None)
    module("rclpy.node", Node=StandInNode)
    module("rclpy.publisher", Publisher=object)
    module("rclpy.qos", qos_profile_sensor_data=object())
    module("brace_msgs")
    module("brace_msgs.msg", LimbLoad=object, LimbStiffness=object, LimbStiffnessInSpace=object,
           LimbUncertainty=object, Stance=stance_message, StanceFoot=lambda: SimpleNamespace(force=vector()))
    module("diagnostic_msgs")
    module("diagnostic_msgs.msg", DiagnosticArray=object, DiagnosticStatus=object, KeyValue=object)
    module("geometry_msgs")
    module("geometry_msgs.msg", Vector3=SimpleNamespace)
    sys.modules.pop("brace_bridge.node", None)
    import brace_bridge.node as bridge

    monkeypatch.setattr(bridge, "open_bus", lambda url: SimpleNamespace(receive=lambda timeout_s: object()))
    monkeypatch.setattr(bridge.Decoder, "add", lambda self, frame: [])
    monkeypatch.setattr(bridge.StanceDecoder, "add", lambda self, frame: message)
    node = bridge.Bridge()
    node._listener.join(timeout=5)
    sys.modules.pop("brace_bridge.node", None)
    assert node.failure is None
    ((topic, sent),) = published
    assert topic == "stance" and sent.header.frame_id == "base_link"
    assert sent.header.stamp.sec == int(message.stamp_s)
    foot = sent.feet[2]
    assert (foot.name, foot.force.z, foot.force_covariance) == (
        "rear left", message.feet[2].force[2], message.feet[2].force_covariance
    )  # fmt: skip
    assert sent.carried.torque.y == message.carried[1][1] and sent.next_to_let_go == message.next_to_let_go
