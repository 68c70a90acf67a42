"""`brace export`: the MuJoCo model's K, worked out by the engine, is the limb's; a URDF comes back as it went."""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command_bench import LIMB, Outcome, physics_k

Brace = Callable[..., Outcome]
mujoco = pytest.importorskip("mujoco")


def loaded(path: Path, gravity: bool = False) -> tuple[Any, Any]:
    """The engine's model and data, at the keyframe."""
    model = mujoco.MjModel.from_xml_path(str(path))
    if not gravity:
        model.opt.gravity[:] = 0.0
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    return model, data


def k_of(model: Any, data: Any, force_n: tuple[float, float] = (0.0, 0.0)) -> tuple[np.ndarray, np.ndarray]:
    """K [N/mm] at the equilibrium under a force on the tip, and the tip [mm]: differences of the engine's forces."""
    f = np.array([force_n[0], 0.0, force_n[1]])

    def jacobian() -> np.ndarray:
        j = np.zeros((3, model.nv))
        mujoco.mj_jacSite(model, data, j, None, 0)
        return j

    def pull(q: np.ndarray) -> np.ndarray:
        data.qpos[:], data.qvel[:] = q, 0.0
        mujoco.mj_forward(model, data)
        pulled: np.ndarray = data.qfrc_passive + data.qfrc_actuator - data.qfrc_bias + jacobian().T @ f
        return pulled

    def slope(q: np.ndarray) -> np.ndarray:
        step = 1e-6
        return np.array([(pull(q + step * unit) - pull(q - step * unit)) / (2 * step) for unit in np.eye(len(q))]).T

    q = data.qpos.copy()
    for _ in range(60):
        q = q - np.linalg.solve(slope(q), pull(q))
    stiff = -slope(q)
    pull(q)
    j = jacobian()[[0, 2]]
    c = 1e3 * j @ np.linalg.solve(stiff, j.T)  # mm/N
    return np.linalg.inv(c), 1e3 * data.site_xpos[0][[0, 2]]


def exported(brace: Brace, folder: Path, text: str, theta1: float = 1.0, theta2: float = 1.4) -> Path:
    limb, out = folder / "limb.toml", folder / "limb.xml"
    limb.write_text(text)
    done = brace("export", "--model", limb, "--mujoco", out, "--theta1", theta1, "--theta2", theta2)
    assert done.code == 0, done.err
    return out


@pytest.mark.parametrize(("theta1", "theta2"), [(1.0, 1.4), (0.2, 0.5), (-0.4, 2.3)])
@pytest.mark.parametrize("beam", [0.0, 1.0, 0.5])
def test_k_is_the_reference_s(brace: Brace, tmp_path: Path, theta1: float, theta2: float, beam: float) -> None:
    text = LIMB.replace("bending_mm_per_n = 0.06", f"bending_mm_per_n = 0.06\nmoment_transfer = {beam}")
    text = text.replace("bending_mm_per_n = 0.25", f"bending_mm_per_n = 0.25\nmoment_transfer = {beam}")
    k, _ = k_of(*loaded(exported(brace, tmp_path, text, theta1, theta2)))
    assert k == pytest.approx(physics_k(theta1, theta2, moment_transfer=beam), rel=2e-5, abs=2e-6)


@pytest.mark.parametrize("beam", [0.0, 1.0])
@pytest.mark.parametrize("force_n", [(0.2, 0.0), (0.0, 0.2)])
def test_a_weightless_limb_stands_still_under_a_push(
    brace: Brace, tmp_path: Path, beam: float, force_n: tuple[float, float]
) -> None:
    """Step after step, as people run the engine: the tip comes to rest where the limb's compliance has it."""
    text = LIMB.replace("bending_mm_per_n = 0.06", f"bending_mm_per_n = 0.06\nmoment_transfer = {beam}")
    text = text.replace("bending_mm_per_n = 0.25", f"bending_mm_per_n = 0.25\nmoment_transfer = {beam}")
    text = re.sub(r"axial_mm_per_n = \S+", "axial_mm_per_n = 2e-5", text)  # a tube's: the stiffest spring of a limb
    model, data = loaded(exported(brace, tmp_path, text))
    k, rest_mm = k_of(model, data)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    for _ in range(4000):
        mujoco.mj_fwdPosition(model, data)
        pushed = np.zeros(model.nv)
        push, no_moment = np.array([force_n[0], 0.0, force_n[1]]), np.zeros(3)
        mujoco.mj_applyFT(model, data, push, no_moment, data.site_xpos[0], model.site_bodyid[0], pushed)
        data.qfrc_applied[:] = pushed
        mujoco.mj_step(model, data)
    assert not any(warning.number for warning in data.warning)
    expected = np.linalg.solve(k, force_n)
    # 0.2 N turn the limb by 0.02 rad at most, and so change its compliance by as much of itself
    size = float(np.linalg.norm(expected))
    assert 1e3 * data.site_xpos[0][[0, 2]] - rest_mm == pytest.approx(expected, abs=0.02 * size)


def test_with_base_offsets_and_a_tilted_link_as_brace_k(brace: Brace, tmp_path: Path) -> None:
    text = LIMB.replace("[joint.femur]", "[joint.femur]\nzero_offset_rad = 0.03").replace(
        "[link.tibia]", "[link.tibia]\ntilt_rad = 0.2"
    )
    text += "[base]\nx_mm_per_n = 0.02\nz_mm_per_n = 0.01\nrotation_rad_per_n_mm = 2e-6\n"
    k, _ = k_of(*loaded(exported(brace, tmp_path, text)))
    told = json.loads(brace("k", "--model", tmp_path / "limb.toml", "--theta1", 1.0, "--theta2", 1.4, "--json").out)
    for entry, (row, column) in {"xx": (0, 0), "xz": (0, 1), "zz": (1, 1)}.items():
        assert k[row, column] == pytest.approx(told[f"k_{entry}_n_per_mm"], rel=2e-5, abs=2e-5)


def test_under_a_load_as_the_limb_turns(brace: Brace, tmp_path: Path) -> None:
    """K and the way of the tip under 10 N, at finite displacements: check values of docs/physics.md's limb."""
    model, data = loaded(exported(brace, tmp_path, LIMB))
    _, rest = k_of(model, data)
    k, tip = k_of(model, data, (0.0, 10.0))
    assert tip - rest == pytest.approx([3.80735, 31.80811], abs=2e-3)
    assert [k[0, 0], k[0, 1], k[1, 1]] == pytest.approx([4.256242, -0.334349, 0.331800], abs=2e-5)


def test_what_the_formats_cannot_say_is_said(brace: Brace, tmp_path: Path) -> None:
    text = LIMB.replace("[joint.tibia]", "[joint.tibia]\ngap_rad = 0.004")
    limb = tmp_path / "limb.toml"
    limb.write_text(text)
    done = brace("export", "--model", limb, "--mujoco", tmp_path / "limb.xml", "--urdf", tmp_path / "limb.urdf")
    assert done.code == 0 and "joint.tibia.gap_rad is left out" in done.err
    assert brace("export", "--model", limb).code == 2
    beam = LIMB.replace("[link.femur]", "[link.femur]\nmoment_transfer = true\ntilt_rad = 0.1")
    limb.write_text(beam)
    refused = brace("export", "--model", limb, "--mujoco", tmp_path / "other.xml")
    assert refused.code == 2 and "a beam and tilted" in refused.err


def test_a_urdf_comes_back_as_it_went(brace: Brace, tmp_path: Path) -> None:
    limb, robot = tmp_path / "limb.toml", tmp_path / "limb.urdf"
    travel = "[motor.coxa]\nangle_min_rad = -1.0\nangle_max_rad = 1.0\n"
    travel += "[motor.femur]\nangle_min_rad = -1.2\nangle_max_rad = 1.5\n"
    travel += "[motor.tibia]\nangle_min_rad = 0.2\nangle_max_rad = 2.4\n"
    limb.write_text(LIMB + travel)
    assert brace("export", "--model", limb, "--urdf", robot).code == 0
    back = tmp_path / "back.toml"
    parts = ("--femur-link", "rigid", "--tibia-link", "measured 0.2 0.01", "--femur-joint", 60, "--tibia-joint", 60)
    done = brace("new", "--out", back, "--urdf", robot, *parts, "--coxa-joint", 60)
    assert done.code == 0, done.err
    went, came = (tomllib.loads(path.read_text()) for path in (limb, back))
    assert came["geometry"] == pytest.approx(went["geometry"], abs=1e-3)
    for joint in ("coxa", "femur", "tibia"):
        assert came["motor"][joint] == pytest.approx(went["motor"][joint], abs=1e-5)
