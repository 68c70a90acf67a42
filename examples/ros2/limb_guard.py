"""A ROS 2 node that warns when a limb has become soft: it hears brace_bridge's limb_1/stiffness.

    ros2 run brace_bridge brace_bridge --ros-args -p bus:=can0      # tools/client/ros2, built in your workspace
    python3 limb_guard.py

The tests run it against a stand-in for rclpy, because ROS is not on the machines that test Brace.
"""

import math

import rclpy
from brace_msgs.msg import LimbStiffness
from rclpy.node import Node

SOFT_N_PER_M = 200.0  # your robot's own limit


class LimbGuard(Node):
    """Warns once each time the softest direction falls below the limit; K that is not valid counts as soft."""

    def __init__(self) -> None:
        super().__init__("limb_guard")
        self.is_soft = False
        self.create_subscription(LimbStiffness, "limb_1/stiffness", self.hear, 10)

    def hear(self, message: LimbStiffness) -> None:
        """One snapshot."""
        middle = (message.k_xx + message.k_zz) / 2
        softest = middle - math.hypot((message.k_xx - message.k_zz) / 2, message.k_xz)
        soft = not message.k_is_valid or softest < SOFT_N_PER_M
        if soft and not self.is_soft:
            what = f"{softest:.0f} N/m in its softest direction" if message.k_is_valid else "K is not valid"
            self.get_logger().warning(f"limb {message.node}: {what}")
        self.is_soft = soft


def main() -> None:
    """Runs until interrupted."""
    rclpy.init()
    rclpy.spin(LimbGuard())


if __name__ == "__main__":
    main()
