"""`brace plan`: what it proposes is as it says, by `brace k` and the firmware's contact functions;
nothing is better."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command_bench import LIMB, Outcome

from brace.model import load_limb
from brace.native import library, loaded

Brace = Callable[..., Outcome]
K = ("k_xx_n_per_mm", "k_xz_n_per_mm", "k_zz_n_per_mm")
EIGEN = ("lambda_min_n_per_mm", "lambda_max_n_per_mm", "stiff_axis_rad")


@pytest.fixture
def limb(tmp_path: Path) -> Path:
    """With zero offsets, so that commanded and true angles differ."""
    path = tmp_path / "limb.toml"
    path.write_text(LIMB.replace("[joint.femur]", "[joint.femur]\nzero_offset_rad = 0.02", 1))
    return path


def planned(brace: Brace, limb: Path, *options: object) -> dict[str, Any]:
    outcome = brace("plan", "--model", limb, *options, "--json")
    assert outcome.code == 0, outcome.err
    return dict(json.loads(outcome.out))


def stiffness(posture: dict[str, float]) -> Any:
    return library().ffi.new("brace_stiffness_t *", {name: posture[name] for name in (*K, *EIGEN)})


def test_k_and_place_are_those_of_the_angles(brace: Brace, limb: Path) -> None:
    for posture in planned(brace, limb, "--count", 6, "--prefer", "soft")["best"]:
        angles = ("--theta1", posture["theta1_rad"], "--theta2", posture["theta2_rad"])
        asked = json.loads(brace("k", "--model", limb, *angles, "--json").out)
        for name in (*K, *EIGEN):
            assert asked[name] == pytest.approx(posture[name], rel=2e-6, abs=2e-6 * posture["lambda_max_n_per_mm"])
        assert asked["r_mm"] == pytest.approx(math.hypot(posture["x_mm"], posture["z_mm"]), abs=1e-3)
        assert asked["phi_rad"] == pytest.approx(math.atan2(posture["z_mm"], posture["x_mm"]), abs=1e-5)
        assert asked["knee"] == posture["knee"]


@pytest.mark.parametrize(
    ("normal_rad", "payload_n", "friction", "bears_mm"),
    [(math.pi / 2, 8.0, 0.5, 0.4), (math.pi, 5.0, 0.6, 1.0), (2.5, 12.0, 0.3, 0.0), (-math.pi / 2, 4.0, 0.7, 0.5)],
)
def test_the_foothold_bears_the_error_of_position_and_no_more(
    brace: Brace, limb: Path, normal_rad: float, payload_n: float, friction: float, bears_mm: float
) -> None:
    """A floor, a wall, a slope, a ceiling. The firmware's cone is asked after an error of position in any direction."""
    ffi, lib = library().ffi, library().lib
    options = ("--payload", payload_n, "--friction", friction, "--normal", normal_rad, "--bears", bears_mm)
    for posture in planned(brace, limb, *options, "--x", 150, 400, "--count", 5)["best"]:
        force = (posture["force_x_n"], posture["force_z_n"])
        pressed = posture["press_n"]
        assert force == pytest.approx(
            (pressed * math.cos(normal_rad), payload_n + pressed * math.sin(normal_rad)), abs=1e-9 * (1 + pressed)
        )
        assert posture["bears_mm"] >= bears_mm - 1e-9
        if pressed > 0.0:
            assert posture["bears_mm"] == pytest.approx(bears_mm, abs=1e-9)  # with less it would not

        def least_margin(size_mm: float, force: tuple[float, float] = force, k: Any = stiffness(posture)) -> float:
            margins = []
            for step in range(720):
                angle = 2 * math.pi * step / 720
                error = ffi.new("brace_displacement_t *", (size_mm * math.cos(angle), size_mm * math.sin(angle)))
                change, grip = ffi.new("brace_contact_force_t *"), ffi.new("brace_contact_grip_t *")
                assert lib.brace_contact_force(k, error[0], change) == 0
                total = ffi.new("brace_force_t *", (force[0] + change.force.x_n, force[1] + change.force.z_n))
                normal = (math.cos(normal_rad), math.sin(normal_rad))
                assert lib.brace_contact_grip(total[0], *normal, friction, grip) == 0
                margins.append(float(grip.margin_n))
            return min(margins)

        size = 1e-4 * (1.0 + pressed + payload_n + posture["lambda_max_n_per_mm"])  # steps of half a degree, floats
        assert least_margin(posture["bears_mm"]) >= -size
        assert least_margin(1.05 * posture["bears_mm"] + 0.02) < 0.0


def test_the_tip_stands_at_its_place_under_the_load(brace: Brace, limb: Path) -> None:
    """By the reference, which was written apart from the firmware's C: K, place, sag, on a limb with weight."""
    limb.write_text(limb.read_text() + "[gravity]\nfemur_n = 2.0\nknee_n = 1.0\ntibia_n = 1.5\n")
    model = load_limb(limb)
    options = ("--payload", 7, "--friction", 0.5, "--normal", 2.6, "--x", 200, 400, "--z", -150, 0, "--count", 5)
    found = planned(brace, limb, *options)["best"]
    assert len(found) == 5
    for posture in found:
        angles = posture["theta1_true_rad"], posture["theta2_true_rad"]
        forces = [[posture["force_x_n"], posture["force_z_n"]], [0.0, 7.0], [0.0, 0.0]]
        true = loaded.under_force(model, *angles, forces)
        k = [posture[name] for name in K]
        exact = true.k_n_per_mm[0][[0, 0, 1], [0, 1, 1]]
        assert k == pytest.approx(exact.tolist(), abs=6e-3 * float(np.linalg.norm(exact)))  # brace/loaded.h
        moved_mm = true.displacement_mm
        stands = posture["set_x_mm"] + moved_mm[0][0], posture["set_z_mm"] + moved_mm[0][1]
        assert stands == pytest.approx((posture["x_mm"], posture["z_mm"]), abs=0.5)  # brace/loaded.h, and a round
        assert posture["sag_mm"] == pytest.approx(float(np.hypot(*(moved_mm[1] - moved_mm[2]))), abs=0.5)
        asked = ("--theta1", posture["theta1_rad"], "--theta2", posture["theta2_rad"])
        set_point = json.loads(brace("k", "--model", limb, *asked, "--json").out)
        x_mm, z_mm = (set_point["r_mm"] * turn(set_point["phi_rad"]) for turn in (math.cos, math.sin))
        assert (x_mm, z_mm) == pytest.approx((posture["set_x_mm"], posture["set_z_mm"]), abs=0.01)
        # the foot is pushed back onto its place from there: the set-point lies on the other side of the surface
        push = (posture["x_mm"] - posture["set_x_mm"]) * posture["force_x_n"]
        push += (posture["z_mm"] - posture["set_z_mm"]) * posture["force_z_n"]
        assert push > 0.0


def test_demands_are_kept_and_nothing_kept_is_better(brace: Brace, limb: Path) -> None:
    where = ("--x", 100, 450, "--z", -200, 0, "--places", 1000)
    every = planned(brace, limb, *where, "--payload", 6, "--count", 1000, "--prefer", "firm")
    assert every["satisfying"] == every["postures"] > 1000
    firm = [posture["lambda_min_n_per_mm"] for posture in every["best"]]
    assert firm == sorted(firm, reverse=True) and firm[0] > firm[-1]
    asked = ("--lambda-max", 6, "--sag-most", 15, "--lambda-min", 0.3)
    some = planned(brace, limb, *where, "--payload", 6, *asked, "--prefer", "steady", "--count", 3)
    assert 0 < some["satisfying"] < every["postures"] and len(some["demands"]) == 3
    sags = [posture["sag_mm"] for posture in some["best"]]
    assert sags == sorted(sags)
    for posture in some["best"]:
        assert posture["lambda_max_n_per_mm"] <= 6 and posture["sag_mm"] <= 15 and posture["lambda_min_n_per_mm"] >= 0.3
        assert 100 <= posture["x_mm"] <= 450 and -200 <= posture["z_mm"] <= 0
    rivals = [p for p in every["best"] if p["lambda_max_n_per_mm"] <= 6 and p["lambda_min_n_per_mm"] >= 0.3]
    assert rivals and min(p["sag_mm"] for p in rivals) >= sags[0]
    wanted = planned(brace, limb, "--k", 2, -1.5, 2, "--count", 1)["best"][0]
    off = [wanted[name] - goal for name, goal in zip(K, (2, -1.5, 2))]
    assert wanted["off_n_per_mm"] == pytest.approx(math.sqrt(off[0] ** 2 + 2 * off[1] ** 2 + off[2] ** 2)) and (
        wanted["off_n_per_mm"] < 0.3
    )


def test_the_joints_travel_is_kept(brace: Brace, limb: Path) -> None:
    limb.write_text(limb.read_text() + "[motor.tibia]\nangle_min_rad = 0.5\nangle_max_rad = 2.0\n")
    found = planned(brace, limb, "--count", 1000)
    assert {posture["knee"] for posture in found["best"]} == {"up"}
    assert all(0.5 <= posture["theta2_rad"] <= 2.0 for posture in found["best"])


@pytest.mark.parametrize(
    ("options", "code", "words"),
    [
        (("--payload", 5, "--sag-most", 0.01), 1, "sag at most 0.01 mm: 0 of"),
        (("--x", 600, 700), 1, "no posture reaches there"),
        (("--x", 7, 3), 2, "--x 3 7"),
        (("--sag-most", 3), 2, "add --payload"),
        (("--prefer", "light"), 2, "add --friction"),
        (("--payload", -5), 2, "--payload 5"),
        (("--friction", 0), 2, "--friction"),
        (("--normal", 90), 2, "degrees"),
    ],
)
def test_what_cannot_be_is_told(brace: Brace, limb: Path, options: tuple[object, ...], code: int, words: str) -> None:
    outcome = brace("plan", "--model", limb, *options)
    assert outcome.code == code and words in outcome.err and not outcome.out, outcome.err
    assert "why:" in outcome.err and "try:" in outcome.err


def test_for_people(brace: Brace, limb: Path) -> None:
    outcome = brace("plan", "--model", limb, "--z", -120, -100, "--payload", 5, "--friction", 0.5, "--bears", 0.8)
    assert outcome.code == 0 and "least force against the surface" in outcome.out
    assert "5 N let it sag by" in outcome.out and "bears" in outcome.out and "set the tip to" in outcome.out


def test_a_knee_without_travel_is_not_folded_through_its_femur(brace: Brace, limb: Path) -> None:
    for prefer in ("firm", "soft"):
        outcome = brace("plan", "--model", limb, "--prefer", prefer, "--count", 5, "--json")
        knees = [posture["theta2_rad"] for posture in json.loads(outcome.out)["best"]]
        assert knees and max(map(abs, knees)) <= 2.6
        assert "travel" in outcome.err and "[motor.tibia]" in outcome.err


def test_a_given_travel_is_used_as_it_is(brace: Brace, tmp_path: Path) -> None:
    limb = tmp_path / "limb.toml"
    limb.write_text(LIMB + "\n[motor.tibia]\nangle_min_rad = -3.1\nangle_max_rad = 3.1\n")
    outcome = brace("plan", "--model", limb, "--count", 1, "--json")
    assert abs(json.loads(outcome.out)["best"][0]["theta2_rad"]) > 2.6  # the firmest posture is the folded one
    assert "no travel of the knee" not in outcome.err
