"""The record of foreign_files as logs: a stage, a load cell and a controller, each with a rate of its own, written by
libraries that are not ours."""

from __future__ import annotations

import io
import json
import math
from collections.abc import Callable, Iterator
from pathlib import Path

import can
import cantools
from can.io.canutils import CanutilsLogWriter
from foreign_files import Record
from mcap.writer import Writer

START_S = 1_700_000_000.0
AROUND_S = 0.2  # the load cell is read so long before and after the stage
DBC = """VERSION ""
NS_ :
BS_:
BU_: RIG
BO_ 291 STAGE: 8 RIG
 SG_ PosX : 0|32@1- (0.0001,0) [-100|100] "mm" RIG
 SG_ PosZ : 32|32@1- (0.0001,0) [-100|100] "mm" RIG
BO_ 2147484708 LOADCELL: 8 RIG
 SG_ Fx : 0|32@1- (0.0001,0) [-200|200] "N" RIG
 SG_ Fz : 32|32@1- (0.0001,0) [-200|200] "N" RIG
BO_ 293 COMMAND: 4 RIG
 SG_ FemurAngle : 0|16@1- (0.01,0) [-180|180] "deg" RIG
 SG_ KneeAngle : 16|16@1- (0.01,0) [-180|180] "deg" RIG
BO_ 294 STATUS: 1 RIG
 SG_ Ok : 0|8@1+ (1,0) [0|255] "" RIG
"""
ELEVEN_BITS = DBC.replace("2147484708", "292")  # the load cell's identifier

Entry = tuple[float, str, dict[str, float]]


def entries(record: Record) -> Iterator[Entry]:
    """(time, message, values): the stage at each row, the load cell around it, the command at each new pose."""
    pose = None
    for row in range(record.rows):
        t = START_S + record["t"][row]
        fx, fz = record["fx"][row], record["fz"][row]
        yield t - AROUND_S, "LOADCELL", {"Fx": fx - 0.5, "Fz": fz + 0.25}
        if record["pose"][row] != pose:
            pose = record["pose"][row]
            angles = {"FemurAngle": record["theta1"][row], "KneeAngle": record["theta2"][row]}
            yield t - AROUND_S / 2, "COMMAND", angles
        yield t, "STAGE", {"PosX": record["dx"][row], "PosZ": record["dz"][row]}
        yield t + AROUND_S, "LOADCELL", {"Fx": fx + 0.5, "Fz": fz - 0.25}


def database(folder: Path, text: str = DBC) -> Path:
    path = folder / "rig.dbc"
    path.write_text(text)
    return path


def candump(
    folder: Path, record: Record, keep: Callable[[Entry], bool] = lambda entry: True, database: str = DBC
) -> Path:
    """A log of candump -L, by python-can's writer."""
    known = cantools.database.load_string(database, database_format="dbc")
    assert isinstance(known, cantools.database.can.Database)
    text = io.StringIO()
    writer = CanutilsLogWriter(text)
    for entry in filter(keep, entries(record)):
        t, name, values = entry
        message = known.get_message_by_name(name)
        writer(
            can.Message(
                timestamp=t, arbitration_id=message.frame_id, is_extended_id=message.is_extended_frame,
                data=message.encode(values), channel="can0",
            )
        )  # fmt: skip
    path = folder / "rig.log"
    path.write_text(text.getvalue())
    return path


def json_mcap(folder: Path, record: Record, *, finish: bool = True) -> Path:
    """An MCAP of JSON with somebody's own topics and fields, chunked and compressed."""
    path = folder / "rig.mcap"
    with path.open("wb") as file:
        writer = Writer(file, use_chunking=finish)
        writer.start()
        schema = writer.register_schema("anything", "jsonschema", b"{}")
        topics = {"STAGE": "/stage/slide", "LOADCELL": "/ft300", "COMMAND": "/leg/cmd"}
        names = {"PosX": "x_mm", "PosZ": "z_mm", "FemurAngle": "femur_deg", "KneeAngle": "knee_deg"}
        channels = {name: writer.register_channel(topic, "json", schema) for name, topic in topics.items()}
        other = writer.register_channel("/log", "json", schema)
        for t, name, values in entries(record):
            if name == "LOADCELL":
                message: object = {"ok": True, "force": {"x": values["Fx"], "z": values["Fz"]}, "unit": "N"}
            else:
                message = {names[key]: value for key, value in values.items()}
            stamp = round(t * 1e9)
            writer.add_message(channels[name], stamp, json.dumps(message).encode(), stamp)
        writer.add_message(other, stamp, b'{"text": "end"}', stamp)
        if finish:
            writer.finish()  # type: ignore[no-untyped-call]
    return path


_HEADER = """std_msgs/Header header
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"""
_VECTOR = "float64 x\nfloat64 y\nfloat64 z\n"
_BAR = "=" * 80 + "\n"
ROS_TYPES = {
    "geometry_msgs/msg/WrenchStamped": _HEADER.replace("header\n", "header\ngeometry_msgs/Wrench wrench\n", 1)
    + _BAR + "MSG: geometry_msgs/Wrench\ngeometry_msgs/Vector3 force\ngeometry_msgs/Vector3 torque\n"
    + _BAR + "MSG: geometry_msgs/Vector3\n" + _VECTOR,
    "geometry_msgs/msg/PointStamped": _HEADER.replace("header\n", "header\ngeometry_msgs/Point point\n", 1)
    + _BAR + "MSG: geometry_msgs/Point\n" + _VECTOR,
    "sensor_msgs/msg/JointState": _HEADER.replace(
        "header\n", "header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n", 1
    ),
}  # fmt: skip


def ros2_mcap(folder: Path, record: Record) -> Path:
    """An MCAP as rosbag2 writes it: cdr, by mcap-ros2-support. The tip's position counts from the limb's base, in m."""
    from mcap_ros2.writer import Writer as RosWriter

    path = folder / "bag.mcap"
    with path.open("wb") as file:
        writer = RosWriter(file)
        schemas = {name: writer.register_msgdef(name, text) for name, text in ROS_TYPES.items()}
        for t, name, values in entries(record):
            stamp = round(t * 1e9)
            header = {"stamp": {"sec": int(t), "nanosec": 0}, "frame_id": "base"}
            if name == "LOADCELL":
                force = {"x": values["Fx"], "y": 0.0, "z": values["Fz"]}
                message = {"header": header, "wrench": {"force": force, "torque": {"x": 0.0, "y": 0.0, "z": 0.0}}}
                topic, kind = "/ft_sensor/wrench", "geometry_msgs/msg/WrenchStamped"
            elif name == "STAGE":
                point = {"x": values["PosX"] / 1e3, "y": 0.0, "z": values["PosZ"] / 1e3}
                message = {"header": header, "point": point}
                topic, kind = "/tracker/tip", "geometry_msgs/msg/PointStamped"
            else:
                angles = [math.radians(values[key]) for key in ("KneeAngle", "FemurAngle")]
                message = {"header": header, "name": ["knee", "femur"], "position": angles}
                message |= {"velocity": [], "effort": []}
                topic, kind = "/joint_states", "sensor_msgs/msg/JointState"
            writer.write_message(topic, schemas[kind], message, stamp, stamp)
        writer.finish()  # type: ignore[no-untyped-call]
    return path
