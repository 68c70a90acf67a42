"""Records of a limb whose instruments are in trouble: the trouble is told with its size, and the limb is judged without
what the trouble did. Every trouble is put into the readings here, from its own definition."""

from __future__ import annotations

import csv
import re
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest
from handmade import loading_record

from brace.dataset import load_dataset
from brace.diagnose.diagnosis import Diagnosis
from brace.diagnose.loading.choose import LabelSet
from brace.diagnose.loading.troubles.kinds import GROWTH, OUTLIERS, SLIP
from brace.diagnose.loading.troubles.lag import lag_in_words
from brace.diagnose.loading.troubles.likeliest import Trouble, most_likely, with_trouble
from brace.diagnose.options import Options
from brace.diagnose.run import diagnose
from brace.identify.record import Record
from brace.model import load_limb
from brace.native.plant import LoadingPlayer

Columns = dict[str, np.ndarray]
Spoil = Callable[[Columns], None]
FORCES = ("fx_n", "fz_n")
GAIN_STEP = 0.1
STEP_ROW = 107  # within a run of 17 readings
SLIP_MM = (0.06, -0.09)
PLAY_MM, STEP_MM = 0.15, 0.635
QUICK = "dwell_s = 0.2\n"


def spoiled(
    folder: Path, limb: Path, spoil: Spoil, values: dict[str, float], repeats: int = 2, rig: str = ""
) -> Diagnosis:
    """The diagnosis of a record after `spoil` has changed its columns."""
    record = loading_record(folder, limb, values=values, repeats=repeats, rig=rig)
    with (record / "data.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    names = [name for name in rows[0] if name != "axis"]
    columns = {name: np.array([float(row[name]) for row in rows]) for name in names}
    spoil(columns)
    for place, row in enumerate(rows):
        row |= {name: f"{columns[name][place]:.9g}" for name in (*FORCES, "t_s", "theta1_rad", "theta2_rad")}
    with (record / "data.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    return diagnose(load_dataset(record), load_limb(limb), Options())


def middle_run(columns: Columns) -> np.ndarray:
    """The rows of the later half of the runs."""
    return np.asarray(columns["run"] > np.median(columns["run"]))


def gain_steps(columns: Columns) -> None:
    for name in FORCES:
        columns[name][middle_run(columns)] *= 1.0 + GAIN_STEP


def zero_steps(columns: Columns) -> None:
    columns["fz_n"][middle_run(columns)] += 0.4


def reads_late(columns: Columns, share: float = 0.02) -> None:
    """By a share of the time between two readings."""
    late_s = share * float(np.median(np.diff(columns["t_s"])))
    for run in np.unique(columns["run"]):
        rows = columns["run"] == run
        for name in FORCES:
            t_s = columns["t_s"][rows]
            columns[name][rows] = np.interp(t_s - late_s, t_s, columns[name][rows])


def slips(columns: Columns) -> None:
    for row, size_n in ((31, 3.0), (77, -2.0), (140, 2.5)):
        columns["fx_n"][row] += size_n


def clock_starts_late(columns: Columns) -> None:
    columns["t_s"] += 1e4


@pytest.fixture(scope="module")
def limb() -> Path:
    return Path(__file__).resolve().parents[3] / "tools" / "brace" / "data" / "paper-limb.toml"


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (zero_steps, "the sensor's zero moved by fz_n +0.4"),
        # test_an_effect_is_named_beside_a_trouble has the same readings
        pytest.param(slips, "single readings", marks=pytest.mark.minutes),
    ],
)
def test_a_sound_limb_with_a_troubled_sensor(tmp_path: Path, limb: Path, spoil: Spoil, words: str) -> None:
    found = spoiled(tmp_path / "record", limb, spoil, values={})
    assert found.verdict == "data_fault" and found.effects == (), found.sentence
    assert words in found.sentence and "Nothing was added" in found.sentence
    assert any(words in fault.why for fault in found.data_faults)


@pytest.mark.minutes
def test_the_step_of_a_gain_has_its_size_and_its_run(tmp_path: Path, limb: Path) -> None:
    found = spoiled(tmp_path / "record", limb, gain_steps, values={})
    assert found.verdict == "data_fault" and found.effects == (), found.sentence
    assert "the sensor reads +" in found.sentence and "Nothing was added" in found.sentence
    (fault,) = [fault for fault in found.data_faults if "the sensor reads" in fault.why]
    told_percent = float(fault.why.split("reads ")[1].split(" %")[0])
    assert told_percent == pytest.approx(100.0 * GAIN_STEP, rel=0.1)
    (begins,) = np.flatnonzero(np.diff(middle_run(dict(load_dataset(tmp_path / "record").columns)).astype(int)))
    # a run begins and ends without a load, so that the readings there have no gain to tell
    assert fault.row is not None and abs(fault.row - (begins + 2)) <= 2


def gain_steps_within_a_run(columns: Columns) -> None:
    for name in FORCES:
        columns[name][STEP_ROW:] *= 1.0 + GAIN_STEP


@pytest.mark.minutes
def test_a_gain_may_step_within_a_run(tmp_path: Path, limb: Path) -> None:
    found = spoiled(tmp_path / "record", limb, gain_steps_within_a_run, values={})
    assert found.verdict == "data_fault", found.sentence
    (fault,) = [fault for fault in found.data_faults if "the sensor reads" in fault.why]
    assert fault.row is not None and abs(fault.row - (STEP_ROW + 1)) <= 2


def zero_steps_twice(columns: Columns) -> None:
    columns["fx_n"][STEP_ROW:] += 0.6
    columns["fx_n"][2 * STEP_ROW :] -= 1.0


@pytest.mark.minutes
def test_a_zero_may_step_twice(tmp_path: Path, limb: Path) -> None:
    """One after the other, steps look like a drift."""
    found = spoiled(tmp_path / "record", limb, zero_steps_twice, values={})
    assert found.verdict == "data_fault", found.sentence
    (fault,) = found.data_faults
    assert f"from row {STEP_ROW + 1} on" in fault.why and f"from row {2 * STEP_ROW + 1} on" in fault.why


def displace(columns: Columns, limb: Path, x_mm: np.ndarray, z_mm: np.ndarray) -> None:
    """The forces of a tip that stands elsewhere than the record says, row by row."""
    real = {name: values.copy() for name, values in columns.items()}
    real["dx_mm"] += x_mm
    real["dz_mm"] += z_mm
    believed, there = (LoadingPlayer(one).play(load_limb(limb)) for one in (columns, real))
    for name in FORCES:
        columns[name] += there[name] - believed[name]


@pytest.mark.minutes
def test_a_clamp_that_slips_is_told_with_its_way(tmp_path: Path, limb: Path) -> None:
    """The plant plays the tip where it stands; the record says where the rig believes it to be."""

    def clamp_slips(columns: Columns) -> None:
        slipped = np.arange(len(columns["t_s"])) >= STEP_ROW
        displace(columns, limb, slipped * SLIP_MM[0], slipped * SLIP_MM[1])

    found = spoiled(tmp_path / "record", limb, clamp_slips, values={})
    assert found.verdict == "data_fault", found.sentence
    (fault,) = found.data_faults
    told = re.search(r"slipped by ([-+.\de]+) mm along x and ([-+.\de]+) mm along z from row (\d+) on", fault.why)
    assert told is not None, fault.why
    assert [float(told[1]), float(told[2])] == pytest.approx(SLIP_MM, rel=0.15)
    assert abs(int(told[3]) - (STEP_ROW + 1)) <= 2


@pytest.mark.minutes
def test_a_clamp_that_goes_back_is_a_burst_of_interference(tmp_path: Path, limb: Path) -> None:
    """Within one run both read alike; no clamp slips, and slips back to where it was."""

    def back_again(columns: Columns) -> None:
        there = np.zeros(len(columns["t_s"]))
        there[STEP_ROW + 1 : STEP_ROW + 9] = 0.3
        displace(columns, limb, there, there)

    found = spoiled(tmp_path / "record", limb, back_again, values={})
    assert found.verdict == "data_fault", found.sentence
    assert "slipped by" not in found.sentence and "the sensor's zero moved" in found.sentence


@pytest.mark.minutes
def test_a_frame_that_grows_is_no_clamp_that_slips(tmp_path: Path, limb: Path) -> None:
    """Several slips fit a slow growth nearly as well. The catalogue has no name for it, so the verdict is unknown."""

    def frame_grows(columns: Columns) -> None:
        since = columns["t_s"] - columns["t_s"][0]
        grown_mm = 0.05 * since / since[-1]
        displace(columns, limb, grown_mm, -grown_mm)

    found = spoiled(tmp_path / "record", limb, frame_grows, values={})
    assert found.verdict == "unknown", found.sentence
    assert not found.data_faults


def noise_grows_with_the_load(columns: Columns) -> None:
    rng = np.random.default_rng(5)
    for name in FORCES:
        columns[name] += 0.06 * columns[name] * rng.standard_normal(columns[name].size)


@pytest.mark.minutes
def test_noise_under_load_is_no_single_readings(tmp_path: Path, limb: Path) -> None:
    found = spoiled(tmp_path / "record", limb, noise_grows_with_the_load, values={}, repeats=1)
    assert found.verdict == "none" and found.data_faults == (), found.sentence


def other_gain_at_one_posture(columns: Columns) -> None:
    here = columns["config"] == 2
    for name in FORCES:
        columns[name][here] *= 1.0 + GAIN_STEP


@pytest.mark.minutes
def test_what_follows_a_posture_is_no_step_in_time(tmp_path: Path, limb: Path) -> None:
    found = spoiled(tmp_path / "record", limb, other_gain_at_one_posture, values={})
    assert not [fault for fault in found.data_faults if "the sensor reads" in fault.why], found.sentence


@pytest.mark.parametrize(
    ("what", "words"),
    [
        pytest.param("one axis", "the sensor had another gain along one axis", marks=pytest.mark.minutes),
        pytest.param(
            "one posture", "the force at rest was another one at one of the postures", marks=pytest.mark.minutes
        ),
        pytest.param("off its rest", "the tip stood off its rest", marks=pytest.mark.minutes),
    ],
)
def test_what_begins_with_the_record_is_no_step(tmp_path: Path, limb: Path, what: str, words: str) -> None:
    """A step after the first readings, or two about one posture, read nearly the same."""

    def spoil(columns: Columns) -> None:
        if what == "one axis":
            columns["fx_n"] *= 0.96
        elif what == "one posture":
            here = columns["config"] == 2
            columns["fx_n"][here] += 0.25
            columns["fz_n"][here] -= 0.25
        else:
            everywhere = np.ones(len(columns["t_s"]))
            displace(columns, limb, 0.02 * everywhere, -0.015 * everywhere)

    found = spoiled(tmp_path / "record", limb, spoil, values={})
    assert found.verdict == "unknown" and not found.data_faults, found.sentence
    assert f": the error looks as if {words}" in found.sentence, found.sentence  # one verb


@pytest.mark.minutes
def test_a_late_sensor_is_a_lag_and_no_friction(tmp_path: Path, limb: Path) -> None:
    """Where equal steps hide the difference to a play at the contact, both are named."""
    found = spoiled(tmp_path / "record", limb, reads_late, values={}, rig=QUICK)
    assert "lag@sensor" in [effect.label for effect in found.effects]
    assert not [effect for effect in found.effects if effect.name != "lag" and effect.confidence >= 0.8]
    assert found.model.number("joint.tibia.coulomb_n_mm") == 0.0


@pytest.mark.minutes
def test_a_lag_is_no_noise_of_a_record_without_repeats(tmp_path: Path, limb: Path) -> None:
    """The believed limb leaves the lag, and nothing else tells the noise. A play at the contact comes near, and would
    do as well if what the lag makes were noise."""
    late: Spoil = lambda columns: reads_late(columns, 0.48)  # noqa: E731
    found = spoiled(tmp_path / "record", limb, late, values={}, repeats=1, rig=QUICK)
    assert found.effects[0].label == "lag@sensor"
    assert found.effects[0].confidence > 0.8
    lag = found.effects[0].parameters["sensor.lag_s"]
    assert lag.value == pytest.approx(0.48 * 0.2, rel=0.02), "a limb fitted without its lag makes it 4 % too long"


def times_rarer(time_s: float) -> float:
    """Than a lag of up to 0.1 s: 1 s, ten times as much, lies three sigmas out."""
    return float(np.exp(0.5 * (3.0 * np.log10(max(time_s / 0.1, 1.0))) ** 2))


@pytest.mark.minutes
@pytest.mark.parametrize(("wait_s", "play_mm"), [(0.2, PLAY_MM), (4.0, 0.05)])
def test_play_reads_like_a_lag(tmp_path: Path, limb: Path, wait_s: float, play_mm: float) -> None:
    """Equal steps hide the difference: late by wait * half the play / step, a sensor reads the same in a rig that moves
    on. A lag of up to 0.1 s is as common as play. Half of the rigs that are said to wait for 0.3 s move on, and the
    fewer, the longer the wait; in the others the sensor must settle so slowly that it lacks as much after the wait."""
    values, waits = {"contact.play_mm": play_mm}, f"dwell_s = {wait_s}\n"
    found = spoiled(tmp_path / "record", limb, lambda columns: None, values=values, rig=waits)
    said = {effect.label: effect.confidence for effect in found.effects}
    assert set(said) == {"contact_play@contact", "lag@sensor"}
    share, moves_on = play_mm / 2.0 / STEP_MM, 0.3 / (0.3 + wait_s)
    rarer = 1.0 / (
        moves_on / times_rarer(share * wait_s) + (1.0 - moves_on) / times_rarer(wait_s / np.log(1.0 / share))
    )
    odds = said["contact_play@contact"] / said["lag@sensor"]
    assert odds == pytest.approx(rarer, rel=0.35), "the record's noise moves the odds a little"
    assert sum(said.values()) < 1.0


def test_a_lag_is_told_with_what_the_rig_is_said_to_do(tmp_path: Path, limb: Path) -> None:
    """Where the rig is said to wait, the sentence says what must be wrong: the rig did not wait, or the sensor settles
    slowly. No sensor settles before the force comes, so that early forces have no time constant."""
    record = cast(Record, SimpleNamespace(dataset=load_dataset(loading_record(tmp_path / "record", limb))))
    late, early = lag_in_words(record, 1.2, 0.05), lag_in_words(record, -1.2, 0.05)
    assert late.startswith(
        "the forces are read 1200 ms (+- 50, one sigma) after the displacements if the rig did not wait 4 s"
    )
    assert f"settles with a time constant of {4.0 / np.log(4.0 / 1.2):.2g} s" in late
    assert "before the displacements if the rig did not wait 4 s" in early and "settles" not in early
    quick = loading_record(tmp_path / "quick", limb, rig=QUICK)
    record = cast(Record, SimpleNamespace(dataset=load_dataset(quick)))
    at_once = lag_in_words(record, 0.05, 0.002)
    assert at_once.startswith("the forces are read 50 ms (+- 2, one sigma) after the displacements; give")


@pytest.mark.minutes
def test_a_lag_beside_friction_is_no_play_beside_it(tmp_path: Path, limb: Path) -> None:
    """The search takes what the lag does for play at the contact, and adds the friction to it. No search for friction
    alone came that way."""
    late: Spoil = lambda columns: reads_late(columns, 0.1)  # noqa: E731
    found = spoiled(tmp_path / "record", limb, late, values={"joint.tibia.coulomb_n_mm": 60.0}, rig=QUICK)
    said = {effect.label: effect.confidence for effect in found.effects}
    assert said["coulomb_friction@joint.tibia"] > 0.8 and said["lag@sensor"] > 0.8
    assert set(said) == {"coulomb_friction@joint.tibia", "lag@sensor"}


@pytest.mark.minutes
def test_every_part_of_what_is_named_may_be_contested(tmp_path: Path, limb: Path) -> None:
    """Play reads like a lag and a base that yields like a rig that does: neither name stands for sure, and the report
    says how to tell each of them."""
    values = {"contact.play_mm": PLAY_MM, "base.x_mm_per_n": 0.02, "base.z_mm_per_n": 0.02}
    found = spoiled(tmp_path / "record", limb, lambda columns: None, values=values, rig=QUICK)
    said = {effect.label: effect.confidence for effect in found.effects}
    assert all(confidence < 0.8 for confidence in said.values()), said
    classes = [set(one) for one in found.indistinguishable]
    assert any({"contact_play@contact", "lag@sensor"} <= one for one in classes)
    assert any({"base_compliance@base", "rig_compliance@rig"} <= one for one in classes)
    assert "twice the dwell" in found.sentence and "dial gauge" in found.sentence


@pytest.mark.minutes
def test_an_effect_is_named_beside_a_trouble(tmp_path: Path, limb: Path) -> None:
    found = spoiled(tmp_path / "record", limb, slips, values={"joint.tibia.zero_offset_rad": 0.05})
    assert [effect.label for effect in found.effects] == ["joint_zero_offset@joint.tibia"]
    assert "instruments were in trouble" in found.sentence


def test_the_clock_may_start_anywhere(tmp_path: Path, limb: Path) -> None:
    found = spoiled(tmp_path / "record", limb, clock_starts_late, values={})
    assert found.verdict == "none" and found.data_faults == ()


def reads_in_quarters(columns: Columns) -> None:
    for name in FORCES:
        columns[name] = 0.25 * np.rint(columns[name] / 0.25)


def test_a_sensor_coarser_than_it_is_said_to_be(tmp_path: Path, limb: Path) -> None:
    """Steps of 0.25 N where meta.toml says 0.0625: found in the readings, and no reason to name anything."""
    found = spoiled(tmp_path / "record", limb, reads_in_quarters, values={})
    assert found.verdict == "none", found.sentence
    assert load_dataset(tmp_path / "record").meta.number("sensor.resolution_n") == pytest.approx(0.25)


def one_axis_is_noisy(columns: Columns) -> None:
    columns["fz_n"] = np.rint(columns["fz_n"])
    columns["fx_n"] += 0.02 * np.random.default_rng(7).standard_normal(columns["fx_n"].size)


def test_a_channel_that_rounds_beside_one_that_is_noisy(tmp_path: Path, limb: Path) -> None:
    """What is left of the channel that rounds has the shape of its rounding, and says nothing."""
    found = spoiled(tmp_path / "record", limb, one_axis_is_noisy, values={})
    assert found.verdict == "none", found.sentence


def test_single_readings_that_stand_out_are_told_once() -> None:
    """Two rounds may find some each, the same row in both of its channels."""
    record = cast(Record, SimpleNamespace(channels=("fx_n", "fz_n")))

    def found(name: str, *readings: tuple[int, int]) -> Trouble:
        columns = np.zeros((2, 9, len(readings)))
        for place, (channel, row) in enumerate(readings):
            columns[channel, row, place] = 1.0
        return Trouble(name, "fx_n", readings[0][1] + 1, columns, cast(LabelSet, None), 9.0, 1.0, 0.1, "")

    zeros, first, second = found("zeros", (0, 1)), found(OUTLIERS, (0, 5), (0, 7)), found(OUTLIERS, (1, 5), (1, 2))
    assert with_trouble(record, (zeros,), first) == (zeros, first)
    kept, whole = with_trouble(record, (zeros, first), second)
    assert kept is zeros and whole.columns.shape == (2, 9, 4)
    assert (whole.name, whole.field, whole.row) == (OUTLIERS, "fx_n, fz_n", 3)
    assert "(row 3, 6, 8)" in whole.shown


@pytest.mark.parametrize(
    ("slip", "growth", "name"),
    [
        (64.5, 64.4, GROWTH),  # nobody can tell which of the two it is
        (64.5, 62.0, GROWTH),
        (64.5, 61.0, SLIP),  # the slip is 33 times likelier
        (61.0, 64.5, GROWTH),
        (4.0, 3.9, SLIP),  # the slip is not far ahead of the catalogue: an effect is named, with the slip as a rival
        (-4.0, -5.0, None),
    ],
)
def test_a_trouble_is_not_told_where_something_without_a_name_is_as_likely(
    slip: float, growth: float, name: str | None
) -> None:
    def weighed(name: str, lead: float) -> Trouble:
        return Trouble(name, "fx_n", 1, np.zeros((2, 9, 1)), cast(LabelSet, None), lead, 1.0, 0.1, "")

    found = most_likely([weighed(SLIP, slip), weighed(GROWTH, growth)])
    assert (found and found.name) == name
    assert found is None or found.lead == max(slip, growth)
