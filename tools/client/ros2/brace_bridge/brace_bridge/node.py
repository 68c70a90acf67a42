"""ros2 run brace_bridge brace_bridge --ros-args -p bus:=can0: a topic limb_N/stiffness for each controller heard.

Parameters: bus (can0, slcan:/dev/ttyACM0, tcp://host:port), frame_prefix ("limb_": header.frame_id is limb_N).
"""

from __future__ import annotations

import sys
import threading
from dataclasses import fields

import rclpy
from brace.bus.open import open_bus
from brace.bus.url import parse
from brace.errors import BraceError
from brace_msgs.msg import LimbStiffness as LimbStiffnessMessage
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import qos_profile_sensor_data

from brace_bridge.decode import Decoder, LimbStiffness

WAIT_S = 0.2


class Bridge(Node):
    """Frames in, messages out."""

    def __init__(self) -> None:
        super().__init__("brace_bridge")
        self._bus = open_bus(parse(self.declare_parameter("bus", "can0").value))
        self._prefix = self.declare_parameter("frame_prefix", "limb_").value
        self._decoder = Decoder()
        self._topics: dict[int, Publisher] = {}
        self.failure: BraceError | None = None
        self._listener = threading.Thread(target=self._listen, daemon=True)
        self._listener.start()

    def _listen(self) -> None:
        try:
            while rclpy.ok():
                frame = self._bus.receive(WAIT_S)
                stiffness = None if frame is None else self._decoder.add(frame)
                if stiffness is not None:
                    self._topic(stiffness.node).publish(self._message(stiffness))
        except BraceError as error:
            self.failure = error
            rclpy.try_shutdown()

    def _topic(self, node: int) -> Publisher:
        if node not in self._topics:
            name = f"limb_{node}/stiffness"
            self._topics[node] = self.create_publisher(LimbStiffnessMessage, name, qos_profile_sensor_data)
        return self._topics[node]

    def _message(self, stiffness: LimbStiffness) -> LimbStiffnessMessage:
        message = LimbStiffnessMessage()
        whole_s = int(stiffness.stamp_s)
        message.header.stamp.sec = whole_s
        message.header.stamp.nanosec = int((stiffness.stamp_s - whole_s) * 1e9)
        message.header.frame_id = f"{self._prefix}{stiffness.node}"
        for field in fields(stiffness):
            if field.name != "stamp_s":
                setattr(message, field.name, getattr(stiffness, field.name))
        return message


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
    if failure is not None:
        print(failure.render(), file=sys.stderr)
        return failure.exit_code
    return 0


if __name__ == "__main__":
    sys.exit(main())
