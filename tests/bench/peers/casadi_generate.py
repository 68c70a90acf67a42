"""Writes the limb's K as C by CasADi's code generator: casadi_generate.py OUT_DIRECTORY.

As a CasADi user would: the chain in symbols, K and its eigenvalues by CasADi's own functions, then
CodeGenerator with casadi_real = float. CasADi names the double functions (sin, sqrt, atan2) whatever the type;
the bench compiles the text as it is, and once more with float_functions.h ahead of it.
"""

import sys
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


def main() -> None:
    """Write casadi_planar.c and casadi_spatial.c."""
    directory = Path(sys.argv[1])
    for function in (planar(), spatial()):
        name = function.name()
        generator = ca.CodeGenerator(name + ".c", {"casadi_real": "float", "with_header": False})
        generator.add(function)
        (directory / f"{name}.c").write_text(generator.dump())


main()
