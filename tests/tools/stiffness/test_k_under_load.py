"""`brace k --fx --fz`: K under a load, against the reference, which was written apart from the firmware's C."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from brace.model import LimbModel, load_limb
from brace.native import loaded
from brace.native.plant import LoadingPlayer
from brace.stiffness.under_load import stiffness_under_load
from command_bench import Outcome

ADDED = {"tip_dx_mm", "tip_dz_mm", "buckling_factor"}
WORST_K, WORST_MM, WORST_FACTOR = 6e-3, 0.5, 0.02  # what brace/loaded.h promises


@pytest.fixture
def heavy_limb(paper_limb: Path, tmp_path: Path) -> Path:
    """The paper's limb with beams for links, weights, and a zero offset."""
    path = tmp_path / "heavy.toml"
    values = {
        "link.femur.moment_transfer": True,
        "link.tibia.moment_transfer": True,
        "gravity.femur_n": 2.0,
        "gravity.knee_n": 1.0,
        "gravity.tibia_n": 1.5,
        "joint.femur.zero_offset_rad": 0.1,
    }
    path.write_text(load_limb(paper_limb).with_values(values).to_toml())
    return path


def force_and_k(model: LimbModel, off_mm: tuple[float, float], temp_degc: float) -> tuple[np.ndarray, np.ndarray]:
    """The simulated limb, held off by a displacement, tells the force there and, by differences, K."""
    near_mm = 1e-3
    moved = near_mm * np.array([[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1]]) + off_mm
    rows = np.ones(len(moved))
    columns = {
        "run": np.arange(len(moved), dtype=np.int32), "t_s": np.arange(len(moved), dtype=float),
        "theta1_rad": 0.9 * rows, "theta2_rad": 1.3 * rows, "temp_degc": temp_degc * rows,
        "dx_mm": moved[:, 0].copy(), "dz_mm": moved[:, 1].copy(),
    }  # fmt: skip
    played = LoadingPlayer(columns).play(model, ("fx_n", "fz_n"))
    force = np.stack([played["fx_n"], played["fz_n"]], axis=1)
    return force[0], np.stack([force[1] - force[2], force[3] - force[4]], axis=1) / (2.0 * near_mm)


@pytest.mark.parametrize("temp_degc", [22.0, 62.0, 2.0])
@pytest.mark.parametrize("hardens", [False, True])
def test_warm_joints(
    brace: Callable[..., Outcome], heavy_limb: Path, tmp_path: Path, temp_degc: float, hardens: bool
) -> None:
    model = load_limb(heavy_limb).with_values({"thermal.joint_compliance_per_degc": 0.008})
    if hardens:
        model = model.with_values({"joint.femur.hardening_n_mm_per_rad3": 3e8})
    limb = tmp_path / "warm.toml"
    limb.write_text(model.to_toml())
    off_mm = (6.0, 15.0)
    force, k = force_and_k(model, off_mm, temp_degc)
    given = ("k", "--model", limb, "--theta1", 0.9, "--theta2", 1.3, "--fx", force[0], "--fz", force[1], "--json")
    told = json.loads(brace(*given, "--temp", temp_degc).out)
    assert told["temp_degc"] == temp_degc
    assert [told["tip_dx_mm"], told["tip_dz_mm"]] == pytest.approx(off_mm, abs=0.02 * np.hypot(*off_mm))
    k_told = np.array([[told["k_xx_n_per_mm"], told["k_xz_n_per_mm"]], [told["k_xz_n_per_mm"], told["k_zz_n_per_mm"]]])
    assert np.linalg.norm(k_told - k) <= WORST_K * np.linalg.norm(k)
    cold = json.loads(brace(*given).out)  # at the reference, 22 degC
    assert (abs(cold["k_zz_n_per_mm"] - k[1, 1]) > 2 * WORST_K * k[1, 1]) == (temp_degc != 22.0)


def test_a_temperature_counts_without_a_load(brace: Callable[..., Outcome], paper_limb: Path, tmp_path: Path) -> None:
    """Twice the compliance of every joint is what 0.025 / degC gives 40 degC above the reference."""
    model = load_limb(paper_limb).with_values({"link.femur.lateral_mm_per_n": 0.1, "link.tibia.lateral_mm_per_n": 0.1})
    keys = [f"joint.{joint}.compliance_rad_per_n_mm" for joint in ("coxa", "femur", "tibia")]
    warm, soft = tmp_path / "warm.toml", tmp_path / "soft.toml"
    warm.write_text(model.with_values({"thermal.joint_compliance_per_degc": 0.025}).to_toml())
    soft.write_text(model.with_values({key: 2.0 * model.number(key) for key in keys}).to_toml())
    for posture in ((), ("--theta0", 0.3)):
        at = (*posture, "--theta1", 1.0, "--theta2", 1.4, "--json")
        told = json.loads(brace("k", "--model", warm, *at, "--temp", 62).out)
        wanted = json.loads(brace("k", "--model", soft, *at).out)
        for name in ("k_xx_n_per_mm", "k_zz_n_per_mm", "lambda_min_n_per_mm"):
            assert told[name] == pytest.approx(wanted[name], rel=1e-6)
    table, out = tmp_path / "in.csv", tmp_path / "out.csv"
    table.write_text("theta1_rad,theta2_rad\n1.0,1.4\n")
    assert brace("k", "--model", warm, "--csv", table, "--out", out, "--temp", 62).code == 0
    plane = json.loads(brace("k", "--model", soft, "--theta1", 1.0, "--theta2", 1.4, "--json").out)
    assert float(rows_of(out)[0]["k_xx_n_per_mm"]) == pytest.approx(plane["k_xx_n_per_mm"], rel=1e-6)
    refused = brace("k", "--model", warm, "--theta1", 1.0, "--theta2", 1.4, "--temp", 330)
    assert refused.code == 2 and "no joint's temperature" in refused.err


@pytest.mark.parametrize("joints", [("femur",), ("tibia",), ("femur", "tibia")])
def test_springs_that_harden(heavy_limb: Path, joints: tuple[str, ...]) -> None:
    off_mm = (6.0, 15.0)
    model = load_limb(heavy_limb)
    linear = model
    for joint in joints:
        model = model.with_values({f"joint.{joint}.hardening_n_mm_per_rad3": 3e8})
    force, k = force_and_k(model, off_mm, 22.0)
    at = (np.array([1.0]), np.array([1.3]), force[:1], force[1:])  # commanded, with the zero offset
    told = stiffness_under_load(model, *at)[0]
    assert [told["tip_dx_mm"], told["tip_dz_mm"]] == pytest.approx(off_mm, abs=0.02 * np.hypot(*off_mm))
    k_told = np.array([[told["k_xx_n_per_mm"], told["k_xz_n_per_mm"]], [told["k_xz_n_per_mm"], told["k_zz_n_per_mm"]]])
    assert np.linalg.norm(k_told - k) <= WORST_K * np.linalg.norm(k)
    soft = stiffness_under_load(linear, *at)[0]
    assert soft["k_zz_n_per_mm"] < 0.95 * k[1, 1]  # it matters here


def rows_of(path: Path) -> list[dict[str, str]]:
    with path.open() as file:
        return list(csv.DictReader(file))


def test_against_the_reference(brace: Callable[..., Outcome], heavy_limb: Path, tmp_path: Path) -> None:
    random = np.random.default_rng(8)
    postures = np.column_stack([random.uniform(-0.5, 1.2, 60), random.uniform(0.5, 2.5, 60)])
    forces = random.uniform(-12.0, 12.0, (60, 2))
    table, out = tmp_path / "in.csv", tmp_path / "out.csv"
    lines = [",".join(f"{value:.9g}" for value in row) for row in np.hstack([postures, forces]).tolist()]
    table.write_text("\n".join(["theta1_rad,theta2_rad,fx_n,fz_n", *lines]) + "\n")
    assert brace("k", "--model", heavy_limb, "--csv", table, "--out", out).code == 0
    true = loaded.under_force(load_limb(heavy_limb), postures[:, 0] + 0.1, postures[:, 1], forces)
    judged = 0
    for index, row in enumerate(rows_of(out)):
        factor = float(true["buckling_factor"][index])
        moved_mm = true.displacement_mm[index]
        if factor < 2.0 or np.hypot(*moved_mm) > 0.2 * (185.0 + 313.5):
            continue
        judged += 1
        xx, xz, zz = (float(row[f"k_{axes}_n_per_mm"]) for axes in ("xx", "xz", "zz"))
        k = np.array([[xx, xz], [xz, zz]])
        assert np.linalg.norm(k - true.k_n_per_mm[index]) <= WORST_K * np.linalg.norm(k)
        assert (
            np.hypot(
                float(row["tip_dx_mm"]) - moved_mm[0],
                float(row["tip_dz_mm"]) - moved_mm[1],
            )
            <= WORST_MM
        )
        if factor < 10.0:
            assert float(row["buckling_factor"]) == pytest.approx(factor, rel=WORST_FACTOR)
        c = [float(row[f"c_{axes}_mm_per_n"]) for axes in ("xx", "xz", "zz")]
        assert k @ np.array([[c[0], c[1]], [c[1], c[2]]]) == pytest.approx(np.eye(2), abs=1e-4)
    assert judged >= 40


@pytest.mark.parametrize("ask", [loaded.under_force, loaded.under_displacement])
def test_a_beam_is_as_of_very_many_parts(ask: Callable[..., loaded.LoadedLimbs], paper_limb: Path) -> None:
    """Unless somebody asks for few; one part is not enough."""
    values = {"link.femur.moment_transfer": True, "link.tibia.bending_mm_per_n": 0.5}
    model = load_limb(paper_limb).with_values(values)

    def k(**given: int) -> np.ndarray:
        return ask(model, 1.0, 1.4, [[2.0, 3.0]], **given).k_n_per_mm

    assert k() == pytest.approx(k(parts=400), rel=1e-6)
    assert k() != pytest.approx(k(parts=1), rel=1e-6)


def test_a_single_posture(brace: Callable[..., Outcome], paper_limb: Path) -> None:
    given = ("k", "--model", paper_limb, "--theta1", 1.0, "--theta2", 1.4)
    plain = json.loads(brace(*given, "--json").out)
    loaded_k = json.loads(brace(*given, "--fz", 10, "--json").out)
    assert loaded_k.keys() >= ADDED and not plain.keys() & ADDED
    assert (loaded_k["fx_n"], loaded_k["fz_n"], loaded_k["arith"]) == (
        0.0,
        10.0,
        "loaded",
    )
    true = loaded.under_force(load_limb(paper_limb), 1.0, 1.4, [[0.0, 10.0]])
    assert loaded_k["k_xx_n_per_mm"] == pytest.approx(float(true["k_xx"][0]), rel=WORST_K)
    assert abs(loaded_k["k_xx_n_per_mm"] / plain["k_xx_n_per_mm"] - 1.0) > 0.02  # load matters
    told = brace(*given, "--fz", 10).out
    assert "(0, 10) N" in told and "buckling factor" in told


def test_no_force_and_no_weight_is_the_plain_k(brace: Callable[..., Outcome], paper_limb: Path) -> None:
    given = ("k", "--model", paper_limb, "--theta1", 1.0, "--theta2", 1.4)
    plain = json.loads(brace(*given, "--json").out)
    at_rest = json.loads(brace(*given, "--fx", 0, "--json").out)
    for name, value in plain.items():
        if name.startswith(("k_", "lambda_", "stiff_axis")) and "sigma" not in name:
            assert at_rest[name] == pytest.approx(value, rel=2e-6, abs=2e-6), name
    assert at_rest["buckling_factor"] is None and at_rest["tip_dx_mm"] == pytest.approx(0.0, abs=1e-4)


@pytest.mark.parametrize(
    "options, said",
    [
        (("--fy", 10), "--fy without theta0"),
        (("--fz", 10, "--arith", "general"), "tells K without load"),
        (("--fx", -3000), "no rest was found"),
        (("--fz", 20000), "within +-10000 N"),
    ],
)
def test_what_is_refused(
    options: tuple[object, ...],
    said: str,
    brace: Callable[..., Outcome],
    paper_limb: Path,
) -> None:
    outcome = brace("k", "--model", paper_limb, "--theta1", 0.3, "--theta2", 0.6, *options)
    assert outcome.code == 2 and said in outcome.err


@pytest.mark.parametrize(
    "table, options, said",
    [
        ("theta1_rad,theta2_rad,fx_n\n1,1,2\n", (), "column fx_n without fz_n"),
        ("theta0_rad,theta1_rad,theta2_rad,fy_n\n0,1,1,2\n", (), "column fy_n without fx_n"),
        ("theta1_rad,theta2_rad,fx_n,fy_n,fz_n\n1,1,2,2,2\n", (), "column fy_n without theta0"),
        ("theta1_rad,theta2_rad,fx_n,fz_n\n1,1,2,x\n", (), "(row 1), fz_n"),
        (
            "theta1_rad,theta2_rad,fx_n,fz_n\n1,1,2,3\n",
            ("--fz", 1),
            "drop --fx, --fy and --fz",
        ),
    ],
)
def test_tables_that_are_refused(
    table: str,
    options: tuple[object, ...],
    said: str,
    brace: Callable[..., Outcome],
    paper_limb: Path,
    tmp_path: Path,
) -> None:
    path, out = tmp_path / "in.csv", tmp_path / "out.csv"
    path.write_text(table)
    outcome = brace("k", "--model", paper_limb, "--csv", path, "--out", out, *options)
    assert outcome.code in (2, 3) and said in outcome.err and not out.exists()


def test_sigma_under_load_is_the_spread_of_k(brace: Callable[..., Outcome], paper_limb: Path) -> None:
    """The limb's parameters drawn from its [uncertainty], K by the reference: the spread is what is printed."""
    draw, model, keys = np.random.default_rng(3), load_limb(paper_limb), dict[str, float]()
    values = json.loads(brace("k", "--model", paper_limb, "--theta1", 1.0, "--theta2", 1.4, "--fz", 20, "--json").out)
    names = ("length_mm", "angle_rad", "compliance_rel", "gain_rel")
    trust = {name: model.number(f"uncertainty.{name}") for name in names}
    found = []
    for _ in range(1000):
        gain = 1.0 + trust["gain_rel"] * draw.normal()
        for link in ("femur", "tibia"):
            keys[f"geometry.{link}_mm"] = model.number(f"geometry.{link}_mm") + trust["length_mm"] * draw.normal()
            parts = (f"link.{link}.axial_mm_per_n", f"link.{link}.bending_mm_per_n")
            for name in (*parts, f"joint.{link}.compliance_rad_per_n_mm"):
                keys[name] = model.number(name) * (1.0 + trust["compliance_rel"] * draw.normal()) / gain
        theta1, theta2 = np.array([1.0, 1.4]) + trust["angle_rad"] * draw.normal(size=2)
        drawn = loaded.under_force(model.with_values(keys), float(theta1), float(theta2), [[0.0, 20.0]])
        found.append([float(drawn[name][0]) for name in ("k_xx", "k_xz", "k_zz")])
    # 1,000 draws know a spread to 2.2 % (one sigma); first order is good to some per cent
    for name, spread in zip(("xx", "xz", "zz"), np.std(found, axis=0)):
        assert values[f"sigma_k_{name}_n_per_mm"] == pytest.approx(spread, rel=0.1)
    assert values["sigma_lambda_min_n_per_mm"] > 0 and values["sigma_stiff_axis_rad"] > 0
