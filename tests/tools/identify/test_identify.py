"""`brace identify`: what was put into the data comes out, with honest intervals, and no more than that."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from brace.dataset import load_dataset
from brace.identify.classes import remedy
from brace.identify.combinations import COMBINATIONS
from brace.identify.families import FAMILIES, fit_family
from brace.identify.faults import settle
from brace.identify.fit import fit
from brace.identify.information import information
from brace.identify.loading import LoadingProblem
from brace.identify.parameters import free_compliances, with_priors
from brace.identify.run import Options, identify
from brace.identify.table import TableProblem, Weight
from brace.model import load_limb
from command_bench import LIMB, POSES, Outcome, loading_rows, physics_k, write_loading

KNEE = ("link.tibia.bending_mm_per_n", "joint.tibia.compliance_rad_per_n_mm")


def limb(folder: Path, text: str = LIMB) -> Path:
    path = folder / "limb.toml"
    path.write_text(text)
    return path


def test_parameters_within_their_trust_are_found(tmp_path: Path) -> None:
    """A limb a sigma or so off the calibration, ten noises: nine in ten 90 % intervals hold the truth, and the gap
    goes down to the noise."""
    truth = {
        "link.femur.bending_mm_per_n": 0.057,
        "link.tibia.bending_mm_per_n": 0.26,
        "joint.femur.compliance_rad_per_n_mm": 1.05e-5,
        "joint.tibia.compliance_rad_per_n_mm": 1.53e-5,
        "link.femur.axial_mm_per_n": 0.001,
        "link.tibia.axial_mm_per_n": 0.002,
    }
    start = load_limb(limb(tmp_path))
    held = total = 0
    for seed in range(10):
        rows = loading_rows(seed=seed, bending=(0.057, 0.26), joint=(1.05e-5, 1.53e-5))
        problem = LoadingProblem(load_dataset(write_loading(tmp_path / "d", rows)))
        best = fit(problem, with_priors(start))
        estimates = dict(zip(best.parameters.keys, information(best).estimates()))
        for key, value in truth.items():
            held += estimates[key].low <= value <= estimates[key].high
            total += 1
        assert best.chi2 / best.readings == pytest.approx(1.0, abs=0.15)
    # the priors are centred off the truth, so the intervals are a little generous or a little short: 60 of them
    assert held / total >= 0.8


def test_data_alone_determine_the_femur_spring_and_not_the_knee(tmp_path: Path) -> None:
    truth: dict[str, Any] = dict(bending=(0.08, 0.2), joint=(1.3e-5, 1.2e-5))
    covered = 0
    for seed in range(20):
        dataset = load_dataset(write_loading(tmp_path / "d", loading_rows(seed=seed, **truth)))
        best = fit(LoadingProblem(dataset), free_compliances(load_limb(limb(tmp_path))))
        known = information(best)
        # exactly two: knee spring against tibia bending, and u u' + n n' = 1 of both links
        assert known.null_directions.shape[1] == 2
        estimates = dict(zip(best.parameters.keys, known.estimates()))
        spring = estimates["joint.femur.compliance_rad_per_n_mm"]
        assert spring.identifiable
        covered += spring.low <= 1.3e-5 <= spring.high
        for key in KNEE:
            assert not estimates[key].identifiable
        assert estimates[KNEE[1]].low == 0.0 and estimates[KNEE[1]].high >= 1.2e-5
    # binomial with p = 0.9: at least 14 of 20 in 99.8 % of such tests; all 20 in 12 %
    assert covered >= 14


def test_classes_are_named(tmp_path: Path, brace: Callable[..., Outcome]) -> None:
    folder = write_loading(tmp_path / "d", loading_rows())
    outcome = brace(
        "identify", folder, "--model", limb(tmp_path), "--free", "--out", tmp_path / "f.toml", "--json"
    )
    report = json.loads(outcome.out)
    classes = [set(members) for members in report["indistinguishable"]]
    assert set(KNEE) in classes
    assert {"joint.femur.compliance_rad_per_n_mm", "base.rotation_rad_per_n_mm"} in classes
    assert any(
        "link.femur.moment_transfer" in members and "link.femur.bending_mm_per_n" in members
        for members in classes
    )
    assert any(
        {"base.x_mm_per_n", "base.z_mm_per_n"} <= members and any("axial" in key for key in members)
        for members in classes
    )
    assert any("sensor.gain" in members for members in classes)
    assert any(
        {"sensor.rotation_rad", "sensor.crosstalk_xz", "sensor.crosstalk_zx"} <= members
        for members in classes
    )
    for key in KNEE:
        assert report["parameters"][key]["sigma"] is None and not report["parameters"][key]["identifiable"]
    assert report["split"]["structure_share_low"] < 0.25 < report["split"]["structure_share_high"]


@pytest.mark.parametrize(
    ("members", "words"),
    [
        (("sensor.gain", "link.tibia.bending_mm_per_n"), "a known mass hung on the tip"),
        (("sensor.rotation_rad", "sensor.crosstalk_xz"), "the sensor turned by 90 degrees"),
        (("base.x_mm_per_n", "link.femur.axial_mm_per_n"), "a dial gauge on the base"),
        (KNEE, "output-side encoders at the joints"),
        (("base.x_mm_per_n", "sensor.gain"), "a dial gauge on the base and a known mass hung on the tip"),
        (("link.femur.axial_mm_per_n", "link.tibia.axial_mm_per_n"), "postures further apart"),
    ],
)
def test_each_class_has_the_measurement_that_separates_it(members: tuple[str, ...], words: str) -> None:
    assert remedy(members) == words


def test_the_split_reaches_as_far_as_the_knee_can_be_exchanged(tmp_path: Path) -> None:
    """Knee spring and tibia bending make the same readings, so the allowed share of the structure must reach from
    all of the knee's compliance in the spring to all of it in the tibia; both ends by formula."""
    start = load_limb(limb(tmp_path))
    dataset = load_dataset(write_loading(tmp_path / "d", loading_rows(noise_n=0.05)))
    found = identify(dataset, start, Options()).split
    assert found is not None

    def share(bending: float, spring: float) -> float:
        shares = []
        for theta1, theta2 in POSES:
            c = np.linalg.inv(physics_k(theta1, theta2, bending=(0.06, bending), joint=(1e-5, spring)))
            tip = 185 + 313.5 * np.exp(1j * theta2)
            shares.append(1 - (1e-5 * abs(tip) ** 2 + spring * 313.5**2) / np.trace(c))
        return float(np.mean(shares))

    least, most = share(0.0, 1.6e-5 + 0.25 / 313.5**2), share(0.25 + 1.6e-5 * 313.5**2, 0.0)
    assert found.structure_share == pytest.approx(share(0.25, 1.6e-5), abs=0.02)
    # noise and the trusted parameters widen the interval a little beyond the two ends
    assert least - 0.06 < found.allowed[0] <= least + 0.01
    assert most - 0.01 <= found.allowed[1] < most + 0.06


def identified(folder: Path, record: Path) -> tuple[object, ...]:
    """A command for the slopes, which do not depend on what is fitted: one number, which takes the least time."""
    files = (record, "--model", limb(folder), "--out", folder / "f.toml")
    return ("identify", *files, "--only", "link.femur.bending_mm_per_n", "--json")


def test_slopes_by_both_estimators(tmp_path: Path, brace: Callable[..., Outcome]) -> None:
    folder = write_loading(tmp_path / "d", loading_rows(noise_n=0.0))
    outcome = brace(*identified(tmp_path, folder))
    slopes = json.loads(outcome.out)["slopes"]
    assert [entry["config"] for entry in slopes] == [1, 2, 3, 4, 5]
    for (theta1, theta2), entry in zip(POSES, slopes):
        k = physics_k(theta1, theta2)
        for method in ("least_squares", "mean_of_ratios"):
            found = [[entry[f"{method}_k_{row}{column}_n_per_mm"] for column in "xz"] for row in "xz"]
            assert np.abs(np.array(found) - k).max() < 1e-5 * np.abs(k).max()


def test_the_papers_estimator_is_its_own(tmp_path: Path, brace: Callable[..., Outcome]) -> None:
    """One reading off by 1 N at one step: it weighs d/sum(d^2) in least squares and 1/(n d) in the mean of ratios."""
    rows = loading_rows(noise_n=0.0)
    rows[1][11] = f"{float(rows[1][11]) + 1.0:.6f}"  # first run, along x, first step, 0.635 mm; two repeats
    folder = write_loading(tmp_path / "d", rows)
    outcome = brace(*identified(tmp_path, folder))
    first = json.loads(outcome.out)["slopes"][0]
    places = np.array([1, 2, 3, 4, 3, 2, 1, -1, -2, -3, -4, -3, -2, -1]) * 0.635  # steps at 0 are not counted
    k_xx = physics_k(*POSES[0])[0, 0]
    assert first["least_squares_k_xx_n_per_mm"] - k_xx == pytest.approx(
        0.5 * 0.635 / np.sum(places**2), rel=1e-3
    )
    assert first["mean_of_ratios_k_xx_n_per_mm"] - k_xx == pytest.approx(0.5 / 0.635 / places.size, rel=1e-3)


def test_combinations_by_formula(tmp_path: Path) -> None:
    for strength in (0.0, 1.0):
        text = (
            LIMB.replace("[link.tibia]", f"moment_transfer = {strength}\n[link.tibia]")
            + "[base]\nrotation_rad_per_n_mm = 3e-6\n"
        )
        model = load_limb(limb(tmp_path, text))
        b1, b2 = 0.06 / 185**2, 0.25 / 313.5**2
        expected = {
            "a11_rad_per_n_mm": 1.3e-5 + b1,
            "a12_rad_per_n_mm": b1 / 2 if strength else -b1,
            "a22_rad_per_n_mm": 1.6e-5 + b1 + b2,
        }
        assert {name: function(model) for name, function in COMBINATIONS.items()} == pytest.approx(expected)


def test_encoders_separate_joints_from_links(
    tmp_path: Path, brace: Callable[..., Outcome], paper_rig: Path
) -> None:
    rig = tmp_path / "rig.toml"
    rig.write_text(
        paper_rig.read_text().replace(
            "noise_n = 0.1", "noise_n = 0.1\nencoders = true\n" "encoder_noise_rad = 2e-5"
        )
    )
    assert brace("simulate", "--model", limb(tmp_path), "--rig", rig, "--out", tmp_path / "d").code == 0
    start = tmp_path / "start.toml"
    start.write_text(LIMB.replace("1.6e-5", "2.0e-5").replace("0.25", "0.15"))
    outcome = brace(
        "identify", tmp_path / "d", "--model", start, "--free", "--out", tmp_path / "f.toml", "--json"
    )
    report = json.loads(outcome.out)
    knee = report["parameters"][KNEE[1]]
    assert knee["identifiable"] and knee["value"] == pytest.approx(1.6e-5, rel=0.01)
    assert set(KNEE) not in [set(members) for members in report["indistinguishable"]]


def test_the_papers_table(
    tmp_path: Path, brace: Callable[..., Outcome], paper_table: Path, paper_limb: Path
) -> None:
    out = tmp_path / "fitted.toml"
    outcome = brace("identify", paper_table, "--model", paper_limb, "--out", out, "--json")
    report = json.loads(outcome.out)
    assert outcome.code == 0
    chi2 = {entry["family"]: entry["chi2_per_entry"] for entry in report["families"]}
    for family, expected in (
        ("ellipsoids only", 3.7),
        ("two joint springs only", 2.8),
        ("ellipsoids and springs", 2.2),
        ("beams with moment transfer", 2.4),
    ):
        found = next(value for name, value in chi2.items() if name.startswith(family))
        assert found == pytest.approx(expected, abs=0.05)
    heights = [entry["tip_height_mm"] for entry in report["families"][:4]]
    assert -132 < min(heights) and max(heights) < -115
    assert min(chi2.values()) > 1.0
    faults = {(fault["row"], fault["field"]): fault["suggestion"] for fault in report["data_faults"]}
    assert faults[1, "k_zz"] == 11.0 and faults[None, "unit"] == "N/mm"
    assert any("row 1" in text and "11" in text for text in report["done_to_data"])
    assert report["split"]["structure_share_low"] < 0.30 < report["split"]["structure_share_high"]
    fitted = load_limb(out)
    assert "inference" in out.read_text() and fitted.number("joint.femur.compliance_rad_per_n_mm") > 0


def test_a_family_against_an_independent_fit(paper_table: Path, paper_limb: Path) -> None:
    """The springs-only family on a grid of its three parameters, K by formula: no better fit is found."""
    dataset, _ = settle(load_dataset(paper_table), "repair")
    family = next(family for family in FAMILIES if family.name == "two joint springs only")
    believed = load_limb(paper_limb)
    springs = fit_family(TableProblem(dataset, believed, Weight()), believed, family)
    measured = np.column_stack([dataset["k_xx"], dataset["k_xz"], dataset["k_zz"]])
    springs_rad_per_n_mm = np.array(
        [(femur, tibia) for femur in np.linspace(1.6e-5, 2.3e-5, 15) for tibia in np.linspace(2.4e-5, 3.6e-5, 13)])

    def compliance(theta1: float, theta2: float, joint: tuple[float, float]) -> np.ndarray:
        return np.linalg.inv(physics_k(theta1, theta2, axial=(0, 0), bending=(0, 0), joint=joint))

    best = np.inf
    for height in np.linspace(-150, -110, 21):
        theta2 = np.arccos((dataset["r_mm"] ** 2 - 185**2 - 313.5**2) / (2 * 185 * 313.5))
        theta1 = np.arcsin(height / dataset["r_mm"]) + np.arctan2(
            313.5 * np.sin(theta2), 185 + 313.5 * np.cos(theta2)
        )
        # C is a sum of one part for each spring: two springs at each posture give every pair of them.
        c = np.zeros((len(springs_rad_per_n_mm), len(theta1), 2, 2))
        for at, (a, b) in enumerate(zip(theta1, theta2)):
            both, more = compliance(a, b, (1e-5, 1e-5)), compliance(a, b, (2e-5, 1e-5))
            femur, tibia = (more - both) / 1e-5, (2.0 * both - more) / 1e-5
            c[:, at] = np.tensordot(springs_rad_per_n_mm, np.stack([femur, tibia]), 1)
        k = np.linalg.inv(c)
        off = (np.stack([k[..., 0, 0], k[..., 0, 1], k[..., 1, 1]], -1) - measured) / (0.3 + 0.1 * abs(measured))
        best = min(best, float(np.sum(off**2, (1, 2)).min()))
    assert springs.fit.chi2 <= best
    assert springs.fit.chi2 == pytest.approx(best, rel=0.02)


def test_faulty_rows(
    tmp_path: Path, brace: Callable[..., Outcome], paper_table: Path, paper_limb: Path
) -> None:
    out = tmp_path / "f.toml"
    refused = brace("identify", paper_table, "--model", paper_limb, "--out", out, "--faults", "refuse")
    assert refused.code == 3 and "data.csv:2 (row 1), k_zz" in refused.err and "11.0" in refused.err
    assert not out.exists()
    dropped = brace(
        "identify", paper_table, "--model", paper_limb, "--out", out, "--faults", "drop", "--json"
    )
    assert json.loads(dropped.out)["residual"]["readings"] == 33
    rows = loading_rows()
    for row in rows:
        row[9] = f"{float(row[9]) / 25.4:.6f}"
        row[10] = f"{float(row[10]) / 25.4:.6f}"
    inches = write_loading(tmp_path / "inches", rows)
    outcome = brace("identify", inches, "--model", paper_limb, "--out", tmp_path / "g.toml")
    assert outcome.code == 3 and "inches" in outcome.err and not (tmp_path / "g.toml").exists()


def test_a_parameter_beyond_its_trust_is_a_finding(tmp_path: Path, brace: Callable[..., Outcome]) -> None:
    folder = write_loading(tmp_path / "d", loading_rows(bending=(0.12, 0.25)))
    outcome = brace("identify", folder, "--model", limb(tmp_path), "--out", tmp_path / "f.toml", "--json")
    found = json.loads(outcome.out)["outside_trust"]
    assert found and found[0]["key"].startswith(("link.femur", "joint.femur", "geometry.femur"))


def test_extra_and_only_keys(tmp_path: Path, brace: Callable[..., Outcome]) -> None:
    folder = write_loading(tmp_path / "d", loading_rows(moment_transfer=1.0))
    outcome = brace(
        "identify",
        folder,
        "--model",
        limb(tmp_path),
        "--only",
        "link.femur.moment_transfer",
        "--out",
        tmp_path / "f.toml",
        "--json",
    )
    report = json.loads(outcome.out)
    assert list(report["parameters"]) == ["link.femur.moment_transfer"]
    assert report["parameters"]["link.femur.moment_transfer"]["value"] == pytest.approx(1.0, abs=0.02)
    outcome = brace(
        "identify", folder, "--model", limb(tmp_path), "--fit", "sensor.bais_x_n", "--out", tmp_path / "g"
    )
    assert outcome.code == 2 and "sensor.bias_x_n" in outcome.err


def test_a_joint_test_gives_back_its_joint(tmp_path: Path, brace: Callable[..., Outcome]) -> None:
    """Spring, play, friction and noise written out here by hand, not by the plant."""
    random = np.random.default_rng(0)
    sweep = np.concatenate([np.linspace(0, 1, 150), np.linspace(1, -1, 300), np.linspace(-1, 1, 300)])
    angle, centre = 0.02 * sweep, 0.055
    spring = np.where(np.abs(angle) > 0.003, angle - 0.003 * np.sign(angle), 0.0) / 1e-5
    torque = (
        spring + 120.0 * np.sign(np.diff(angle, prepend=-1e-9)) + 20.0 * random.standard_normal(angle.size)
    )
    (tmp_path / "meta.toml").write_text('format = 1\nkind = "joint_test"\n')
    (tmp_path / "data.csv").write_text(
        "t_s,angle_rad,torque_n_mm\n"
        + "".join(
            f"{0.1 * i:.1f},{a + centre:.7f},{t + 35.0:.3f}\n" for i, (a, t) in enumerate(zip(angle, torque))
        )
    )
    outcome = brace("identify", tmp_path, "--model", limb(tmp_path), "--out", tmp_path / "f.toml", "--json")
    found = json.loads(outcome.out)["parameters"]
    assert found["joint.femur.compliance_rad_per_n_mm"]["value"] == pytest.approx(1e-5, rel=0.03)
    assert found["joint.femur.gap_rad"]["value"] == pytest.approx(0.006, rel=0.05)
    assert found["joint.femur.coulomb_n_mm"]["value"] == pytest.approx(120.0, rel=0.05)
    assert found["angle_zero_rad"]["value"] == pytest.approx(-centre, abs=1e-4)
    assert found["angle_zero_rad"]["start"] == pytest.approx(-centre, abs=1e-6)
    # the encoder's zero is the record's: it does not turn the limb, and `predict` finds it again
    assert load_limb(tmp_path / "f.toml").number("joint.femur.zero_offset_rad") == 0.0
    assert "angle" in (tmp_path / "f.toml").read_text().splitlines()[2]
    gap = json.loads(outcome.out)["residual"]["rms_n_mm"]
    played = brace("predict", tmp_path, "--model", tmp_path / "f.toml", "--out", tmp_path / "p.csv", "--json")
    assert json.loads(played.out)["rms_gap_torque_n_mm"] == pytest.approx(gap, rel=1e-3)
    assert "zero of the angle -0.05" in played.err


@pytest.mark.parametrize("rows", [1, 5, 34])
def test_too_little_to_say_anything(rows: int, tmp_path: Path, brace: Callable[..., Outcome]) -> None:
    folder = write_loading(tmp_path / "d", loading_rows()[:rows])
    outcome = brace("identify", folder, "--model", limb(tmp_path), "--out", tmp_path / "f.toml")
    assert outcome.code in (0, 3) and (outcome.code == 0) == (tmp_path / "f.toml").exists()
    if rows < 4:
        assert outcome.code == 3


def test_all_zero_and_all_equal_records(tmp_path: Path, brace: Callable[..., Outcome]) -> None:
    for change in ({9: "0.0", 10: "0.0"}, {11: "0.0", 12: "0.0"}):
        rows = loading_rows()
        for row in rows:
            for place, text in change.items():
                row[place] = text
        outcome = brace(
            "identify",
            write_loading(tmp_path / "d", rows),
            "--model",
            limb(tmp_path),
            "--out",
            tmp_path / "f.toml",
        )
        assert outcome.code in (0, 3) and outcome.err


def test_rows_at_the_straight_and_the_folded_limb(
    tmp_path: Path, brace: Callable[..., Outcome], paper_limb: Path
) -> None:
    """Springs alone are rigid there: that kind of limb is left out, the others are fitted."""
    folder = tmp_path / "t"
    folder.mkdir()
    (folder / "meta.toml").write_text('format = 1\nkind = "stiffness_table"\n')
    (folder / "data.csv").write_text(
        "r_mm,k_xx,k_xz,k_zx,k_zz\n128.5,2.00,-1.00,-1.00,2.00\n498.5,2.50,-1.00,-1.00,2.00\n"
    )
    outcome = brace("identify", folder, "--model", paper_limb, "--out", tmp_path / "f.toml", "--json")
    families = [entry["family"] for entry in json.loads(outcome.out)["families"]]
    assert outcome.code == 0 and "two joint springs only" not in families and len(families) >= 4
