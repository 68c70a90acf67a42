"""Writes the limb's K as C by CasADi's code generator: casadi_generate.py OUT_DIRECTORY.

As a CasADi user would: the chain in symbols, K and its eigenvalues by CasADi's own functions, then
CodeGenerator with casadi_real = float. CasADi names the double functions (sin, sqrt, atan2) whatever the type;
the bench compiles the text as it is, and once more with float_functions.h ahead of it.
"""

import sys
from collections.abc import Callable
from pathlib import Path

import casadi as ca  # type: ignore[import-not-found]


def along(angle: ca.SX) -> ca.SX:
    """Unit vector of a link in the plane."""
    return ca.vertcat(ca.cos(angle), ca.sin(angle))


def turned(v: ca.SX) -> ca.SX:
    """A plane vector turned by 90 degrees: direction across a link, lever of a joint."""
    return ca.vertcat(-v[1], v[0])


def outer(v: ca.SX) -> ca.SX:
    """v v'."""
    return v @ v.T


def beam(axial: ca.SX, bending: ca.SX, transfer: ca.SX, length: ca.SX, u: ca.SX, arm: ca.SX) -> ca.SX:
    """Compliance (2, 2) of a link along u whose far end carries the tip force with lever arm [mm]."""
    n, lever = turned(u), turned(arm)
    coupling = 1.5 * bending * transfer / length * (n @ lever.T)
    return (axial * outer(u) + bending * outer(n) + coupling + coupling.T
            + 3 * bending * transfer / length**2 * outer(lever))


def planar() -> ca.Function:
    """(theta1, theta2, parameters[9]) -> K_xx, K_xz, K_zz, lambda_min, lambda_max, stiff axis."""
    theta1, theta2 = ca.SX.sym("theta1"), ca.SX.sym("theta2")
    p = ca.SX.sym("p", 9)
    l1, l2, axial1, bending1, transfer, axial2, bending2, joint1, joint2 = ca.vertsplit(p)
    u1, u2 = along(theta1), along(theta1 - theta2)
    shank = l2 * u2
    c = (beam(axial1, bending1, transfer, l1, u1, shank) + axial2 * outer(u2) + bending2 * outer(turned(u2))
         + joint1 * outer(turned(l1 * u1 + shank)) + joint2 * outer(turned(shank)))
    k = ca.inv(c)
    mean, half = (k[0, 0] + k[1, 1]) / 2, (k[0, 0] - k[1, 1]) / 2
    radius = ca.sqrt(half**2 + k[0, 1] ** 2)
    axis = ca.atan2(k[0, 1], half) / 2
    return ca.Function("casadi_planar", [theta1, theta2, p],
                       [ca.vertcat(k[0, 0], k[0, 1], k[1, 1], mean - radius, mean + radius, axis)])


def spatial() -> ca.Function:
    """(theta0, theta1, theta2, parameters[20]) -> K (6), eigenvalues ascending (3), stiff axis (3)."""
    theta0, theta1, theta2 = (ca.SX.sym(f"theta{i}") for i in range(3))
    p = ca.SX.sym("p", 20)
    names = ca.vertsplit(p)
    coxa, femur, tibia, joint = names[0:6], names[6:12], names[12:17], names[17:20]
    ahead = along(ca.SX(0))
    u1, u2 = along(theta1), along(theta1 - theta2)
    shank = tibia[0] * u2
    tip = femur[0] * u1 + shank
    plane = (beam(coxa[1], coxa[2], coxa[5], coxa[0], ahead, tip)
             + beam(femur[1], femur[2], femur[5], femur[0], u1, shank)
             + tibia[1] * outer(u2) + tibia[2] * outer(turned(u2))
             + joint[1] * outer(turned(tip)) + joint[2] * outer(turned(shank)))

    def lateral(link: list[ca.SX], reach: ca.SX) -> ca.SX:
        return link[3] * (1 + 3 * link[5] * reach / link[0] + 3 * link[5] * reach**2 / link[0] ** 2)

    along_femur, across_femur = ca.dot(shank, u1), ca.dot(shank, turned(u1))
    c_yy = (joint[0] * (coxa[0] + tip[0]) ** 2 + lateral(coxa, tip[0]) + coxa[4] * tip[1] ** 2
            + lateral(femur, along_femur) + femur[4] * across_femur**2 + tibia[3])

    c = ca.SX(3, 3)
    c[0, 0], c[0, 2], c[2, 0], c[2, 2], c[1, 1] = plane[0, 0], plane[0, 1], plane[1, 0], plane[1, 1], c_yy
    turn = ca.SX(3, 3)
    turn[0, 0] = turn[1, 1] = ca.cos(theta0)
    turn[1, 0], turn[0, 1], turn[2, 2] = ca.sin(theta0), -ca.sin(theta0), 1
    k = turn @ ca.inv(c) @ turn.T
    low, middle, high = eigenvalues(k)
    return ca.Function("casadi_spatial", [theta0, theta1, theta2, p],
                       [ca.vertcat(k[0, 0], k[0, 1], k[0, 2], k[1, 1], k[1, 2], k[2, 2], low, middle, high,
                                   eigenvector(k, high))])


def eigenvalues(k: ca.SX) -> tuple[ca.SX, ca.SX, ca.SX]:
    """Of a symmetric (3, 3), ascending, by the trigonometric solution (CasADi's eig_symbolic needs a triangle)."""
    q = ca.trace(k) / 3
    b = k - q * ca.SX.eye(3)
    radius = ca.sqrt(ca.sumsqr(b) / 6)
    angle = ca.acos(ca.fmin(1, ca.fmax(-1, ca.det(b / radius) / 2))) / 3
    high = q + 2 * radius * ca.cos(angle)
    low = q + 2 * radius * ca.cos(angle + 2 * ca.pi / 3)
    return low, 3 * q - low - high, high


def eigenvector(k: ca.SX, value: ca.SX) -> ca.SX:
    """Unit eigenvector (3,): the longest of the three cross products of rows of k - value I."""
    a = k - value * ca.SX.eye(3)
    rows = [a[i, :].T for i in range(3)]
    best = ca.cross(rows[0], rows[1])
    for i, j in ((0, 2), (1, 2)):
        other = ca.cross(rows[i], rows[j])
        best = ca.if_else(ca.sumsqr(other) > ca.sumsqr(best), other, best)
    return best / ca.sqrt(ca.sumsqr(best))


GAUSS = ((0.5 - 0.15**0.5, 5 / 18), (0.5, 4 / 9), (0.5 + 0.15**0.5, 5 / 18))  # places along a beam, and their shares
GAUSS_TWO = (0.5 - 1 / 12**0.5, 0.5 + 1 / 12**0.5)


def loaded() -> ca.Function:
    """(theta1, theta2, force[2], parameters[18]) -> K (3), eigenvalues, stiff axis, tip displacement (2), buckling
    factor: K at the rest of the limb of docs/physics.md under a force and its weight, after two steps of Newton's method
    on the energy from the straight limb. Coordinates of a link: turn of its root, its curvature at two Gauss points,
    linear between. Springs that turn nothing are eliminated by hand, which saves ten unknowns: they take -1/2 F' C F.
    The buckling factor by three halvings of 1 to 16 and a parabola, as ours."""
    theta1, theta2 = ca.SX.sym("theta1"), ca.SX.sym("theta2")
    force, p, q, times = ca.SX.sym("force", 2), ca.SX.sym("p", 18), ca.SX.sym("q", 6), ca.SX.sym("times")
    links, joints, base, weights = (ca.vertsplit(p[i:j]) for i, j in ((0, 10), (10, 12), (12, 15), (15, 18)))
    down = times * ca.vertcat(0, -1)
    at_tip = times * force
    at_knee = at_tip + (weights[1] + weights[2]) * down
    angle = (theta1, theta1 - theta2)
    end1, given1, springs1 = bent_link(angle[0], q[:3], links[:5], at_knee, weights[0] * down)
    end2, given2, springs2 = bent_link(angle[1], q[3:], links[5:], at_tip, weights[2] * down)
    bend = [1.5 * link[3] * link[2] / link[0] ** 2 for link in (links[:5], links[5:])]
    energy = (q[0] ** 2 / (joints[0] + base[2]) + (q[3] - q[0] - q[1] - q[2]) ** 2 / joints[1]
              + (q[1] ** 2 + q[2] ** 2) / bend[0] + (q[4] ** 2 + q[5] ** 2) / bend[1]) / 2 - given1 - given2
    curvature, slope = ca.hessian(energy, q)
    at = [theta1, theta2, force, p, times]
    newton = ca.Function("newton", [q, *at], [curvature, slope])
    tip = ca.Function("tip", [q, *at], [end1 + end2, ca.jacobian(end1 + end2, q), springs1 + springs2])
    given = [theta1, theta2, force, p]
    rest = ca.SX.zeros(6)
    for _ in range(2):
        h, g = newton(rest, *given, 1)
        rest = rest - solved(h, g)
    h, _ = newton(rest, *given, 1)
    place, levers, springs = tip(rest, *given, 1)
    c = levers @ solved(h, levers.T) + springs + ca.diag(ca.vertcat(base[0], base[1]))
    k = ca.inv(c)
    mean, half = (k[0, 0] + k[1, 1]) / 2, (k[0, 0] - k[1, 1]) / 2
    radius = ca.sqrt(half**2 + k[0, 1] ** 2)
    axis = ca.atan2(k[0, 1], half) / 2
    on_base = force + (weights[0] + weights[1] + weights[2]) * ca.vertcat(0, -1)
    moved = (place - links[0] * along(angle[0]) - links[5] * along(angle[1])
             + ca.vertcat(base[0] * on_base[0], base[1] * on_base[1]))

    def pivots(factor: ca.SX) -> ca.SX:
        """Of the matrix under a multiple of the load, each over the spring's own stiffness."""
        stiff, _ = newton(rest, *given, factor)
        unloaded, _ = newton(rest, *given, 0)
        return ca.ldl(stiff)[0] / ca.ldl(unloaded)[0]

    result = ca.vertcat(k[0, 0], k[0, 1], k[1, 1], mean - radius, mean + radius, axis, moved, buckling(pivots))
    return ca.Function("casadi_loaded", given, ca.cse([result]))


def bent_link(angle: ca.SX, q: ca.SX, link: list[ca.SX], beyond: ca.SX, own: ca.SX) -> tuple[ca.SX, ca.SX, ca.SX]:
    """Where its end is, the energy that its loads have given off, and what its springs add to C. link: length, axial,
    bending, strength of the moment transfer, tilt; beyond: force that its end carries; own: its weight."""
    length, axial, bending, strength, tilt = link

    def turn_at(place: float) -> ca.SX:
        """Turn since the root: the integral of the curvature at the two points, each times half the length."""
        low, high = GAUSS_TWO
        a, b = ((place**2 / 2 - other * place) / (this - other) for this, other in ((low, high), (high, low)))
        return 2 * (a * q[1] + b * q[2])

    whole = beyond + own
    end = length * (along(angle + q[0]) - along(angle + tilt + q[0]))
    given = ca.dot(end, beyond + own / 2)
    for place, share in GAUSS:
        part = share * length * along(angle + tilt + q[0] + turn_at(place))
        end += part
        given += ca.dot(part, beyond + own * (1 - place))
    springs = ca.SX.zeros(2, 2)
    axis_end = along(angle + tilt + q[0] + q[1] + q[2])
    for yields, axis, carried in ((strength * axial, along(angle + tilt + q[0]), whole),
                                  ((1 - strength) * axial, axis_end, beyond),
                                  ((1 - strength) * bending, turned(axis_end), beyond)):
        end += yields * ca.dot(axis, carried) * axis
        given += yields * ca.dot(axis, carried) ** 2 / 2
        springs += yields * outer(axis)
    return end, given, springs


def buckling(pivots: Callable[[ca.SX], ca.SX]) -> ca.SX:
    """Where the first pivot is zero; infinity above 11."""
    low, high, before = ca.SX(1), ca.SX(16), ca.SX(0)
    at_low, at_high, at_before = product(pivots(low)), ca.SX(0), ca.SX(1)
    for ratio in (4.0, 2.0, 2.0**0.5):
        middle = low * ratio
        now = pivots(middle)
        stable, value = ca.mmin(now) > 0, product(now)
        before, at_before = ca.if_else(stable, low, before), ca.if_else(stable, at_low, at_before)
        low, at_low = ca.if_else(stable, middle, low), ca.if_else(stable, value, at_low)
        high, at_high = ca.if_else(stable, high, middle), ca.if_else(stable, at_high, value)
    chord = (at_high - at_low) / (high - low)
    root = low - at_low / chord
    bend = ((at_before - at_low) / (before - low) - chord) / (before - high)
    slope = chord + bend * ((root - low) + (root - high))
    return ca.if_else(at_high < 0, root - bend * (root - low) * (root - high) / slope, ca.inf)


def product(values: ca.SX) -> ca.SX:
    """Of all entries."""
    whole = ca.SX(1)
    for value in ca.vertsplit(values):
        whole = whole * value
    return whole


def solved(h: ca.SX, right: ca.SX) -> ca.SX:
    """h^-1 right for a symmetric matrix, by CasADi's L D L'."""
    d, l_transposed, order = ca.ldl(h)
    return ca.ldl_solve(right, d, l_transposed, order)


def main() -> None:
    """Write casadi_planar.c, casadi_spatial.c and casadi_loaded.c."""
    directory = Path(sys.argv[1])
    for function in (planar(), spatial(), loaded()):
        name = function.name()
        generator = ca.CodeGenerator(name + ".c", {"casadi_real": "float", "with_header": False})
        generator.add(function)
        (directory / f"{name}.c").write_text(generator.dump())


main()
