"""Frames of two ticks are never put together, whatever is lost, repeated or late."""

from __future__ import annotations

import random

from brace.bus.frame import Frame
from brace.bus.snapshot import Joiner, Snapshot
from brace.wire.frames import FD_GROUPS, FD_MESSAGES, GROUPS, MESSAGES

STEP = 0.0005
SIGMA_STEP = 0.004
PERIOD_S = 0.005
TICKS_A_PERIOD = 5  # the sequence counts control ticks, eight bits of it


def frames_of(tick: int, node: int = 1) -> list[Frame]:
    """All four frames of a snapshot; every value tells its tick."""
    sequence, time_s, mark = tick * TICKS_A_PERIOD & 0xFF, 1000.0 + tick * PERIOD_S, (tick % 4_000_000) * STEP
    contents = {
        "stiffness_a": {"sequence": sequence, "k_xx": mark, "k_xz": -mark, "age": 0},
        "stiffness_b": {
            "sequence": sequence,
            "k_zz": mark,
            "flags": 0,
            "play_femur": 0,
            "play_tibia": 0,
            "mode": 1,
        },
        "eigenvalues": {
            "sequence": sequence,
            "lambda_min": (tick % 1_000_000) * STEP,
            "lambda_max": 1,
            "stiff_axis": 0,
        },
        "posture": {
            "sequence": sequence,
            "theta1": (tick % 500_000) * 2e-5,
            "theta2": 0,
            "parameter_tag": tick & 0xFFFF,
        },
    }
    return [
        Frame(time_s + 1e-4 * index, MESSAGES[name].identifier + node, MESSAGES[name].encode(values))
        for index, (name, values) in enumerate(contents.items())
    ]


def assert_of_one_tick(snapshot: Snapshot) -> None:
    marks = [round(float(value or 0) / STEP) for value in (snapshot.k_xx, snapshot.k_zz)]
    assert marks[0] == marks[1] == -round(float(snapshot.k_xz or 0) / STEP), snapshot
    if snapshot.has_posture:
        assert marks[0] & 0xFFFF == snapshot.parameter_tag
        assert round(float(snapshot.lambda_min or 0) / STEP) == marks[0] % 1_000_000
        assert round(float(snapshot.theta1 or 0) / 2e-5) == marks[0] % 500_000


def test_every_snapshot_of_a_good_bus_is_joined() -> None:
    joiner = Joiner()
    joined = [
        snapshot for tick in range(2000) for frame in frames_of(tick) if (snapshot := joiner.add(frame))
    ]
    assert len(joined) == 4000 and sum(snapshot.has_posture for snapshot in joined) == 2000
    assert joiner.unmatched == 0
    for snapshot in joined:
        assert_of_one_tick(snapshot)


def test_lost_and_repeated_frames_and_other_nodes_mix_nothing() -> None:
    chance = random.Random(7)
    joiner = Joiner()
    joined = lost = 0
    for tick in range(60_000):
        if chance.random() < 0.01:
            tick_frames = frames_of(tick, node=2)
        else:
            tick_frames = frames_of(tick)
        for frame in tick_frames:
            kind = chance.random()
            if kind < 0.3:
                lost += 1
                continue
            for _ in range(1 + (kind > 0.97)):
                snapshot = joiner.add(frame)
                if snapshot is not None:
                    joined += 1
                    assert_of_one_tick(snapshot)
    assert joined > 30_000 and lost > 60_000 and joiner.unmatched > 10_000


def test_a_long_loss_of_the_counter_s_round_mixes_nothing() -> None:
    """256 snapshots later the eight bits are the same again: half of one and half of the other are no snapshot."""
    joiner = Joiner()
    first, later = frames_of(0), frames_of(256)
    assert joiner.add(first[0]) is None
    assert joiner.add(later[1]) is None
    assert joiner.add(first[0]) is None
    assert joiner.add(later[2]) is None and joiner.add(later[3]) is None
    assert joiner.unmatched >= 1


def test_what_is_not_known_stays_unknown() -> None:
    joiner = Joiner()
    unknown = {"sequence": 3, "k_xx": None, "k_xz": None, "age": None}
    b = {"sequence": 3, "k_zz": None, "flags": 0x10, "play_femur": 0, "play_tibia": 5, "mode": 1}
    assert joiner.add(Frame(0.0, 0x185, MESSAGES["stiffness_a"].encode(unknown))) is None
    snapshot = joiner.add(Frame(0.0, 0x285, MESSAGES["stiffness_b"].encode(b)))
    assert snapshot is not None and not snapshot.is_valid
    assert (snapshot.k_xx, snapshot.k_xz, snapshot.k_zz, snapshot.age_ms) == (None, None, None, None)
    assert snapshot.flags == ("STALE",) and snapshot.play == ("unknown", "fault")


def test_short_frames_and_node_0_are_nobody_s() -> None:
    joiner = Joiner()
    a, b, *_ = frames_of(0)
    assert joiner.add(Frame(a.time_s, a.identifier, a.data[:7])) is None
    assert joiner.add(b) is None
    for frame in frames_of(1, node=0):
        assert joiner.add(frame) is None


def whole_of(tick: int) -> Frame:
    """The same in one frame of CAN FD."""
    layout = FD_MESSAGES["snapshot_fd"]
    values: dict[str, float | int | None] = {item.name: 0 for item in layout.fields}
    values |= {"sequence": 0x12345600 | tick & 0xFF, "k_xx": 4.0, "k_xz": -0.5, "k_zz": 1.0, "lambda_min": 0.9}
    values |= {"parameter_tag": 0x1234, "mode": 1, "flags": 9, "faults": 0x84, "theta1": 0.25, "age": 1.5,
               "play_tibia": 3}
    return Frame(1.0, layout.identifier + 5, layout.encode(values))


def test_a_frame_of_can_fd_is_a_whole_snapshot() -> None:
    snapshot = Joiner().add(whole_of(7))
    assert snapshot is not None and snapshot.is_valid and snapshot.has_posture
    assert (snapshot.node, snapshot.sequence, snapshot.k_xx, snapshot.k_xz, snapshot.k_zz) == (5, 7, 4.0, -0.5, 1.0)
    assert (snapshot.parameter_tag, snapshot.mode, snapshot.age_ms, snapshot.theta1) == (0x1234, "monitor", 1.5, 0.25)
    assert snapshot.flags == ("UNCALIBRATED", "GAP_OPEN") and snapshot.faults == ("encoder_stuck", "model_drift")
    assert snapshot.play == ("unknown", "engaged_negative")


def test_part_of_one_is_none() -> None:
    whole = whole_of(7)
    assert Joiner().add(Frame(1.0, whole.identifier, whole.data[:48])) is None


def test_halves_a_round_of_the_number_apart_do_not_fit() -> None:
    """The shortest round of the 8-bit number, at the shortest tick, takes 64 ms."""
    joiner = Joiner()
    a, b = frames_of(3)[:2]
    assert joiner.add(a) is None
    assert joiner.add(Frame(a.time_s + 0.064, b.identifier, b.data)) is None
    assert joiner.add(a) is None
    assert joiner.add(Frame(a.time_s + 0.039, b.identifier, b.data)) is not None


# ------------------------------------------------------------------------------------------- K in space

SPACE = GROUPS["space"]
SPACE_VALUES = ("k_xx", "k_xy", "k_xz", "k_yy", "k_yz", "k_zz", "lambda_1", "lambda_2", "lambda_3", "k_across")


def space_frames_of(tick: int, node: int = 1) -> list[Frame]:
    """All frames of K in space; every value tells its tick."""
    sequence, time_s, mark = tick * TICKS_A_PERIOD & 0xFF, 1000.0 + tick * PERIOD_S + 2e-4, (tick % 4_000_000) * STEP
    values: dict[str, float | int | None] = {name: mark for name in SPACE_VALUES}
    values |= {"flags": 8, "age": 1.5, "play_coxa": 2, "theta0": 0.25, "sequence": sequence}
    values |= {"stiff_axis_x": 0.0, "stiff_axis_y": -0.5, "stiff_axis_z": 1.0}
    return [
        Frame(time_s + 1e-5 * index, layout.identifier + node, layout.encode(values))
        for index, layout in enumerate(SPACE)
    ]


def in_order_of_a_bus(tick: int, node: int = 1) -> list[Frame]:
    """As a controller sends them: K in the plane, K in space, eigenvalues and posture."""
    plane = frames_of(tick, node)
    return [*plane[:2], *space_frames_of(tick, node), *plane[2:]]


def assert_space_of_one_tick(snapshot: Snapshot) -> None:
    assert_of_one_tick(snapshot)
    if snapshot.space is not None:
        told = (*snapshot.space.k, *snapshot.space.eigenvalues, snapshot.space.k_across)
        assert {round(float(value or 0) / STEP) for value in told} == {round(float(snapshot.k_xx or 0) / STEP)}


def test_k_in_space_joins_the_snapshot_it_belongs_to() -> None:
    joiner = Joiner()
    joined = [s for tick in range(500) for frame in in_order_of_a_bus(tick) if (s := joiner.add(frame))]
    assert [s.adds for s in joined[:3]] == ["stiffness", "space", "posture"] and len(joined) == 1500
    assert joiner.unmatched == 0
    for snapshot in joined:
        assert_space_of_one_tick(snapshot)
    last = joined[-1].space
    assert last is not None and last.is_valid and last.flags == ("GAP_OPEN",) and last.play_coxa == "engaged_positive"
    assert (last.theta0, last.stiff_axis) == (0.25, (0.0, -0.5, 1.0))
    entry = joined[-1].as_json()["space"]
    assert isinstance(entry, dict) and {"k_xy_n_per_mm", "lambda_mid_n_per_mm", "stiff_axis_z"} <= entry.keys()


def test_frames_of_two_ticks_never_make_one_k_in_space() -> None:
    chance = random.Random(11)
    joiner = Joiner()
    in_space = 0
    for tick in range(10_000):
        frames = in_order_of_a_bus(tick, 2 if chance.random() < 0.01 else 1)
        if chance.random() < 0.2:  # a driver that sends the lowest identifier first
            frames = sorted(frames, key=lambda frame: frame.identifier)
        for frame in frames:
            kind = chance.random()
            if kind < 0.1:
                continue
            for _ in range(1 + (kind > 0.97)):
                snapshot = joiner.add(frame)
                if snapshot is not None:
                    in_space += snapshot.space is not None and snapshot.adds == "space"
                    assert_space_of_one_tick(snapshot)
    assert 2_000 < in_space < 10_000 and joiner.unmatched > 1_000


def test_parts_a_round_of_the_number_apart_are_no_k_in_space() -> None:
    """256 snapshots later the eight bits are the same again."""
    joiner = Joiner()
    now, later = in_order_of_a_bus(0), in_order_of_a_bus(256)
    for frame in now[:5]:
        joiner.add(frame)
    told = [joiner.add(frame) for frame in later[5:9]]
    assert told == [None] * 4


def test_k_in_space_that_comes_first_waits_for_its_snapshot() -> None:
    joiner = Joiner()
    a, b, *space = in_order_of_a_bus(3)[:9]
    assert [joiner.add(frame) for frame in (a, *space)] == [None] * 8
    snapshot = joiner.add(b)
    assert snapshot is not None and snapshot.space is not None and snapshot.adds == "space"


def space_fd_of(sequence: int, time_s: float = 1.001) -> Frame:
    (layout,) = FD_GROUPS["space_fd"]
    values: dict[str, float | int | None] = {item.name: 0 for item in layout.fields}
    values |= {"sequence": sequence, "k_xx": 3.5, "k_yy": None, "theta0": 0.5, "k_across": 0.25, "flags": 16}
    return Frame(time_s, layout.identifier + 5, layout.encode(values))


def test_over_can_fd_k_in_space_is_the_second_frame() -> None:
    joiner = Joiner()
    whole = joiner.add(whole_of(7))
    assert whole is not None and not joiner.is_complete(whole)  # K in space may follow
    assert joiner.add(space_fd_of(8)) is None  # of the next tick
    assert joiner.add(space_fd_of(7, time_s=1.05)) is None  # of another round
    both = joiner.add(space_fd_of(7))
    assert both is not None and both.space is not None and both.has_posture and joiner.is_complete(both)
    assert not both.space.is_valid and both.space.k[3] is None and both.space.flags == ("STALE",)
    assert both.space.theta0 == 0.5 and both.is_valid


def test_a_planar_node_over_can_fd_is_complete_with_its_second_frame() -> None:
    joiner = Joiner()
    complete = [s is not None and joiner.is_complete(s) for tick in (7, 8) for s in [joiner.add(whole_of(tick))]]
    assert complete == [False, True]


def load_of(tick: int, node: int = 1, group: str = "load") -> list[Frame]:
    """The frames of a snapshot's load; every value but the factor tells its tick."""
    mark = (tick % 4_000_000) * STEP
    values: dict[str, float | int | None] = {
        field.name: mark for layout in GROUPS[group] for field in layout.fields if field.name != "sequence"
    }
    values |= {"sequence": tick * TICKS_A_PERIOD & 0xFF, "flags": 0, "gravity_direction": -1.5, "gravity_lean": 0.25}
    time_s = 1000.0 + tick * PERIOD_S
    return [
        Frame(time_s + 1e-5 * part, layout.identifier + node, layout.encode(values))
        for part, layout in enumerate(GROUPS[group])
    ]


def assert_load_of_its_tick(snapshot: Snapshot) -> None:
    assert_of_one_tick(snapshot)
    if snapshot.load is not None:
        v = snapshot.load.values
        names = ("unloaded_k_xx", "unloaded_k_xz", "unloaded_k_zz")
        told = [float(v[name] or 0) for name in (*names, "counted_force_x", "counted_force_z", "moved_x", "moved_z")]
        mark = float(snapshot.k_xx or 0)
        # forces and lengths have steps of 0.001, K of half that
        assert max(abs(value - mark) for value in told) <= 0.0006, snapshot
        assert (v["gravity_direction"], v["gravity_lean"]) == (-1.5, 0.25)


def test_a_load_joins_its_k_before_it_or_behind_it() -> None:
    k, load = frames_of(77)[:2], load_of(77)
    for frames, adds in (([*load, *k], ["stiffness"]), ([*k, *load], ["stiffness", "load"])):
        joiner = Joiner()
        joined = [s for frame in frames if (s := joiner.add(frame))]
        assert [s.adds for s in joined] == adds and joined[-1].load is not None
        assert_load_of_its_tick(joined[-1])
        entry = joined[-1].as_json()["load"]
        assert isinstance(entry, dict) and entry["is_counted"] and entry["force_x_n"] == entry["moved_z_mm"]


def test_the_first_load_gets_what_is_across_it_when_that_comes() -> None:
    joiner = Joiner()
    frames = (*frames_of(1)[:2], *load_of(1), *load_of(1, group="load_across"), *frames_of(1)[2:])
    joined = [s for frame in frames if (s := joiner.add(frame)) is not None and s.load is not None]
    assert ["force_y_n" in s.load.as_json() for s in joined if s.load] == [False, True, True]


def test_frames_of_two_ticks_never_make_one_load() -> None:
    chance = random.Random(12)
    joiner = Joiner()
    loads = 0
    for tick in range(10_000):
        frames = [*frames_of(tick)[:2], *load_of(tick)]
        if chance.random() < 0.5:
            frames = sorted(frames, key=lambda frame: frame.identifier)
        for frame in frames:
            if chance.random() < 0.1:
                continue
            snapshot = joiner.add(frame)
            if snapshot is not None:
                loads += snapshot.load is not None
                assert_load_of_its_tick(snapshot)
    assert 3_000 < loads < 10_000  # 0.9^8 of all


def test_over_can_fd_a_load_is_a_frame_of_its_own() -> None:
    joiner = Joiner()
    whole = joiner.add(whole_of(7))
    assert whole is not None
    (layout,) = FD_GROUPS["load_fd"]
    values: dict[str, float | int | None] = {item.name: 0 for item in layout.fields}
    values |= {"sequence": 7, "counted_force_x": None, "counted_force_z": None, "unloaded_k_zz": 0.5}
    snapshot = joiner.add(Frame(1.001, layout.identifier + 5, layout.encode(values)))
    assert snapshot is not None and snapshot.load is not None and snapshot.adds == "load" and snapshot.has_posture
    assert not snapshot.load.is_counted and snapshot.load.as_json()["unloaded_k_zz_n_per_mm"] == 0.5


def sigma_of_tick(tick: int, node: int = 1) -> list[Frame]:
    """The frames of a snapshot's uncertainty; every value tells its tick."""
    mark = (tick % 8_000) * SIGMA_STEP
    values: dict[str, float | int | None] = {
        name: mark for name in ("k_xx", "k_xz", "k_zz", "lambda_min", "lambda_max")
    }
    values |= {"sequence": tick * TICKS_A_PERIOD & 0xFF, "stiff_axis": 0.25}
    time_s = 1000.0 + tick * PERIOD_S
    return [
        Frame(time_s + 1e-5 * part, layout.identifier + node, layout.encode(values))
        for part, layout in enumerate(GROUPS["sigma"])
    ]


def test_an_uncertainty_joins_its_k_and_no_other() -> None:
    """Before it or behind it, whatever is lost; the numbers of other groups come between."""
    chance = random.Random(13)
    joiner = Joiner()
    told = 0
    for tick in range(10_000):
        frames = [*frames_of(tick)[:2], *sigma_of_tick(tick), *load_of(tick)]
        if chance.random() < 0.5:
            frames = sorted(frames, key=lambda frame: frame.identifier)
        for frame in frames:
            snapshot = joiner.add(frame) if chance.random() >= 0.1 else None
            if snapshot is not None and snapshot.sigma is not None:
                assert_of_one_tick(snapshot)
                marks = {round(float(value or 0) / SIGMA_STEP) for value in snapshot.sigma.k}
                assert marks == {round(float(snapshot.k_xx or 0) / STEP) % 8_000}
                assert snapshot.sigma.values["stiff_axis"] == 0.25
                told += snapshot.adds == "sigma"
    assert told > 1_500
    entry = joiner.add(sigma_of_tick(1)[0])
    assert entry is None


def test_an_uncertainty_that_is_not_known_is_none() -> None:
    joiner = Joiner()
    layouts = GROUPS["sigma"]
    values: dict[str, float | int | None] = {field.name: None for layout in layouts for field in layout.fields}
    for frame in frames_of(0)[:2]:
        joiner.add(frame)
    last = None
    for layout in layouts:
        last = joiner.add(Frame(1000.0, layout.identifier + 1, layout.encode(values | {"sequence": 0})))
    assert last is not None and last.sigma is not None and not last.sigma.is_known
    entry = last.as_json()
    assert entry["sigma_k_xx_n_per_mm"] is None and entry["sigma_stiff_axis_rad"] is None


def condition(faults: int, node: int = 1) -> Frame:
    (layout,) = GROUPS["condition"]
    values = {"sequence": 9, "faults": faults, "mode": 1, "setting": 1}
    return Frame(1000.0, layout.identifier + node, layout.encode(values))


def test_faults_are_those_last_heard() -> None:
    """Not known until a controller tells them; each node has its own; the highest bit has room."""
    joiner = Joiner()
    emergency = MESSAGES["emergency"]
    told = []
    for tick, news in enumerate((
        None, condition(0), condition(1 << 31 | 1, node=2), condition(1 << 31 | 1),
        Frame(1000.0, emergency.identifier + 1, emergency.encode(
            {"error_code": 0, "error_register": 0, "drift_cause": 0, "mode": 1, "faults": 4})),
    )):
        if news is not None:
            assert joiner.add(news) is None
        told += [s.faults for frame in frames_of(tick)[:2] if (s := joiner.add(frame)) is not None]
    assert told == [None, (), (), ("sensor_femur", "bit_31"), ("encoder_stuck",)]


def test_a_part_of_another_version_is_nobody_s() -> None:
    joiner = Joiner()
    (layout,) = GROUPS["condition"]
    for frame in frames_of(0)[:2]:
        joiner.add(frame)
    for number in set(range(256)) - {part.part for group in GROUPS.values() for part in group}:
        assert joiner.add(Frame(1000.0, layout.identifier + 1, bytes([0, number, *range(6)]))) is None


def test_an_uncertainty_in_space_joins_that_in_the_plane() -> None:
    """In parts that carry the names of K's own; of another snapshot they join nothing."""
    for late in (0, 1):
        joiner = Joiner()
        for frame in (*frames_of(4)[:2], *sigma_of_tick(4)):
            joiner.add(frame)
        told = []
        for layout in GROUPS["sigma_space"]:
            values: dict[str, float | int | None] = {
                field.name: index * 0.1 for index, field in enumerate(layout.fields, layout.part or 0)
            }
            values["sequence"] = (4 + late) * TICKS_A_PERIOD
            told.append(joiner.add(Frame(1000.0 + 4 * PERIOD_S, layout.identifier + 1, layout.encode(values))))
        assert told[:3] == [None] * 3 and (told[3] is None) == bool(late)
        if (last := told[3]) is not None and last.sigma is not None and last.sigma.space is not None:
            space = last.sigma.space
            assert (space["space_k_xx"], space["space_k_yy"], space["space_lambda_3"], space["k_across"]) == \
                (8.1, 8.2, 8.5, 8.4)
            assert last.sigma.values["stiff_axis"] == 0.25
            assert last.as_json()["sigma_space_k_xx_n_per_mm"] == 8.1


def interval_of_tick(tick: int, message: str, node: int = 1) -> list[Frame]:
    """The frames of where a snapshot's force and loads lie."""
    frames = []
    for part, layout in enumerate(GROUPS[message]):
        values: dict[str, float | int | None] = {
            field.name: -2.0 if field.name.endswith("low") else 3.0 for field in layout.fields
        }
        values["sequence"] = tick * TICKS_A_PERIOD & 0xFF
        time_s = 1000.0 + tick * PERIOD_S + 1e-5 * part
        frames.append(Frame(time_s, layout.identifier + node, layout.encode(values)))
    return frames


def test_an_interval_joins_its_k_first_in_the_plane_then_across_it() -> None:
    joiner = Joiner()
    told = [
        snapshot
        for frame in (*frames_of(3)[:2], *interval_of_tick(3, "interval"), *interval_of_tick(3, "interval_across"))
        if (snapshot := joiner.add(frame)) is not None
    ]
    assert [snapshot.adds for snapshot in told] == ["stiffness", "interval", "interval"]
    plane, across = (snapshot.as_json()["interval"] for snapshot in told[1:])
    assert plane == {
        f"{name}_{end}_{unit}": value
        for name, unit in (("force_x", "n"), ("force_z", "n"), ("load_femur", "n_mm"), ("load_tibia", "n_mm"))
        for end, value in (("low", -2.0), ("high", 3.0))
    }
    assert isinstance(across, dict) and across["force_y_low_n"] == -2.0 and across["force_y_high_n"] == 3.0
    assert told[2].interval is not None
    assert told[2].interval.words() == [
        "force with 90 % between: x -2.00 to 3.00, y -2.00 to 3.00, z -2.00 to 3.00 N"
    ]
    assert all(joiner.add(frame) is None for frame in interval_of_tick(4, "interval"))  # of no K that has come


def test_an_interval_of_can_fd_joins_its_whole_snapshot() -> None:
    joiner = Joiner()
    joiner.add(whole_of(7))
    (layout,) = FD_GROUPS["interval_fd"]
    values: dict[str, float | int | None] = {item.name: None for item in layout.fields}
    values |= {"sequence": 7, "parameter_tag": 0, "force_x_low": 1.0, "force_x_high": 2.0}
    snapshot = joiner.add(Frame(1.001, layout.identifier + 5, layout.encode(values)))
    assert snapshot is not None and snapshot.interval is not None and snapshot.adds == "interval"
    reported = snapshot.interval.as_json()
    assert reported["force_x_low_n"] == 1.0 and reported["force_z_low_n"] is None and "force_y_low_n" not in reported
    assert snapshot.interval.words() == ["force with 90 % between: x 1.00 to 2.00 N"]
