"""ros2 run brace_bridge brace_bridge --ros-args -p bus:=can0: a topic limb_N/stiffness for each controller heard, with
a coxa joint limb_N/stiffness_in_space too, where they are sent (controller.load_hz, sigma_hz) limb_N/load and
limb_N/uncertainty, and on /diagnostics each limb's faults and the cause of a drift.

Parameters: bus (can0, slcan:/dev/ttyACM0, tcp://host:port), frame_prefix ("limb_": header.frame_id is limb_N),
base_frame ("base_link": header.frame_id of K in space).
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
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
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

WAIT_S = 0.2
DIAGNOSTICS_KEPT = 10


class Bridge(Node):
    """Frames in, messages out."""

    def __init__(self) -> None:
        super().__init__("brace_bridge")
        self._bus = open_bus(parse(self.declare_parameter("bus", "can0").value))
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
                for message in [] if frame is None else self._decoder.add(frame):
                    self._publish(message)
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
