"""The reference of loaded limbs against a physics engine: rests under a tip force, weights and K.

Where both have the same rigid segments, only the mechanics are compared: rests are known to 1e-10 mm on both sides, and
K in the engine comes from differences of rests."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import pytest

try:
    import mujoco  # noqa: F401
except ImportError as missing:
    pytest.skip(f"no physics engine ({missing}): .venv/bin/python -m pip install mujoco", allow_module_level=True)

from brace.native.loaded import under_displacement  # noqa: E402
from cases import Case, limb_model, off, random_cases, reference  # noqa: E402
from engine_chain import Array  # noqa: E402
from engine_limb import engine_limb  # noqa: E402
from rest import Engine, Rest  # noqa: E402

PLANE, SPACE = (0, 2), (0, 1, 2)
DOWN = np.array([0.0, 0.0, -1.0])
PAPER = {
    "geometry.femur_mm": 185.0,
    "geometry.tibia_mm": 313.5,
    "link.femur.axial_mm_per_n": 0.001,
    "link.femur.bending_mm_per_n": 0.06,
    "link.tibia.axial_mm_per_n": 0.002,
    "link.tibia.bending_mm_per_n": 0.25,
    "joint.femur.compliance_rad_per_n_mm": 1.0e-5,
    "joint.tibia.compliance_rad_per_n_mm": 1.6e-5,
}
BEAMS = PAPER | {"link.femur.moment_transfer": 1.0, "link.tibia.moment_transfer": 1.0}
CHECK_VALUES = [  # keys, segments, theta1, theta2, force; displacement of the tip and K as printed
    (PAPER, 1, 1.0, 1.4, (0, 0), (0, 0), (3.96389818, -0.63872477, 0.42806022)),
    (PAPER, 1, 1.0, 1.4, (0, 10), (3.80735, 31.80811), (4.256242, -0.334349, 0.331800)),
    (PAPER, 1, 1.0, 1.4, (0, -20), (-13.30591, -56.27056), (3.399383, -1.065312, 0.728438)),
    (PAPER, 1, 0.3, 0.6, (0, 10), (5.05100, 40.91618), (18.234468, -1.407903, 0.348259)),
    (PAPER, 1, 0.3, 0.6, (-20, 0), (-4.65112, -16.69184), (12.914473, -2.788440, 0.813156)),
    (BEAMS, 100, 1.0, 1.4, (0, 0), (0, 0), (4.672129, -0.758153, 0.395809)),
    (BEAMS, 100, 1.0, 1.4, (0, 10), (4.23079, 38.12313), (5.091304, -0.306721, 0.272640)),
    (BEAMS, 100, 0.3, 0.6, (0, 10), (5.72214, 48.83450), (22.428601, -1.369207, 0.283982)),
]


def engine_of(case: Case, segments: int) -> tuple[Engine, Array]:
    """The engine's limb and the tip force in the frame of its plane, which in space is turned by theta0."""
    in_space = len(case.force_n) == 3
    limb = engine_limb(case.keys, *case.theta_rad[1:], segments, in_space=in_space)
    turn = yaw(case) if in_space else np.eye(3)
    force_n = case.force_n if in_space else np.array([case.force_n[0], 0.0, case.force_n[1]])
    return Engine(limb, turn.T @ case.gravity), turn.T @ force_n


def yaw(case: Case) -> Array:
    """From the commanded limb's plane to the robot's frame."""
    cosine, sine = np.cos(case.theta_rad[0]), np.sin(case.theta_rad[0])
    return np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])


def engine_says(case: Case, segments: int) -> tuple[Rest, Array, Array]:
    """Rest, displacement of the tip and K, in the robot's frame."""
    engine, force_n = engine_of(case, segments)
    axes = SPACE if len(case.force_n) == 3 else PLANE
    rest = engine.push(force_n)
    k = engine.k_n_per_mm(rest, force_n, axes)
    moved = rest.tip_mm[list(axes)]
    if axes == SPACE:
        turn = yaw(case)
        return rest, turn @ moved, turn @ k @ turn.T
    return rest, moved, k


@pytest.mark.parametrize("line", CHECK_VALUES, ids=lambda line: f"{line[1]} segments, {line[2:5]}")
def test_check_values(line: tuple[dict[str, float], int, float, float, Array, Array, Array]) -> None:
    """The printed digits, by the engine as by the reference."""
    keys, segments, theta1, theta2, force_n, displacement_mm, k = line
    case = Case(keys, (0.0, theta1, theta2), np.array(force_n, dtype=float), DOWN)
    found = reference(case, parts=-segments)
    told = found.displacement_mm[0], found.k_n_per_mm[0]
    rest, *seen = engine_says(case, segments)
    assert rest.stable
    for moved, matrix in (told, seen):
        np.testing.assert_allclose(moved, displacement_mm, rtol=0, atol=0.6e-5)
        np.testing.assert_allclose(matrix[[0, 0, 1], [0, 1, 1]], k, rtol=0, atol=0.6e-6)


def judge(case: Case, segments: int) -> tuple[float, float, float]:
    """How far the reference's displacement [mm], K and the elastica's K (relative) are from the engine's."""
    same, elastica = reference(case, parts=-segments), reference(case)
    rest, moved, k = engine_says(case, segments)
    assert rest.stable
    return (
        float(np.linalg.norm(moved - same.displacement_mm[0])),
        off(k, same.k_n_per_mm[0]),
        off(k, elastica.k_n_per_mm[0]),
    )


def worst(cases: Iterable[Case], segments: int) -> Array:
    """Of many; printed for the reader of a longer run."""
    found = np.array([judge(case, segments) for case in cases])
    most = np.asarray(found.max(axis=0))
    print(f"{len(found)} limbs: displacement {most[0]:.1e} mm, K {most[1]:.1e}, K of the elastica {most[2]:.1e}")
    return most


def test_random_limbs_in_the_plane(limbs: int) -> None:
    """With equal segments nothing but rounding is between them. The elastica: 24 segments turn by 1/(4 24^2) = 4e-4 too
    much under a moment; at a buckling factor of 2 the load doubles that, and a straight limb's K as much again."""
    displacement_mm, same, elastica = worst(random_cases(20, limbs, in_space=False), 24)
    assert displacement_mm < 1e-9
    assert same < 2e-6
    assert elastica < 2e-3


def test_random_limbs_in_space(limbs: int) -> None:
    """The same with the coxa, forces from every side and any direction of the weights."""
    displacement_mm, same, _ = worst(random_cases(21, max(limbs // 4, 1), in_space=True), 8)
    assert displacement_mm < 1e-9
    assert same < 2e-6


@pytest.mark.parametrize("in_space", [False, True])
def test_finer_segments_approach_the_elastica(in_space: bool) -> None:
    """The reference's default is where the engine's segments lead: half the segment, a quarter of the difference."""
    compared = 0
    for case in random_cases(22, 3, in_space=in_space):
        coarse, fine = (judge(case, segments)[2] for segments in (6, 12))
        if coarse > 1e-5:  # there are beams, and what rounding leaves of K is far below
            assert 3.5 < coarse / fine < 4.5
            compared += 1
    assert compared >= 2


def test_the_engine_moves_to_this_rest() -> None:
    """The rest is where the engine's own integrator brings the limb, damped."""
    case = Case(BEAMS, (0.0, 1.0, 1.4), np.array([0.0, 10.0]), DOWN)
    engine, force_n = engine_of(case, 10)
    wanted = reference(case, parts=-10).displacement_mm[0]
    moved = engine.settle_by_motion(force_n, damping=0.2, steps=10000)
    np.testing.assert_allclose(moved[[0, 2]], wanted, rtol=0, atol=1e-6)


def test_held_tip() -> None:
    """The force that the reference says holds the tip moves the engine's tip there."""
    wanted = np.array([2.54, -6.0])
    keys = BEAMS | {"gravity.tibia_n": 2.0, "gravity.femur_n": 3.0, "gravity.knee_n": 1.0}
    held = under_displacement(limb_model(keys), 0.3, 0.6, wanted, parts=-24)
    case = Case(keys, (0.0, 0.3, 0.6), held.force_n[0], DOWN)
    rest, moved, k = engine_says(case, 24)
    np.testing.assert_allclose(moved, wanted, rtol=0, atol=1e-7)
    assert off(held.k_n_per_mm[0], k) < 1e-6
