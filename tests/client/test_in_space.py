"""The C client against a limb in space: K in space, the drift check, take-ups, over CAN and Modbus."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from conftest import BUILD, LIMB, Answer, Sim, simulated

from brace.model import load_limb
from brace.native.loaded import space_under_force

STEP = 0.0005  # N/mm
WORST_K = 0.01  # brace/loaded_space.h
Probe = Callable[..., Answer]
ACROSS = """
[sensor]
noise_n = 0.0  # else K counts the load that it feigns, as it counts the drive's
[motor.coxa]
torque_noise_n_mm = 0.0
[link.coxa]
lateral_mm_per_n = 0.004
[joint.coxa]
compliance_rad_per_n_mm = 0.8e-5
"""
ENTRIES = ("k_xx", "k_xy", "k_xz", "k_yy", "k_yz", "k_zz")


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("space") / "spatial.toml"
    path.write_text(LIMB.read_text() + ACROSS)
    return path


@pytest.fixture(scope="module")
def spatial(model: Path) -> Iterator[Sim]:
    with simulated(model.parent, model, "--theta0", 0.6) as running:
        yield running


@pytest.fixture(params=["can", "modbus"])
def url(request: pytest.FixtureRequest, spatial: Sim) -> str:
    return str(getattr(spatial, request.param))


def k_of_the_model(model: Path, *theta_rad: float) -> np.ndarray:
    angles = [text for i, value in enumerate(theta_rad) for text in (f"--theta{i}", str(value))]
    command = [sys.executable, "-m", "brace", "k", "--model", model, *angles, "--json"]
    reported = json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)
    return np.array([reported[f"{name}_n_per_mm"] for name in ENTRIES])


def test_k_in_space_is_read(probe: Probe, url: str, model: Path) -> None:
    answer = probe(url, "space", 3)
    assert answer.code == 0, answer.err
    assert len(answer.snapshots) == 3
    last = answer.snapshots[-1]
    assert last["parts"] == 15 and last["valid"] == 1 and last["flags"] == 0
    assert last["theta0"] == pytest.approx(0.6, abs=2e-3)
    wanted = k_of_the_model(model, last["theta0"], last["theta1"], last["theta2"])
    assert np.abs(np.array([last[name] for name in ENTRIES]) - wanted).max() < STEP + 20 * 2e-5
    assert last["lambda_1"] <= last["lambda_2"] <= last["lambda_3"] and last["across"] > 0
    assert np.hypot(np.hypot(last["axis_x"], last["axis_y"]), last["axis_z"]) == pytest.approx(1.0, abs=1e-3)


LOAD_ACROSS = 1 + 16 + 32  # K, the load, the load across


@pytest.fixture(scope="module")
def pressed(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Sim]:
    """A foot that is pressed to the left, and a controller that sends its load."""
    path = tmp_path_factory.mktemp("pressed") / "spatial.toml"
    path.write_text(LIMB.read_text() + ACROSS + "[controller]\nload_hz = 20\n")
    with simulated(path.parent, path, "--press=1,-4", "--press-across", 8) as running:
        yield running


def _counted_load(probe: Probe, url: str) -> dict[str, float]:
    """The load, once the controller counts one and its filter has settled: it begins without."""
    until = time.monotonic() + 20.0
    before: dict[str, float] = {}
    while (load := probe(url, "load").values)["is_counted"] != 1 or load != pytest.approx(before, rel=1e-3, abs=1e-3):
        assert time.monotonic() < until, load
        before = load
        time.sleep(0.05)
    return load


@pytest.mark.parametrize("port", ["can", "modbus"])
def test_the_load_across_the_plane_comes_with_its_k(probe: Probe, pressed: Sim, port: str) -> None:
    url = str(getattr(pressed, port))
    asked = _counted_load(probe, url)
    answer = probe(url, "read", LOAD_ACROSS, 3)
    assert answer.code == 0, answer.err
    for reported in answer.snapshots:
        assert int(reported["parts"]) & LOAD_ACROSS == LOAD_ACROSS
        assert reported["force_y"] > 1.0 and reported["moved_y"] > 1.0
        for name in ("force_x", "force_y", "moved_y", "unloaded_k_across"):
            # the limb stands still and its sensors are free of noise
            assert reported[name] == pytest.approx(asked[name], rel=2e-2, abs=0.002), name


@pytest.mark.parametrize("port", ["can", "modbus"])
def test_a_limb_in_its_plane_has_no_load_across(probe: Probe, sim: Sim, port: str) -> None:
    answer = probe(getattr(sim, port), "read", LOAD_ACROSS, 1, timeout_ms=600)
    assert answer.code in (5, 12) and "coxa joint" in answer.err


def test_the_load_across_the_plane_is_reported(probe: Probe, url: str, sim: Sim) -> None:
    """A free foot: the coxa joint's torque says that hardly anything pulls across the plane."""
    load, k = probe(url, "load").values, probe(url, "space", 1).snapshots[-1]
    assert load["is_counted"] == 1 and abs(load["force_y"]) < 0.3
    assert load["unloaded_k_across"] == pytest.approx(k["across"], rel=0.02)
    assert load["moved_y"] == pytest.approx(load["force_y"] / k["across"], abs=0.02)
    planar = probe(sim.can, "load").values
    assert np.isnan([planar[name] for name in ("force_y", "moved_y", "unloaded_k_across")]).all()


@pytest.mark.parametrize("wire", ["can", "modbus"])
def test_k_in_space_is_asked_for(probe: Probe, spatial: Sim, sim: Sim, model: Path, wire: str) -> None:
    url = getattr(spatial, wire)
    answer = probe(url, "space_posture", 0.9, 0.5, 1.7)
    assert answer.code == 0, answer.err
    wanted = k_of_the_model(model, 0.9, 0.5, 1.7)
    assert np.abs(np.array([answer.values[name] for name in ENTRIES]) - wanted).max() < STEP + 20 * 1e-4
    refused = probe(getattr(sim, wire), "space_posture", 0.9, 0.5, 1.7)
    assert refused.code == 11 and "no coxa joint" in refused.err
    assert probe(url, "space_posture", 4.0, 0.5, 1.7).code == 1  # beyond its frame


def test_k_in_space_under_a_force(probe: Probe, url: str, model: Path) -> None:
    """Forces and displacements are in the frame of the limb's plane; the reference's are in the robot's."""
    theta0, force_n = 0.9, (4.0, -6.0, 9.0)
    turned = np.array([[np.cos(theta0), -np.sin(theta0), 0], [np.sin(theta0), np.cos(theta0), 0], [0, 0, 1]])
    true = space_under_force(load_limb(model), [[theta0, 0.5, 1.7]], [turned @ force_n])
    k, moved = true.k_n_per_mm[0], turned.T @ true.displacement_mm[0]
    answer = probe(url, "space_under_load", theta0, 0.5, 1.7, *force_n)
    assert answer.code == 0, answer.err
    wanted = np.array([k[0, 0], k[0, 1], k[0, 2], k[1, 1], k[1, 2], k[2, 2]])
    reported = np.array([answer.values[name] for name in ENTRIES])
    assert np.linalg.norm(reported - wanted) <= WORST_K * np.linalg.norm(wanted)
    assert np.linalg.norm(reported - k_of_the_model(model, theta0, 0.5, 1.7)) > 5 * WORST_K * np.linalg.norm(wanted)
    moves = [answer.values[f"moved_{axis}"] for axis in "xyz"]
    assert moves == pytest.approx(moved, abs=0.05 * float(np.linalg.norm(moved)))
    folds = probe(url, "space_under_load", theta0, 0.5, 1.7, -300.0, 0.0, 0.0)
    assert folds.code == 11 and "folds" in folds.err
    assert probe(url, "space_under_load", theta0, 0.5, 1.7, 400.0, 0.0, 0.0).code == 1  # beyond its frame


def test_a_limb_without_a_coxa_joint_has_no_k_in_space(probe: Probe, sim: Sim) -> None:
    over_can = probe(sim.can, "space", 1, timeout_ms=600)
    assert over_can.code == 5 and "only a limb with a coxa joint" in over_can.err
    over_modbus = probe(sim.modbus, "space", 1)
    assert over_modbus.code == 12 and "no coxa joint" in over_modbus.err


def test_the_drift_check_is_reported(probe: Probe, url: str) -> None:
    answer = probe(url, "drift")
    assert answer.code == 0, answer.err
    names = ("state", "cause", "could_be", "next_step", "readings")
    assert tuple(answer.values[name] for name in names) == (0, 0, 0, 1, 0)
    assert "learns the limb's own baseline" in answer.err and "Go on learning" in answer.err


def test_how_a_take_up_went_is_reported(probe: Probe, url: str) -> None:
    for joint in range(3):
        answer = probe(url, "take_up", joint)
        assert answer.code == 0 and answer.values == {"outcome": 0}
        assert "Nobody has asked for a take-up" in answer.err
    assert probe(url, "take_up", 3).code == 1


def test_the_example(url: str) -> None:
    example = BUILD / "tools" / "client" / "print_space"
    done = subprocess.run([example, url], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    k, drift = done.stdout.splitlines()
    assert k.startswith("[") and k.endswith("N/mm, flags 0x00")
    assert "learns the limb's own baseline" in drift
