"""Several loading tests as one record: each row at its motors' angles, postures as configurations, one
clock."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from bus_bench import limb_on_tcp
from command_bench import LIMB, Outcome, physics_k

from brace.bus.loading_rows import added, counted_from_first, on_one_clock, with_motor_angles
from brace.dataset import load_dataset
from brace.model import LimbModel, load_limb
from brace.native import loaded
from brace.native.plant_batch import LoadingBatchPlayer, model_numbers

FEMUR_MM, TIBIA_MM = 185.0, 313.5
ENCODER_STEP_RAD = 2e-5  # the dictionary's default
FORCE_STEP_N = 0.002  # K and the angles as they are written down
TEST = ("--loading-test", "--axis", "x", "--steps", 2, "--step-mm", 0.5, "--add", "--json")


def _tip(theta1: np.ndarray, theta2: np.ndarray) -> np.ndarray:
    shank = theta1 - theta2
    return np.stack(
        [
            FEMUR_MM * np.cos(theta1) + TIBIA_MM * np.cos(shank),
            FEMUR_MM * np.sin(theta1) + TIBIA_MM * np.sin(shank),
        ]
    )


def _columns(run: int, theta: tuple[float, float], d_mm: np.ndarray) -> dict[str, np.ndarray]:
    count = d_mm.shape[1]
    whole = {"run": run, "config": 1, "axis": 0, "rep": 0}
    return {
        **{name: np.full(count, value) for name, value in whole.items()},
        "step": np.arange(count),
        "theta1_rad": np.full(count, theta[0]),
        "theta2_rad": np.full(count, theta[1]),
        "t_s": 0.5 * np.arange(count) + 0.1,
        "dx_mm": d_mm[0],
        "dz_mm": d_mm[1],
        "fx_n": np.zeros(count),
        "fz_n": np.zeros(count),
    }


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> LimbModel:
    path = tmp_path_factory.mktemp("limb") / "limb.toml"
    path.write_text(LIMB)
    return load_limb(path)


def _by_levers(theta: tuple[float, float], moved: np.ndarray) -> np.ndarray:
    """What a controller tells of motors that move by small angles: the tip's shift by the levers of where
    they were, here from differences; minus, since the tip stays and the unloaded shape moves away."""
    at, tiny = np.array(theta), 1e-6
    levers = [(_tip(*(at + tiny * one)) - _tip(*(at - tiny * one))) / (2 * tiny) for one in np.eye(2)]
    shift: np.ndarray = -np.column_stack(levers) @ moved
    return shift


def test_motors_angles_and_the_tips_arc_from_what_levers_tell(model: LimbModel) -> None:
    moved = np.array([[0.0, 0.011, -0.02, 0.004], [0.0, -0.013, 0.0, 0.021]])
    columns = with_motor_angles(_columns(1, (0.7, 1.3), _by_levers((0.7, 1.3), moved)), model)
    rounding_rad = 1e-6  # levers under a load, here none, are the firmware's, in single precision
    assert np.abs(columns["theta1_rad"] - 0.7 - moved[0]).max() < rounding_rad
    assert np.abs(columns["theta2_rad"] - 1.3 - moved[1]).max() < rounding_rad
    planted = _tip(np.full(4, 0.7), np.full(4, 1.3))
    told = np.stack([columns["dx_mm"], columns["dz_mm"]])
    assert np.abs(planted - _tip(0.7 + moved[0], 1.3 + moved[1]) - told).max() < rounding_rad * (FEMUR_MM + TIBIA_MM)


@pytest.mark.parametrize("press_n", [(0.0, 10.0), (0.0, -20.0), (-20.0, 0.0)])
def test_of_a_pressed_foot_each_row_is_where_its_force_is(press_n: tuple[float, float], model: LimbModel) -> None:
    """The reference presses the limb and tells the levers under the load. Angles and displacements come back, and the
    plant, given what the limb was pressed with, has the forces that the rows were made with."""
    theta, weighty = np.array([1.0, 1.4]), model.with_values({"gravity.femur_n": 3.0, "gravity.tibia_n": 2.0})
    limb = weighty.with_values({"joint.femur.zero_offset_rad": 0.02, "joint.tibia.zero_offset_rad": -0.03})

    def rest(at: np.ndarray) -> np.ndarray:
        bent = loaded.under_force(weighty, at[0], at[1], np.array([press_n])).displacement_mm[0]
        return np.asarray(_tip(at[:1], at[1:])[:, 0] + bent)

    levers = np.column_stack([(rest(theta + 0.01 * one) - rest(theta - 0.01 * one)) / 0.02 for one in np.eye(2)])
    moved = np.array([[0.0, 0.008, -0.01, 0.004], [0.0, -0.006, 0.0, 0.012]])
    at = theta[:, None] + moved
    held = rest(theta)[:, None] - _tip(at[0], at[1])
    force = loaded.under_displacement(weighty, at[0], at[1], held.T).force_n
    columns = _columns(1, (theta[0], theta[1]), -levers @ moved) | {"fx_n": force[:, 0], "fz_n": force[:, 1]}
    rows = counted_from_first(with_motor_angles(columns, limb))
    true = np.stack([rows["theta1_rad"] + 0.02, rows["theta2_rad"] - 0.03])
    assert np.abs(true - at).max() < 2e-6
    assert np.abs(np.stack([rows["dx_mm"], rows["dz_mm"]]) - (held - held[:, :1])).max() < 2e-3
    played = LoadingBatchPlayer(rows, ("fx_n", "fz_n"), zeroed=True).play_numbers(model_numbers(limb)[None])[0]
    assert np.abs(force[:, 0] - force[0, 0]).max() > 1.0
    assert np.abs(np.stack([rows["fx_n"], rows["fz_n"]]) - played).max() < 2e-3


@pytest.mark.parametrize("knee_rad", [0.0, 5e-4])
def test_a_straight_knee_keeps_the_angles_told(knee_rad: float, model: LimbModel) -> None:
    columns = _columns(1, (0.7, knee_rad), np.array([[0.0, 1.0], [0.0, 0.0]]))
    assert with_motor_angles(columns, model)["theta1_rad"].tolist() == [0.7, 0.7]


def test_one_clock_and_counted_on() -> None:
    d_mm = np.zeros((2, 4))
    first = _columns(5, (0.7, 1.3), d_mm)
    second = _columns(6, (0.7, 1.3), d_mm)
    both = {name: np.concatenate([first[name], second[name]]) for name in first}
    clocked = on_one_clock(both, [1000.0, 1010.0])
    assert clocked["t_s"][4] == pytest.approx(10.1)
    assert on_one_clock(both, [1000.0, 1000.1])["t_s"][4] > 1.6  # never before the end of the one before
    again = added(clocked, _columns(1, (0.7001, 1.2999), d_mm), 60.0)
    assert again["run"].tolist()[-4:] == [7] * 4 and again["config"].tolist()[-4:] == [1] * 4
    assert again["rep"].tolist()[-4:] == [1] * 4 and again["t_s"][8] == pytest.approx(
        clocked["t_s"][7] + 60.1
    )
    other = added(again, _columns(1, (0.2, 1.3), d_mm), None)
    assert other["config"].tolist()[-4:] == [2] * 4 and other["rep"].tolist()[-4:] == [0] * 4
    assert np.all(np.diff(other["t_s"]) > 0)


def test_a_pressed_run_behind_runs_that_began_at_rest() -> None:
    """An older record has no preload columns. A run added to it keeps its preload; the older runs get 0."""
    rested, pressed = (_columns(1, (0.7, 1.3), np.zeros((2, 3))) for _ in range(2))
    both = added(rested, counted_from_first(pressed | {"fz_n": np.array([7.0, 8.0, 9.0])}), 1.0)
    assert both["preload_z_n"].tolist() == [0.0] * 3 + [7.0] * 3
    assert both["preload_x_n"].tolist() == [0.0] * 6
    assert both["fz_n"].tolist()[3:] == [0.0, 1.0, 2.0]


def test_postures_over_a_bus_become_one_record(brace: Callable[..., Outcome], tmp_path: Path) -> None:
    """Each configuration's slope is K there; another set of parameters is refused before the limb moves."""
    limb, other = tmp_path / "limb.toml", tmp_path / "other.toml"
    limb.write_text(LIMB)
    other.write_text(LIMB.replace("= 0.25", "= 0.26"))
    postures = ((1.0, 1.4), (0.4, 1.0))
    out = tmp_path / "test"
    for posture in postures:
        with limb_on_tcp(limb, f"--posture={posture[0]},{posture[1]}", "--speed", 5) as url:
            outcome = brace("record", "--bus", url, *TEST, "--out", out)
            assert outcome.code == 0, outcome.err
            if posture == postures[1]:
                outcome = brace("record", "--bus", url, *TEST, "--out", out)  # once more: a repeat
                assert outcome.code == 0, outcome.err
    told = json.loads(outcome.out)
    assert (told["config"], told["configs"], told["faults"]) == (2, 2, [])
    dataset = load_dataset(out)
    dataset.require_sound()
    assert dataset.meta.moved_by_motors and set(dataset["config"].tolist()) == {1, 2}
    assert np.unique(dataset["run"]).tolist() == [1, 2, 3] and set(dataset["rep"].tolist()) == {0, 1}
    for config, posture in enumerate(postures, start=1):
        rows = (dataset["config"] == config) & (dataset["rep"] == 0)
        k = physics_k(*posture)
        d = np.column_stack([dataset["dx_mm"][rows], dataset["dz_mm"][rows]])
        left = dataset["fx_n"][rows] - d @ k[0]
        assert np.abs(left - left.mean()).max() < 0.1 < np.ptp(dataset["fx_n"][rows])
        assert np.ptp(dataset["theta1_rad"][rows]) > 1e-4
    before = (out / "data.csv").read_bytes()
    with limb_on_tcp(other, "--speed", 5) as url:
        outcome = brace("record", "--bus", url, *TEST, "--out", out)
    assert outcome.code == 2 and "another set of parameters" in outcome.err
    assert (out / "data.csv").read_bytes() == before


@pytest.mark.parametrize("encoders", [(), ("--link-encoders",)], ids=["motors alone", "links too"])
@pytest.mark.parametrize("press_mm", [(0.0, 0.0), (5.0, 38.0)])
def test_a_long_stroke_over_a_bus_is_the_limbs_to_the_encoders_step(
    press_mm: tuple[float, float], encoders: tuple[str, ...], brace: Callable[..., Outcome], tmp_path: Path
) -> None:
    """Every row's force is the one that the reference has for its own angles and displacement, counted from the first:
    nothing is left."""
    limb, out = tmp_path / "limb.toml", tmp_path / "long"
    limb.write_text(LIMB + "[sensor]\nnoise_n = 0.0\n")
    long = ("--loading-test", "--axis", "x", "--steps", 3, "--step-mm", 2.5)
    pressed = ("--posture=1.0,1.4", f"--press={press_mm[0]},{press_mm[1]}", *encoders)
    with limb_on_tcp(limb, *pressed, "--speed", 5) as url:
        outcome = brace("record", "--bus", url, *long, "--out", out)
    assert outcome.code == 0, outcome.err
    dataset = load_dataset(out)
    preload_n = np.array([[dataset["preload_x_n"][0], dataset["preload_z_n"][0]]])
    assert np.linalg.norm(preload_n) < 0.01 if press_mm == (0.0, 0.0) else np.linalg.norm(preload_n) > 5.0
    theta = dataset["theta1_rad"], dataset["theta2_rad"]
    aside = loaded.under_force(load_limb(limb), theta[0][0], theta[1][0], preload_n).displacement_mm[0]
    d = np.column_stack([dataset["dx_mm"], dataset["dz_mm"]]) + aside
    force = loaded.under_displacement(load_limb(limb), *theta, d).force_n
    left = np.column_stack([dataset["fx_n"], dataset["fz_n"]]) - (force - force[0])
    # half an encoder's step of the first row and half of this one, of either joint, by what its turn presses
    per_rad = np.abs(physics_k(1.0, 1.4) @ _by_levers((1.0, 1.4), np.eye(2))).sum(axis=1)
    assert np.all(np.abs(left).max(axis=0) < ENCODER_STEP_RAD * per_rad + FORCE_STEP_N)


def test_adding_to_something_else_is_refused(
    brace: Callable[..., Outcome], paper_table: Path, tmp_path: Path
) -> None:
    outcome = brace("record", "--bus", "tcp://127.0.0.1:9", *TEST, "--out", paper_table)
    assert outcome.code == 2 and "stiffness table" in outcome.err


def test_what_a_rig_may_not_do_motors_may(tmp_path: Path) -> None:
    """Angles that differ within a run, and motion across, are faults of a rig's record only; far ones of
    both."""
    from command_bench import LOADING_META, loading_rows, write_loading

    rows = loading_rows()
    for row in rows[1:17]:
        row[2] = f"{float(row[2]) + 0.004:.6f}"
    motors = LOADING_META + 'moved_by = "motors"\n'
    faults = load_dataset(write_loading(tmp_path / "rig", rows)).faults
    assert any(fault.field == "theta1_rad" for fault in faults)
    assert not load_dataset(write_loading(tmp_path / "motors", rows, meta=motors)).faults
    rows[3][2] = "1.9"
    faults = load_dataset(write_loading(tmp_path / "far", rows, meta=motors)).faults
    assert [fault.row for fault in faults if fault.field == "theta1_rad"] == [4]
