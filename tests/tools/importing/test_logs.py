"""`brace import` of candump's logs and of MCAP: matched, shown, confirmed and converted as the columns of a CSV are."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import cast

import logs_of_a_rig as rig
import numpy as np
import pytest
from command_bench import Outcome
from foreign_files import POSES_DEG, Record
from test_foreign_files import matches

from brace.dataset import load_dataset
from brace.ground.errors import BadFileError
from brace.importing.logs.collect import Collector
from brace.importing.logs.ros_units import unit_of_field
from brace.importing.logs.wanted import Wanted

Brace = Callable[..., Outcome]
LATE_S = 0.21  # the log begins with the load cell


def answered(mapping: Path, answers: dict[str, dict[str, str]]) -> None:
    """Sets keys of named columns of a drafted mapping."""
    text = mapping.read_text()
    for name, entries in answers.items():
        at = text.index(f'name = "{name}"')
        end = text.find("[[", at)
        block = text[at : end if end > 0 else len(text)]
        new = block
        for key, value in entries.items():
            new = re.sub(rf"(?m)^{key} = .*$", f"{key} = {value}", new)
        text = text.replace(block, new, 1)
    mapping.write_text(text)


def test_a_log_of_candump(brace: Brace, tmp_path: Path) -> None:
    log, dbc = rig.candump(tmp_path, Record()), rig.database(tmp_path)
    asked = brace("import", log, "--dbc", dbc, "--out", tmp_path / "out")
    assert asked.code == 2 and "nobody has confirmed" in asked.err and not (tmp_path / "out").exists()
    for column, target, unit in (("LOADCELL.Fx", "fx_n", "N"), ("COMMAND.KneeAngle", "theta2_rad", "deg")):
        assert re.search(rf"{re.escape(column)} +{target} +{unit} ", asked.err), asked.err
    assert "STAGE: 204 readings, 4 s apart" in asked.err and "COMMAND: 3 readings" in asked.err
    done = brace("import", log, "--dbc", dbc, "--out", tmp_path / "out", "--yes")
    assert done.code == 0, done.err
    matches(tmp_path / "out", Record(), t_s=LATE_S)
    meta = tomllib.loads((tmp_path / "out" / "meta.toml").read_text())
    assert meta["conversion"]["dx_mm"] == "column 'STAGE.PosX' in mm, as it is"
    notes = " ".join(meta["source"]["notes"])
    for words in ("its rows are the readings of STAGE", "LOADCELL.Fx (408 readings, 400 ms apart) is interpolated",
                  "COMMAND.FemurAngle (3 readings", "messages of the database that never came: STATUS",
                  "decoded by rig.dbc, sha256"):  # fmt: skip
        assert words in notes, notes


def test_a_log_of_json_topics(brace: Brace, tmp_path: Path) -> None:
    """Units that nobody says are asked; the mapping holds."""
    log, mapping = rig.json_mcap(tmp_path, Record()), tmp_path / "m.toml"
    refused = brace("import", log, "--out", tmp_path / "out", "--yes")
    assert refused.code == 2 and "'/ft300.force.x': in which unit?" in refused.err
    assert "topic /log is left out: it has no numbers" in refused.err
    assert brace("import", log, "--draft", mapping).code == 0
    answered(mapping, {"/ft300.force.x": {"unit": '"N"'}, "/ft300.force.z": {"unit": '"N"'}})
    done = brace("import", log, "--mapping", mapping, "--out", tmp_path / "out")
    assert done.code == 0, done.err
    matches(tmp_path / "out", Record(), t_s=LATE_S)
    answered(mapping, {"/ft300.force.x": {"unit": '"kN"'}, "/ft300.force.z": {"unit": '"kN"'}})
    wrong = brace("import", log, "--mapping", mapping, "--out", tmp_path / "other")
    assert wrong.code == 3 and "cannot be right" in wrong.err


def test_a_log_of_ros_2(brace: Brace, tmp_path: Path) -> None:
    """Units by the messages' types: metres, radians, newtons. Torques and what lies across the plane are asked for."""
    pytest.importorskip("mcap_ros2")
    log, mapping = rig.ros2_mcap(tmp_path, Record()), tmp_path / "m.toml"
    drafted = brace("import", log, "--draft", mapping)
    assert drafted.code == 0, drafted.err
    assert re.search(r"/tracker/tip.point.x +dx_mm +m ", drafted.err), drafted.err
    assert re.search(r"/joint_states.position.knee +theta2_rad +rad ", drafted.err), drafted.err
    assert "'/tracker/tip.point.y': what is it?" in drafted.err
    across = ("/tracker/tip.point.y", "/ft_sensor/wrench.wrench.force.y")
    answered(mapping, {name: {"is": '"ignore"'} for name in across})
    done = brace("import", log, "--mapping", mapping, "--out", tmp_path / "out")
    assert done.code == 0, done.err
    matches(tmp_path / "out", Record(), t_s=LATE_S)


@pytest.fixture(scope="module")
def one_pose() -> Record:
    return Record(poses=POSES_DEG[:1], repeats=1)


def test_gaps_are_not_bridged(brace: Brace, tmp_path: Path, one_pose: Record) -> None:
    """The load cell was silent around two readings of the stage."""
    silent = (rig.START_S + 18.0, rig.START_S + 26.0)
    log = rig.candump(
        tmp_path, one_pose, lambda entry: not (entry[1] == "LOADCELL" and silent[0] < entry[0] < silent[1])
    )
    done = brace("import", log, "--dbc", rig.database(tmp_path), "--out", tmp_path / "out", "--yes")
    assert done.code == 0, done.err
    assert "LOADCELL.Fx: 2 rows have none of it, in its gaps" in done.err
    assert "LOADCELL: 64 readings, 400 ms apart" in done.err
    kept = np.ones(one_pose.rows, bool)
    kept[[5, 6]] = False
    matches(tmp_path / "out", one_pose, kept, t_s=LATE_S)


def test_a_signal_that_ends_early_is_told(brace: Brace, tmp_path: Path, one_pose: Record) -> None:
    end = rig.START_S + one_pose["t"][-3] + 1.0
    log = rig.candump(tmp_path, one_pose, lambda entry: not (entry[1] == "LOADCELL" and entry[0] > end))
    done = brace("import", log, "--dbc", rig.database(tmp_path), "--out", tmp_path / "out", "--yes")
    assert done.code == 0 and "LOADCELL.Fz: 2 rows have none of it, after its last" in done.err, done.err
    assert load_dataset(tmp_path / "out").rows == one_pose.rows - 2


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda text: text.replace("123#", "124#"), "displacements are missing"),
        (lambda text: re.sub(r"\S+#", "5A1#", text), "no frame of this log is in rig.dbc"),
        (lambda text: text + "nonsense\n", "not a line of a candump log"),
        (lambda text: text + text, "the log's clock goes back by"),
        (lambda text: text + text[-200:].splitlines()[-1].replace("can0", "can1") + "\n", "comes from two buses"),
        (lambda text: "  can0  123   [8]  01 02 03 04 05 06 07 08\n" * 3, "what candump shows on a screen"),
        (lambda text: " (001.000000)  can0  123   [2]  01 02\n" * 3, "what candump shows on a screen"),
    ],
)  # fmt: skip
def test_logs_that_cannot_be_right_are_refused_in_a_sentence(
    brace: Brace, tmp_path: Path, one_pose: Record, change: Callable[[str], str], words: str
) -> None:
    log = rig.candump(tmp_path, one_pose)
    log.write_text(change(log.read_text()))
    said = ("--dbc", rig.database(tmp_path), "--set", "axis=x", "--out", tmp_path / "out", "--yes")
    outcome = brace("import", log, *said)
    if words == "displacements are missing":  # the stage is another node's
        assert outcome.code == 3 and "displacements are missing" in outcome.err, outcome.err
        assert "another node's or another device's, left out: 0x124 (34)" in outcome.err
        assert "never came: STAGE, STATUS" in outcome.err
        return
    assert outcome.code == 3 and words in outcome.err and "try:" in outcome.err, outcome.err
    assert not (tmp_path / "out").exists() and "Traceback" not in outcome.err


def test_frames_that_are_short_or_beyond_their_range_are_counted(
    brace: Brace, tmp_path: Path, one_pose: Record
) -> None:
    log = rig.candump(tmp_path, one_pose)
    lines = log.read_text().splitlines()
    stage = [at for at, line in enumerate(lines) if " 123#" in line]
    lines[stage[3]] = re.sub(r"#.{8}", "#00000080", lines[stage[3]])  # the least number: -214748 mm
    lines[stage[5]] = lines[stage[5]][:-6]
    log.write_text("\n".join(lines) + "\n(1700000000.5) can0 1")  # and the last line was cut off
    done = brace("import", log, "--dbc", rig.database(tmp_path), "--out", tmp_path / "out", "--yes")
    assert done.code == 0, done.err
    for words in ("STAGE.PosX: 1 readings beyond the range", "1 frames left out that do not fit their database: STAGE",
                  "the log's last line is cut off"):  # fmt: skip
        assert words in done.err
    assert load_dataset(tmp_path / "out").rows == one_pose.rows - 2


def test_databases(brace: Brace, tmp_path: Path, one_pose: Record) -> None:
    log, dbc = rig.candump(tmp_path, one_pose), rig.database(tmp_path)
    csv = tmp_path / "table.csv"
    csv.write_text("t,f\n1,2\n2,3\n")
    twice = tmp_path / "other.dbc"
    twice.write_text(rig.DBC.replace("STAGE", "OTHER"))
    broken = tmp_path / "broken.dbc"
    broken.write_text("BO_ what\n")
    for arguments, words in (
        ((log,), "no database that decodes them"),
        ((log, "--dbc", dbc, "--dbc", twice), "two databases have the identifier 0x123"),
        ((log, "--dbc", broken), "not a CAN database"),
        ((log, "--dbc", tmp_path / "none.dbc"), "no such CAN database"),
        ((csv, "--dbc", dbc), "no file is a log of CAN frames"),
    ):
        outcome = brace("import", *arguments, "--out", tmp_path / "out", "--yes")
        assert outcome.code in (2, 3) and words in outcome.err and "Traceback" not in outcome.err, outcome.err


def test_mcap_logs_that_cannot_be_read(brace: Brace, tmp_path: Path, one_pose: Record) -> None:
    from mcap.writer import Writer

    whole = rig.json_mcap(tmp_path, one_pose, finish=False)
    data = whole.read_bytes()
    whole.write_bytes(data[:-30])  # recording was cut off
    cut = brace("import", whole, "--draft", tmp_path / "m.toml")
    assert cut.code == 0 and "the log ends in the middle of an entry" in cut.err, cut.err
    whole.write_bytes(data[:3000] + b"\xff" * 200 + data[3200:])
    broken = brace("import", whole, "--draft", tmp_path / "m2.toml")
    assert broken.code == 3 and "a broken MCAP log" in broken.err, broken.err
    foreign = tmp_path / "proto.mcap"
    with foreign.open("wb") as file:
        writer = Writer(file)
        writer.start()
        schema = writer.register_schema("foxglove.Log", "protobuf", b"\x01")
        writer.add_message(writer.register_channel("/p", "protobuf", schema), 0, b"\x01", 0)
        writer.finish()  # type: ignore[no-untyped-call]
    refused = brace("import", foreign, "--out", tmp_path / "out", "--yes")
    assert refused.code == 3 and "/p: its encoding is protobuf; JSON and ROS 2 (cdr) are read" in refused.err


@pytest.mark.parametrize("ending", [".mcap", ".log"])
def test_our_own_recordings(brace: Brace, tmp_path: Path, one_pose: Record, ending: str) -> None:
    """A controller and the rig's instruments on one bus, as brace record writes it. The controller says the posture;
    its K and what follows from it are no measurement."""
    from brace.bus.candump import read
    from brace.bus.frame import Frame
    from brace.bus.recording import Recording
    from brace.wire.frames import DICTIONARY_HASH, MESSAGES

    theta = {name: np.radians(one_pose[name][0]) for name in ("theta1", "theta2")}
    frames = [
        Frame(frame.time_s, frame.identifier, frame.data)
        for frame in read(rig.candump(tmp_path, one_pose, database=rig.ELEVEN_BITS))
    ]
    heart = b"\5\0\0\0" + DICTIONARY_HASH.to_bytes(4, "little")
    posture = MESSAGES["posture"].encode({"sequence": 1, **theta, "parameter_tag": 0})
    begin = frames[0].time_s
    for second in range(0, 250):
        frames.append(Frame(begin + second, MESSAGES["heartbeat"].identifier + 2, heart))
        frames.append(Frame(begin + second, MESSAGES["posture"].identifier + 2, posture))
        frames.append(Frame(begin + second, MESSAGES["stiffness_a"].identifier + 2, bytes(8)))
    recording = Recording(tmp_path / f"bus{ending}", "can0")
    for frame in sorted(frames, key=lambda frame: frame.time_s):
        recording.add(frame)
    recording.finish()
    dbc = rig.database(tmp_path, rig.ELEVEN_BITS)
    done = brace("import", recording.path, "--dbc", dbc, "--out", tmp_path / "out", "--yes")
    assert done.code == 0, done.err
    matches(tmp_path / "out", one_pose, t_s=LATE_S)
    assert "are computed with its model and are no measurement" in done.err


@pytest.mark.parametrize(
    ("schema", "path", "unit"),
    [
        ("sensor_msgs/msg/JointState", "position.femur", "rad"),
        ("sensor_msgs/msg/JointState", "effort.femur", "N m"),
        ("sensor_msgs/msg/JointState", "velocity.femur", ""),
        ("geometry_msgs/msg/Wrench", "force.x", "N"),
        ("geometry_msgs/msg/WrenchStamped", "wrench.torque.x", "N m"),
        ("geometry_msgs/msg/Pose", "position.x", "m"),
        ("geometry_msgs/msg/Pose", "orientation.x", ""),
        ("geometry_msgs/msg/PoseStamped", "pose.position.x", "m"),
        ("geometry_msgs/msg/PoseWithCovarianceStamped", "pose.pose.position.x", "m"),
        ("geometry_msgs/msg/PointStamped", "point.x", "m"),
        ("geometry_msgs/msg/TransformStamped", "transform.translation.x", "m"),
        ("sensor_msgs/msg/Temperature", "temperature", "degC"),
        ("sensor_msgs/msg/Range", "range", "m"),
        ("std_msgs/msg/Float64", "data", ""),
    ],
)
def test_units_of_ros_messages_are_si(schema: str, path: str, unit: str) -> None:
    """REP 103; a type that fixes no unit leaves it to be asked."""
    assert unit_of_field(schema, path) == unit


def test_entries_of_several_senders_come_out_of_order_by_a_second() -> None:
    """By more, the clock was set back, and the file is refused."""
    collector = Collector(Path("a.bag"), cast(Wanted, None))
    for time_s in (10.0, 9.5, 9.01, 11.0):
        collector.clock(time_s)
    with pytest.raises(BadFileError, match="goes back by 1.1 s"):
        collector.clock(9.9)
