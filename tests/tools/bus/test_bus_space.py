"""`brace query`, `monitor`, `record` and `clear` on what a limb in space, a drift and a take-up have to tell."""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from command_bench import ACROSS, FREE, LIMB, Outcome, running

from brace.bus.drift import drift_of, take_up_lines
from brace.bus.frame import Frame
from brace.bus.open_play import open_joints, open_play_lines
from brace.bus.snapshot import emergency_of
from brace.cli.monitor_display import emergency_line
from brace.model import load_limb
from brace.native.loaded import space_under_force
from brace.stiffness.names import SPATIAL_K
from brace.wire.frames import MESSAGES

WIRES = ("can", "modbus_tcp")
STEP_N_PER_MM = 0.0005
WORST_K = 0.01  # brace/loaded_space.h


@pytest.fixture
def spatial(tmp_path: Path) -> Path:
    path = tmp_path / "spatial.toml"
    lateral = LIMB.replace("bending_mm_per_n = 0.25", "bending_mm_per_n = 0.25\nlateral_mm_per_n = 0.2")
    path.write_text(lateral + ACROSS)
    return path


@pytest.fixture
def planar(tmp_path: Path) -> Path:
    path = tmp_path / "planar.toml"
    path.write_text(LIMB)
    return path


def k_by_brace_k(brace: Callable[..., Outcome], limb: Path, theta: tuple[float, float, float]) -> np.ndarray:
    angles = [text for name, value in zip(("--theta0", "--theta1", "--theta2"), theta, strict=True)
              for text in (name, value)]
    outcome = brace("k", "--model", limb, *angles, "--json")
    assert outcome.code == 0, outcome.err
    told = json.loads(outcome.out)
    return np.array([told[name] for name in SPATIAL_K])


def six(entry: dict[str, float]) -> np.ndarray:
    return np.array([entry[name] for name in SPATIAL_K])


# ---------------------------------------------------------------------------------------------- K in space


@pytest.mark.parametrize("wire", WIRES)
def test_query_tells_k_in_space(brace: Callable[..., Outcome], spatial: Path, wire: str) -> None:
    with running(spatial, *FREE, "--theta0", "0.6") as (_, ready):
        url = ready["limbs"][0][wire]
        outcome = brace("query", "--bus", url, "--json")
        assert outcome.code == 0, outcome.err
        live = json.loads(outcome.out)
        space = live["space"]
        assert space["k_is_valid"] and space["flag_names"] == [] and space["play_coxa"] == "unknown"
        assert space["theta0_rad"] == pytest.approx(0.6, abs=2e-3)
        wanted = k_by_brace_k(brace, spatial, (space["theta0_rad"], live["theta1_rad"], live["theta2_rad"]))
        assert np.abs(six(space) - wanted).max() < STEP_N_PER_MM + 1e-4 * np.abs(wanted).max()
        assert space["lambda_min_n_per_mm"] <= space["lambda_mid_n_per_mm"] <= space["lambda_max_n_per_mm"]
        axis = [space[f"stiff_axis_{name}"] for name in "xyz"]
        assert np.linalg.norm(axis) == pytest.approx(1.0, abs=1e-3)
        assert live["take_up"] == {"coxa": "none", "femur": "none", "tibia": "none"}
        text = brace("query", "--bus", url).out
        assert "K in space = [" in text and "stiff axis (" in text and "theta0 0.6" in text
        assert "K across the limb's plane" in text and "play coxa unknown" in text


@pytest.mark.parametrize("wire", WIRES)
def test_query_asks_for_k_in_space_at_a_posture(
    brace: Callable[..., Outcome], spatial: Path, planar: Path, wire: str
) -> None:
    asked = ("--theta0", 0.9, "--theta1", 0.5, "--theta2", 1.7)
    with running(spatial, *FREE) as (_, ready):
        can = ready["limbs"][0][wire]
        outcome = brace("query", "--bus", can, *asked, "--json")
        assert outcome.code == 0, outcome.err
        told = json.loads(outcome.out)
        assert (told["theta0_rad"], told["theta1_rad"], told["theta2_rad"]) == (0.9, 0.5, 1.7) and told["k_is_valid"]
        wanted = k_by_brace_k(brace, spatial, (0.9, 0.5, 1.7))
        assert np.abs(six(told) - wanted).max() < STEP_N_PER_MM + 2e-4 * np.abs(wanted).max()
        assert "stiff_axis_x" not in told
        rows = [["xx", "xy", "xz"], ["xy", "yy", "yz"], ["xz", "yz", "zz"]]
        matrix = "; ".join(" ".join(f"{told[f'k_{name}_n_per_mm']:.4f}" for name in row) for row in rows)
        assert f"K in space = [{matrix}] N/mm" in brace("query", "--bus", can, *asked).out
    with running(planar, *FREE) as (_, ready):
        refused = brace("query", "--bus", ready["limbs"][0][wire], *asked)
        assert refused.code == 2 and "no coxa joint" in refused.err and "without --theta0" in refused.err
    usage = brace("query", "--bus", "can0", "--theta0", 0.9)
    assert usage.code == 2 and "--theta1 --theta2" in usage.err


FORCE = ("--fx", 4, "--fy", -6, "--fz", 9)


@pytest.mark.parametrize("wire", WIRES)
def test_query_asks_for_k_in_space_under_a_force(brace: Callable[..., Outcome], spatial: Path, wire: str) -> None:
    """The reference judges: its forces and displacements are in the robot's frame, which the plane's frame is turned
    out of by theta0."""
    theta0 = 0.9
    asked = ("--theta0", theta0, "--theta1", 0.5, "--theta2", 1.7)
    turned = np.array([[np.cos(theta0), -np.sin(theta0), 0], [np.sin(theta0), np.cos(theta0), 0], [0, 0, 1]])
    true = space_under_force(load_limb(spatial), [[theta0, 0.5, 1.7]], [turned @ (4.0, -6.0, 9.0)])
    k, moved = true.k_n_per_mm[0], turned.T @ true.displacement_mm[0]
    with running(spatial, *FREE) as (_, ready):
        url = ready["limbs"][0][wire]
        outcome = brace("query", "--bus", url, *asked, *FORCE, "--json")
        assert outcome.code == 0, outcome.err
        told = json.loads(outcome.out)
        assert (told["fx_n"], told["fy_n"], told["fz_n"]) == (4.0, -6.0, 9.0)
        xx, xy, xz, yy, yz, zz = six(told)
        told_k = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        assert np.linalg.norm(told_k - k) <= WORST_K * np.linalg.norm(k)
        moves = [told[f"tip_d{axis}_mm"] for axis in "xyz"]
        assert moves == pytest.approx(moved, abs=0.05 * float(np.linalg.norm(moved)))
        alone = six(json.loads(brace("query", "--bus", url, *asked, "--json").out))
        assert np.linalg.norm(alone - six(told)) > 5 * WORST_K * np.linalg.norm(k)  # the force matters
        assert "move the tip by" in brace("query", "--bus", url, *asked, *FORCE).out
        folds = brace("query", "--bus", url, *asked, "--fx", -300, "--fy", 0, "--fz", 0)
        assert folds.code == 2 and "no stable equilibrium" in folds.err


@pytest.mark.parametrize("options", [("--fx", 1, "--fz", 2), ("--fy", 3)])
def test_a_force_in_space_has_three_parts(brace: Callable[..., Outcome], options: tuple[object, ...]) -> None:
    usage = brace("query", "--bus", "can0", "--theta0", 0.9, "--theta1", 0.5, "--theta2", 1.7, *options)
    assert usage.code == 2 and "--fy belongs to" in usage.err


@pytest.mark.parametrize("wire", WIRES)
def test_monitor_tells_k_in_space(brace: Callable[..., Outcome], spatial: Path, wire: str) -> None:
    with running(spatial, *FREE, "--theta0", "-0.4") as (_, ready):
        url = ready["limbs"][0][wire]
        lines = brace("monitor", "--bus", url, "--seconds", 0.6, "--json").out.splitlines()
        spaces = [event["space"] for event in map(json.loads, lines) if "space" in event]
        assert len(spaces) > 3 and all(space["k_is_valid"] for space in spaces)
        assert all(abs(space["theta0_rad"] + 0.4) < 2e-3 for space in spaces)
        text = brace("monitor", "--bus", url, "--seconds", 0.6).out
        assert "K in space " in text and " N/mm" in text


def test_record_keeps_k_in_space(brace: Callable[..., Outcome], spatial: Path, tmp_path: Path) -> None:
    with running(spatial, *FREE) as (_, ready):
        log = tmp_path / "space.mcap"
        outcome = brace("record", "--bus", ready["limbs"][0]["can"], "--seconds", 0.6, "--out", log, "--json")
        assert outcome.code == 0, outcome.err
        told = json.loads(outcome.out)
        assert 0 < told["snapshots_in_space"]["1"] <= told["snapshots"]["1"]
    replayed = brace("replay", log, "--json").out.splitlines()
    assert sum(json.loads(line)["event"] == "space" for line in replayed) == told["snapshots_in_space"]["1"]


def test_the_load_across_the_plane_is_sent_and_kept(
    brace: Callable[..., Outcome], spatial: Path, tmp_path: Path
) -> None:
    """Process data of a limb pressed to the left: monitor, a log and its replay tell x, y and z of one tick's load."""
    limb = tmp_path / "sends.toml"
    limb.write_text(spatial.read_text() + "[controller]\nload_hz = 20\nbus_load_ratio = 1.0\n")
    given = ("--press=1,-4", "--press-across", "8", "--can", "tcp://127.0.0.1:0", "--modbus", "none")
    with running(limb, *given) as (_, ready):
        url = ready["limbs"][0]["can"]
        for _ in range(100):  # the controller finds K without the load some ticks after it has seen the load
            if "unloaded_k_across_n_per_mm" in json.loads(brace("query", "--bus", url, "--json").out)["load"]:
                break
        lines = brace("monitor", "--bus", url, "--seconds", 0.8, "--json").out.splitlines()
        text = brace("monitor", "--bus", url, "--seconds", 0.8).out.splitlines()[-1]
        log = tmp_path / "a.log"
        assert brace("record", "--bus", url, "--out", log, "--seconds", 0.8).code == 0
        asked = json.loads(brace("query", "--bus", url, "--json").out)["load"]
    replayed = brace("replay", log, "--json").out.splitlines()
    names = ("force_x_n", "force_y_n", "force_z_n", "moved_y_mm", "unloaded_k_across_n_per_mm")
    for told in (lines, replayed):
        loads = [entry["load"] for line in told if "load" in (entry := json.loads(line))]
        assert len(loads) > 4 and asked["force_y_n"] > 1.0
        for load in loads[1:]:  # the first may have come before anybody knew that one across follows
            # the limb stands still, and nothing has noise but the tibia's and the femur's drive
            assert [load[name] for name in names] == pytest.approx([asked[name] for name in names], rel=0.02, abs=0.01)
    force = text.split("; load ")[1].split(" N")[0].split()
    assert len(force) == 3 and float(force[1]) == pytest.approx(asked["force_y_n"], rel=0.02)


@pytest.mark.parametrize("wire", WIRES)
def test_a_planar_limb_tells_nothing_of_space(brace: Callable[..., Outcome], planar: Path, wire: str) -> None:
    with running(planar, *FREE) as (_, ready):
        url = ready["limbs"][0][wire]
        assert "space" not in json.loads(brace("query", "--bus", url, "--json").out)
        assert "space" not in brace("query", "--bus", url).out
        assert "space" not in brace("monitor", "--bus", url, "--seconds", 0.3, "--json").out


@pytest.mark.parametrize("wire", WIRES)
def test_a_coxa_joint_without_samples_is_told(brace: Callable[..., Outcome], spatial: Path, wire: str) -> None:
    with running(spatial, *FREE, "--fault", "sensor_dead:coxa@0.2") as (_, ready):
        url = ready["limbs"][0][wire]
        until = time.monotonic() + 20.0
        while "sensor_coxa" not in (live := json.loads(brace("query", "--bus", url, "--json").out))["faults"]:
            assert time.monotonic() < until
        assert live["k_is_valid"] and not live["space"]["k_is_valid"] and live["space"]["k_xy_n_per_mm"] is None
        assert "K in space not valid" in brace("query", "--bus", url).out


# --------------------------------------------------------------------------------------- drift and take-up


@pytest.mark.parametrize("wire", WIRES)
def test_query_tells_what_the_drift_check_does(brace: Callable[..., Outcome], planar: Path, wire: str) -> None:
    with running(planar, *FREE) as (_, ready):
        url = ready["limbs"][0][wire]
        drift = json.loads(brace("query", "--bus", url, "--json").out)["drift"]
        assert (drift["state"], drift["cause"], drift["next_step"]) == ("learning", "none", "learn")
        assert drift["alarm_evidence"] == 20.0 and drift["readings"] == 0
        text = brace("query", "--bus", url).out
        assert "drift: learning: The check learns" in text and "next: Go on learning" in text
        assert "take-up" not in text


CHANGED = {"state": 2, "cause": 2, "could_be": 0b0110, "next_step": 3, "evidence": 34.25, "loss": 0.125,
           "loss_sigma": 0.01, "since_readings": 24, "readings": 900}


def test_a_drift_is_told_in_words() -> None:
    drift = drift_of(CHANGED)
    text = "\n".join(drift.lines())
    assert "drift: drifted: The limb has changed" in text
    assert "likeliest cause: tibia_link_or_knee_joint: The tibia's bending" in text
    assert "could also be: femur_joint_or_base" in text and "tibia_link_or_knee_joint," not in text
    assert "evidence 34.2, the alarm is at 20" in text and "stiffness lost 12.5 % +- 1.0 % (one sigma)" in text
    assert "began 24 readings ago, of 900" in text and "next: Run a loading test at another posture" in text
    measured = {f"drift_{name}{'_ratio' if name.startswith('loss') else ''}": v for name, v in CHANGED.items()}
    assert drift_of(measured, "drift_", "_ratio") == drift
    stiffer = drift_of(CHANGED | {"loss": -0.05, "since_readings": 65535}).lines()
    assert "stiffness gained 5.0 %" in stiffer[3] and "65535 or more readings" in stiffer[3]
    assert drift_of(CHANGED | {"cause": 9}).cause == "9"  # a newer dictionary's


def test_a_failed_take_up_says_why() -> None:
    lines = take_up_lines({"coxa": "none", "femur": "travel", "tibia": "held"})
    assert lines[0].startswith("take-up femur: travel: The motor went further than the gap allows")
    assert lines[1].startswith("take-up tibia: held: ") and len(lines) == 2


def emergency(cause: int, faults: int) -> Frame:
    layout = MESSAGES["emergency"]
    values = {"error_code": 0xFF01, "error_register": 1, "drift_cause": cause, "mode": 1, "faults": faults}
    return Frame(1.0, layout.identifier + 3, layout.encode(values))


def test_an_emergency_names_the_cause(brace: Callable[..., Outcome], tmp_path: Path) -> None:
    told = emergency_of(emergency(1, 1 << 7))
    assert told is not None and told.drift_cause == "femur_link"
    assert emergency_line(told) == (
        "node 3: faults now: model_drift; the drift's likeliest cause is femur_link: The femur's bending has changed."
    )
    over = emergency_of(emergency(0, 0))
    assert over is not None and emergency_line(over) == "node 3: all faults are over"
    log = tmp_path / "drift.log"
    frame = emergency(1, 1 << 7)
    log.write_text(f"({frame.time_s:.6f}) can0 {frame.identifier:03X}#{frame.data.hex().upper()}\n")
    assert "likeliest cause is femur_link" in brace("replay", log).out
    [event] = map(json.loads, brace("replay", log, "--json").out.splitlines())
    assert event["event"] == "emergency" and event["drift_cause"] == "femur_link"


# ---------------------------------------------------------------------------------------------- open play


@pytest.mark.parametrize("wire", WIRES)
def test_an_open_gap_is_named_with_the_command_that_helps(
    brace: Callable[..., Outcome], planar: Path, wire: str
) -> None:
    """The tip is free and bears nothing; over Modbus K once taken up is sent, too."""
    planar.write_text(planar.read_text().replace("[joint.tibia]", "[joint.tibia]\ngap_rad = 0.004", 1))
    with running(planar, *FREE) as (_, ready):
        url = ready["limbs"][0][wire]
        text = brace("query", "--bus", url).out
        assert "GAP_OPEN" in text
        assert f"brace take-up tibia- --bus {url} (or tibia+) takes it up" in text
        assert ("once all is taken up K = [" in text) == (wire == "modbus_tcp")


def test_which_joints_an_open_gap_may_belong_to() -> None:
    assert open_joints((), ("unknown", "unknown")) == ()
    assert open_joints(("GAP_OPEN",), ("engaged_positive", "crossing")) == ("tibia",)
    assert open_joints(("GAP_OPEN",), ("unknown", "engaged_negative")) == ("femur",)
    assert open_joints(("GAP_OPEN",), ("unknown", "unknown")) == ("femur", "tibia")
    assert open_joints(("GAP_OPEN",), ("engaged_positive", "engaged_negative")) == ("femur", "tibia")
    told = open_play_lines(("GAP_OPEN",), ("engaged_positive", "unknown"), "can0", (1.0, 0.5, 2.0))
    assert told == [
        "the gap of the tibia is open: brace take-up tibia- --bus can0 (or tibia+) takes it up",
        "once all is taken up K = [1.0000 0.5000; 0.5000 2.0000] N/mm",
    ]
