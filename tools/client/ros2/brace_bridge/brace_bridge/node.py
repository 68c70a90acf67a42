"""ros2 run brace_bridge brace_bridge --ros-args -p bus:=can0: a topic limb_N/stiffness for each controller heard, with
a coxa joint limb_N/stiffness_in_space too, where they are sent (controller.load_hz, sigma_hz) limb_N/load and
limb_N/uncertainty, and on /diagnostics each limb's faults and the cause of a drift. With a stance the topic stance too:
what each foot bears, what is carried, which foot lets go next.

Parameters: bus (can0, slcan:/dev/ttyACM0, tcp://host:port), frame_prefix ("limb_": header.frame_id is limb_N),
base_frame ("base_link": header.frame_id of K in space and of the stance), stance (a stance.toml; "": none).
"""

from __future__ import annotations

import sys
import threading
from dataclasses import fields

import rclpy
from brace.bus.open import open_bus
from brace.bus.url import parse
from brace.ground.errors import BraceError
from brace_msgs.msg import LimbLoad as LimbLoadMessage
from brace_msgs.msg import LimbStiffness as LimbStiffnessMessage
from brace_msgs.msg import LimbStiffnessInSpace as LimbStiffnessInSpaceMessage
from brace_msgs.msg import LimbUncertainty as LimbUncertaintyMessage
from brace_msgs.msg import Stance as StanceMessage
from brace_msgs.msg import StanceFoot as StanceFootMessage
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from geometry_msgs.msg import Vector3
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import qos_profile_sensor_data

from brace_bridge.decode import (
    Decoder,
    LimbHealth,
    LimbLoad,
    LimbStiffness,
    LimbStiffnessInSpace,
    LimbUncertainty,
    Message,
)
from brace_bridge.stance import Stance, StanceDecoder, Vector

WAIT_S = 0.2
DIAGNOSTICS_KEPT = 10


class Bridge(Node):
    """Frames in, messages out."""

    def __init__(self) -> None:
        super().__init__("brace_bridge")
        where = self.declare_parameter("bus", "can0").value
        self._bus = open_bus(parse(where))
        path = self.declare_parameter("stance", "").value
        self._stance = StanceDecoder(path, where) if path else None
        self._prefix = self.declare_parameter("frame_prefix", "limb_").value
        self._base_frame = self.declare_parameter("base_frame", "base_link").value
        self._decoder = Decoder()
        self._topics: dict[str, Publisher] = {}
        self.failure: Exception | None = None
        self._listener = threading.Thread(target=self._listen, daemon=True)
        self._listener.start()

    def _listen(self) -> None:
        try:
            while rclpy.ok():
                frame = self._bus.receive(WAIT_S)
                if frame is None:
                    continue
                for message in self._decoder.add(frame):
                    self._publish(message)
                stance = None if self._stance is None else self._stance.add(frame)
                if stance is not None:
                    topic = self._topic("stance", StanceMessage, qos_profile_sensor_data)
                    topic.publish(_stance_message(stance, self._base_frame))
        except Exception as error:  # a bridge that no longer listens must not seem to live
            self.failure = error
            rclpy.try_shutdown()

    def _publish(self, message: Message) -> None:
        limb = f"limb_{message.node}"
        if isinstance(message, LimbStiffness):
            topic = self._topic(f"{limb}/stiffness", LimbStiffnessMessage, qos_profile_sensor_data)
            topic.publish(_filled(LimbStiffnessMessage(), message, f"{self._prefix}{message.node}"))
        elif isinstance(message, LimbStiffnessInSpace):
            topic = self._topic(f"{limb}/stiffness_in_space", LimbStiffnessInSpaceMessage, qos_profile_sensor_data)
            topic.publish(_filled(LimbStiffnessInSpaceMessage(), message, self._base_frame))
        elif isinstance(message, LimbLoad):
            topic = self._topic(f"{limb}/load", LimbLoadMessage, qos_profile_sensor_data)
            topic.publish(_filled(LimbLoadMessage(), message, f"{self._prefix}{message.node}"))
        elif isinstance(message, LimbUncertainty):
            topic = self._topic(f"{limb}/uncertainty", LimbUncertaintyMessage, qos_profile_sensor_data)
            topic.publish(_filled(LimbUncertaintyMessage(), message, f"{self._prefix}{message.node}"))
        else:
            self._topic("/diagnostics", DiagnosticArray, DIAGNOSTICS_KEPT).publish(_diagnostic(limb, message))

    def _topic(self, name: str, kind: type, qos: object) -> Publisher:
        if name not in self._topics:
            self._topics[name] = self.create_publisher(kind, name, qos)
        return self._topics[name]


def _seconds(stamp_s: float) -> tuple[int, int]:
    """Whole seconds and nanoseconds."""
    return int(stamp_s), int(stamp_s % 1.0 * 1e9)


def _filled(
    message: LimbStiffnessMessage | LimbStiffnessInSpaceMessage | LimbLoadMessage | LimbUncertaintyMessage,
    stiffness: LimbStiffness | LimbStiffnessInSpace | LimbLoad | LimbUncertainty,
    frame_id: str,
) -> LimbStiffnessMessage | LimbStiffnessInSpaceMessage | LimbLoadMessage | LimbUncertaintyMessage:
    message.header.stamp.sec, message.header.stamp.nanosec = _seconds(stiffness.stamp_s)
    message.header.frame_id = frame_id
    for field in fields(stiffness):
        if field.name != "stamp_s":
            setattr(message, field.name, getattr(stiffness, field.name))
    return message


def _stance_message(stance: Stance, frame_id: str) -> StanceMessage:
    message = StanceMessage()
    message.header.stamp.sec, message.header.stamp.nanosec = _seconds(stance.stamp_s)
    message.header.frame_id = frame_id
    for foot in stance.feet:
        one = StanceFootMessage()
        for field in fields(foot):
            if field.name != "force":
                setattr(one, field.name, getattr(foot, field.name))
        _set(one.force, foot.force)
        message.feet.append(one)
    _set(message.carried.force, stance.carried[0])
    _set(message.carried.torque, stance.carried[1])
    for name in ("carried_sigma", "displacement", "rotation"):
        _set(getattr(message, name), getattr(stance, name))
    message.next_to_let_go, message.further_payload_factor = stance.next_to_let_go, stance.further_payload_factor
    return message


def _set(message: Vector3, vector: Vector) -> None:
    message.x, message.y, message.z = vector


def _diagnostic(limb: str, health: LimbHealth) -> DiagnosticArray:
    array, status = DiagnosticArray(), DiagnosticStatus()
    array.header.stamp.sec, array.header.stamp.nanosec = _seconds(health.stamp_s)
    status.level = bytes([health.level])  # a ROS byte
    status.name = f"brace: {limb}"
    status.hardware_id = limb
    status.message = health.text
    values = {"faults": " ".join(health.faults) or "none", "drift_cause": health.drift_cause or "not reported yet"}
    status.values = [KeyValue(key=key, value=value) for key, value in values.items()]
    array.status = [status]
    return array


def main() -> int:
    """Until Ctrl-C, or the bus has gone."""
    rclpy.init()
    try:
        bridge = Bridge()
        rclpy.spin(bridge)
        failure = bridge.failure
    except KeyboardInterrupt:
        return 130
    except BraceError as error:
        failure = error
    if isinstance(failure, BraceError):
        print(failure.render(), file=sys.stderr)
        return failure.exit_code
    if failure is not None:
        raise failure
    return 0


if __name__ == "__main__":
    sys.exit(main())
