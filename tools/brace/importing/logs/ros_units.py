"""Units of ROS' common messages. Their definitions fix SI units (REP 103)."""

from __future__ import annotations

_UNITS = {
    "sensor_msgs/msg/JointState": {"position": "rad", "effort": "N m"},
    "geometry_msgs/msg/Wrench": {"force": "N", "torque": "N m"},
    "geometry_msgs/msg/WrenchStamped": {"force": "N", "torque": "N m"},
    "geometry_msgs/msg/Pose": {"position": "m"},
    "geometry_msgs/msg/PoseStamped": {"position": "m"},
    "geometry_msgs/msg/PoseWithCovarianceStamped": {"position": "m"},
    "geometry_msgs/msg/PointStamped": {"point": "m"},
    "geometry_msgs/msg/Vector3Stamped": {},
    "geometry_msgs/msg/TransformStamped": {"translation": "m"},
    "sensor_msgs/msg/Temperature": {"temperature": "degC"},
    "sensor_msgs/msg/Range": {"range": "m"},
}


def unit_of_field(schema: str, path: str) -> str:
    """The unit; empty where the type does not fix it. A JointState's position is of a hinge: rad."""
    of_type = _UNITS.get(schema, {})
    return next((of_type[part] for part in path.split(".") if part in of_type), "")
