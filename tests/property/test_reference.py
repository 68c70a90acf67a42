"""The double-precision reference against other ways of writing the same limb."""
from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from host_library import Model, Refused, check, doubles, ffi, lib, planar_reference, spatial_reference
from limbs import PAPER, geometry, limb, quarter_turn, random_limb, symmetric

SEEDS = range(12)


def postures(draw: np.random.Generator, count: int) -> tuple[Any, Any]:
    """True angles over the whole workspace, near-straight and near-folded included."""
    theta2 = np.concatenate([draw.uniform(-np.pi, np.pi, count - 4), [1e-6, np.pi - 1e-6, 0.3, -1e-4]])
    return draw.uniform(-np.pi, np.pi, count), theta2


def dot_form(model: Model, theta1: float, theta2: float) -> Any:
    """physics.md's second form of C, by levers and coefficients a11, a12, a22 (links without tilt)."""
    g = geometry(model, theta1, theta2)
    l1, l2 = model["geometry.femur_mm"], model["geometry.tibia_mm"]
    b1, b2 = model["link.femur.bending_mm_per_n"], model["link.tibia.bending_mm_per_n"]
    a11 = model["joint.femur.compliance_rad_per_n_mm"] + model["base.rotation_rad_per_n_mm"] + b1 / l1**2
    a22 = model["joint.tibia.compliance_rad_per_n_mm"] + b1 / l1**2 + b2 / l2**2
    a12 = b1 / l1**2 * (-1.0 + 1.5 * model["link.femur.moment_transfer"])
    p1, p2 = g["p1"], g["p2"]
    return (a11 * np.outer(p1, p1) + a12 * (np.outer(p1, p2) + np.outer(p2, p1)) + a22 * np.outer(p2, p2)
            + model["link.femur.axial_mm_per_n"] * np.outer(g["u1"], g["u1"])
            + model["link.tibia.axial_mm_per_n"] * np.outer(g["u2"], g["u2"])
            + np.diag([model["base.x_mm_per_n"], model["base.z_mm_per_n"]]))


def test_check_values() -> None:
    """The K that physics.md prints, to its last digit."""
    row = planar_reference(limb(PAPER), 1.0, 1.4)[0]
    np.testing.assert_allclose(row[:3], [3.96389818, -0.63872477, 0.42806022], rtol=0, atol=5e-9)


@pytest.mark.parametrize("seed", SEEDS)
def test_levers_and_coefficients_give_the_same_c(seed: int) -> None:
    """Sum of elements against the dot form. Both sum a dozen terms in (long) double: 1e-13 of the largest."""
    draw = np.random.default_rng(seed)
    model = limb({key: value for key, value in random_limb(draw).items() if "tilt" not in key})
    theta1, theta2 = postures(draw, 50)
    rows = planar_reference(model, theta1, theta2)
    c = symmetric(*rows[:, 3:6].T)
    wanted = np.array([dot_form(model, *angles) for angles in zip(theta1, theta2)])
    assert np.abs(c - wanted).max() <= 1e-13 * np.abs(wanted).max()


def test_ellipsoids_alone_are_the_papers_equation_3() -> None:
    """C = R1 diag R1' + R2 diag R2', tilt being part of the rotation."""
    draw = np.random.default_rng(3)
    keys = {key: value for key, value in random_limb(draw, base=False).items()
            if key.startswith(("geometry", "link")) and "moment" not in key}
    model = limb(keys)
    for theta1, theta2 in zip(*postures(draw, 30)):
        wanted = np.zeros((2, 2))
        for link, angle in (("femur", theta1), ("tibia", theta1 - theta2)):
            angle += keys[f"link.{link}.tilt_rad"]
            turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
            wanted += turn @ np.diag([keys[f"link.{link}.axial_mm_per_n"],
                                      keys[f"link.{link}.bending_mm_per_n"]]) @ turn.T
        c = symmetric(*planar_reference(model, theta1, theta2)[0, 3:6])
        np.testing.assert_allclose(c, wanted, rtol=0, atol=1e-14 * wanted.max())


def test_moment_transfer_is_a_uniform_beams_work() -> None:
    """Tip compliance along any force = twice the strain energy, integrated along the femur point by point.

    Only bending of the femur yields; Gauss's two-point rule is exact for the quadratic integrand.
    """
    l1, b1 = 185.0, 0.06
    model = limb({"geometry.femur_mm": l1, "link.femur.bending_mm_per_n": b1,
                  "link.femur.moment_transfer": 1.0, "link.tibia.axial_mm_per_n": 1e-3,
                  "link.tibia.bending_mm_per_n": 1e-3})
    draw = np.random.default_rng(4)
    for theta1, theta2 in zip(*postures(draw, 20)):
        g = geometry(model, theta1, theta2)
        force = draw.normal(size=2)
        tip = g["a"] + g["w"]
        flexibility = 3.0 * b1 / l1**3
        work = 0.0
        for node in (-1 / np.sqrt(3), 1 / np.sqrt(3)):
            at = tip - g["u1"] * l1 * (1 + node) / 2
            moment = at[0] * force[1] - at[1] * force[0]
            work += 0.5 * l1 * flexibility * moment**2
        row = planar_reference(model, theta1, theta2)[0]
        wanted = work + 1e-3 * force @ force
        got = force @ symmetric(*row[3:6]) @ force
        assert got == pytest.approx(wanted, rel=1e-12)


@pytest.mark.parametrize("seed", SEEDS)
def test_k_inverts_c_and_its_eigenvalues_are_right(seed: int) -> None:
    """K C = 1; trace and determinant; the determinant by positive terms only, which loses nothing."""
    draw = np.random.default_rng(100 + seed)
    keys = random_limb(draw)
    model = limb(keys)
    theta1, theta2 = postures(draw, 50)
    rows = planar_reference(model, theta1, theta2)
    k, c = symmetric(*rows[:, :3].T), symmetric(*rows[:, 3:6].T)
    condition = rows[:, 7] / rows[:, 6]
    error = np.abs(k @ c - np.eye(2)).max(axis=(1, 2))
    assert np.all(error <= 8 * 2.2e-16 * condition)
    np.testing.assert_allclose(rows[:, 6] + rows[:, 7], k[:, 0, 0] + k[:, 1, 1], rtol=1e-14)
    # A column of K along the stiff axis is lambda_max times it.
    axis = np.stack([np.cos(rows[:, 8]), np.sin(rows[:, 8])], -1)
    stretched = np.einsum("nij,nj->ni", k, axis)
    np.testing.assert_allclose(stretched, rows[:, 7, None] * axis, rtol=0, atol=1e-13 * rows[:, 7].max())
    assert np.all((rows[:, 8] > -np.pi / 2) & (rows[:, 8] <= np.pi / 2))
    assert np.all(rows[:, 6] > 0)


def test_small_eigenvalue_of_a_slender_limb() -> None:
    """Almost straight, lambda_max is 1e6 times lambda_min; 1/lambda_max of C = sum s v v' still to 1e-12.

    det C = sum of s_i s_j (v_i x v_j)^2 and trace C = sum of s_i |v_i|^2, positive terms only.
    """
    model = limb({"link.femur.axial_mm_per_n": 1e-5, "link.tibia.axial_mm_per_n": 1e-5,
                  "link.femur.bending_mm_per_n": 0.3, "link.tibia.bending_mm_per_n": 0.3,
                  "joint.femur.compliance_rad_per_n_mm": 1e-4})
    for theta2 in (1e-2, 1e-3, 1e-4, 3.14):
        g = geometry(model, 0.7, theta2)
        terms = [(1e-5, g["u1"]), (1e-5, g["u2"]), (0.3, quarter_turn(g["u1"])), (0.3, quarter_turn(g["u2"])),
                 (1e-4, g["p1"])]
        # cross products of unit vectors from the angle itself, not from their difference
        determinant = 0.0
        for i, (s, v) in enumerate(terms):
            for t, w in terms[:i]:
                determinant += s * t * (v[0] * w[1] - v[1] * w[0]) ** 2
        trace = sum(s * (v @ v) for s, v in terms)
        largest_c = 0.5 * (trace + np.sqrt(trace**2 - 4 * determinant))
        row = planar_reference(model, 0.7, theta2)[0]
        assert row[6] == pytest.approx(1 / largest_c, rel=1e-12)
        assert row[7] == pytest.approx(largest_c / determinant, rel=1e-12)


@pytest.mark.parametrize("seed", SEEDS)
def test_turning_the_limb_turns_k(seed: int) -> None:
    """Without a base in x and z, another theta1 turns K as a whole and leaves its eigenvalues."""
    draw = np.random.default_rng(200 + seed)
    model = limb({key: value for key, value in random_limb(draw).items() if not key.startswith("base.")})
    theta1, theta2 = postures(draw, 30)
    turn_by = draw.uniform(-3, 3)
    before, after = planar_reference(model, theta1, theta2), planar_reference(model, theta1 + turn_by, theta2)
    turn = np.array([[np.cos(turn_by), -np.sin(turn_by)], [np.sin(turn_by), np.cos(turn_by)]])
    k_before, k_after = symmetric(*before[:, :3].T), symmetric(*after[:, :3].T)
    scale = before[:, 7].max()
    assert np.abs(turn @ k_before @ turn.T - k_after).max() <= 1e-12 * scale
    np.testing.assert_allclose(before[:, 6:8], after[:, 6:8], rtol=1e-11)


@pytest.mark.parametrize("seed", SEEDS)
def test_spatial_limb_in_its_own_plane(seed: int) -> None:
    """With joint 0 and coxa rigid the x-z part is the planar K and y stands apart; theta0 only turns it."""
    draw = np.random.default_rng(300 + seed)
    keys = {key: value for key, value in random_limb(draw, planar=False).items()
            if not (key.startswith("link.coxa") or key.startswith("joint.coxa"))}
    model = limb(keys)
    theta1, theta2 = postures(draw, 20)
    plane = planar_reference(model, theta1, theta2)
    space = spatial_reference(model, 0.0, theta1, theta2)
    scale = plane[:, 7].max()
    np.testing.assert_allclose(space[:, [0, 2, 5]], plane[:, :3], rtol=0, atol=1e-13 * scale)
    np.testing.assert_allclose(space[:, [1, 4]], 0, atol=1e-13 * scale)
    turned = spatial_reference(model, 0.8, theta1, theta2)
    np.testing.assert_allclose(turned[:, 12:15], space[:, 12:15], rtol=1e-11)


@pytest.mark.parametrize("seed", SEEDS)
def test_sideways_compliance_written_out(seed: int) -> None:
    """c_yy term by term, as a formula of its own; and the coxa's part in the plane."""
    draw = np.random.default_rng(400 + seed)
    keys = random_limb(draw, planar=False)
    model = limb(keys)
    without = limb({key: value for key, value in keys.items() if "coxa." not in key} | {
        "geometry.coxa_mm": keys["geometry.coxa_mm"]})
    for theta1, theta2 in zip(*postures(draw, 10)):
        g = geometry(model, theta1, theta2)
        p, lc, l1 = g["a"] + g["w"], keys["geometry.coxa_mm"], keys["geometry.femur_mm"]
        l2 = keys["geometry.tibia_mm"]
        kc, kf = keys["link.coxa.moment_transfer"], keys["link.femur.moment_transfer"]
        lat = {link: keys[f"link.{link}.lateral_mm_per_n"] for link in ("coxa", "femur", "tibia")}
        arm = l2 * np.cos(theta2)
        wanted = (keys["joint.coxa.compliance_rad_per_n_mm"] * (lc + p[0]) ** 2
                  + lat["coxa"] * (1 + 3 * kc * p[0] / lc + 3 * kc * (p[0] / lc) ** 2)
                  + keys["link.coxa.torsion_rad_per_n_mm"] * p[1] ** 2
                  + lat["femur"] * (1 + 3 * kf * arm / l1 + 3 * kf * (arm / l1) ** 2)
                  + keys["link.femur.torsion_rad_per_n_mm"] * (l2 * np.sin(theta2)) ** 2 + lat["tibia"])
        c = spatial_reference(model, 0.0, theta1, theta2)[0, 6:12]
        assert c[3] == pytest.approx(wanted, rel=1e-12)
        added = symmetric(*(c - spatial_reference(without, 0.0, theta1, theta2)[0, 6:12])[[0, 2, 5]])
        tilt, bending = keys["link.coxa.tilt_rad"], keys["link.coxa.bending_mm_per_n"]
        along, across = np.array([np.cos(tilt), np.sin(tilt)]), np.array([-np.sin(tilt), np.cos(tilt)])
        lever = quarter_turn(p)
        coupled = np.outer(across, lever)
        expected = (keys["link.coxa.axial_mm_per_n"] * np.outer(along, along)
                    + bending * np.outer(across, across) + 1.5 * bending * kc / lc * (coupled + coupled.T)
                    + 3 * bending * kc / lc**2 * np.outer(lever, lever))
        assert np.abs(added - expected).max() <= 1e-11 * np.abs(symmetric(*c[[0, 2, 5]])).max()


def test_spatial_k_turned_by_yaw() -> None:
    """K(theta0) = Rz K(0) Rz' over all entries, and its axis has unit length along the largest stretch."""
    draw = np.random.default_rng(9)
    model = limb(random_limb(draw, planar=False))
    index = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)]

    def full(entries: Any) -> Any:
        k = np.zeros((3, 3))
        for (i, j), value in zip(index, entries):
            k[i, j] = k[j, i] = value
        return k

    yaw = 0.9
    here, there = spatial_reference(model, 0.0, 0.4, 1.1)[0], spatial_reference(model, yaw, 0.4, 1.1)[0]
    turn = np.array([[np.cos(yaw), -np.sin(yaw), 0], [np.sin(yaw), np.cos(yaw), 0], [0, 0, 1]])
    np.testing.assert_allclose(turn @ full(here[:6]) @ turn.T, full(there[:6]), atol=1e-12 * here[14])
    np.testing.assert_allclose(full(there[:6]) @ there[15:], there[14] * there[15:], atol=1e-12 * there[14])
    assert there[15:] @ there[15:] == pytest.approx(1, abs=1e-14)


def test_postures_reach_their_tips() -> None:
    """Both knee branches of the inverse put the tip where it was asked to be; out of reach is refused."""
    model = limb({"geometry.femur_mm": 185.0, "geometry.tibia_mm": 313.5})
    draw = np.random.default_rng(5)
    angles, tip = np.full(2, np.nan), np.full(3, np.nan)
    zero = np.zeros(1)
    for knee_up in (0, 1):
        for r, phi in zip(draw.uniform(128.5001, 498.4999, 40), draw.uniform(-3, 3, 40)):
            check(lib.brace_reference_posture(model.c, r, phi, knee_up, doubles(angles)))
            assert (angles[1] >= 0) == bool(knee_up)
            check(lib.brace_reference_tip(model.c, 1, doubles(zero), doubles(angles[:1].copy()),
                                          doubles(angles[1:].copy()), doubles(tip)))
            np.testing.assert_allclose(tip, [57 + r * np.cos(phi), 0, r * np.sin(phi)], atol=1e-10)
    for r in (128.4, 498.6, -1.0, np.inf, np.nan):
        before = angles.copy()
        with pytest.raises(Refused):
            check(lib.brace_reference_posture(model.c, r, 0.0, 1, doubles(angles)))
        assert np.array_equal(before, angles)


def test_bad_input_is_refused_and_nothing_written() -> None:
    """Each refusal has its own status and leaves the output alone."""
    out, one, nan = np.full(9, 7.0), np.ones(1), np.full(1, np.nan)

    def status(model: Model, theta1: Any, theta2: Any) -> int:
        return int(lib.brace_reference_planar(model.c, 1, doubles(theta1), doubles(theta2), doubles(out)))

    assert status(limb(PAPER), nan, one) == lib.BRACE_HOST_E_NOT_FINITE
    assert status(limb(PAPER), one, nan) == lib.BRACE_HOST_E_NOT_FINITE
    assert status(Model(), one, one) == lib.BRACE_HOST_E_SINGULAR
    assert status(limb(PAPER | {"link.femur.bending_mm_per_n": -0.1}), one, one) == lib.BRACE_HOST_E_PARAMETER
    assert lib.brace_reference_planar(ffi.NULL, 1, doubles(one), doubles(one),
                                      doubles(out)) == lib.BRACE_HOST_E_NULL
    # one good row before a singular one: still nothing
    straight = limb({f"joint.{joint}.compliance_rad_per_n_mm": 1e-5 for joint in ("femur", "tibia")})
    two, rows = np.array([1.0, 0.0]), np.full(18, 7.0)
    assert lib.brace_reference_planar(straight.c, 2, doubles(two), doubles(two),
                                      doubles(rows)) == lib.BRACE_HOST_E_SINGULAR
    assert np.all(out == 7.0) and np.all(rows == 7.0)
