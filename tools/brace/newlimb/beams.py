"""A link as a uniform cantilever: its compliances at the far end, from its cross-section and material.

Formulas: Gere and Goodno, Mechanics of Materials, appendix H (cantilever, load at its end) and chapter 3 (torsion):
axial L/(E A), bending and lateral L^3/(3 E I), torsion L/(G J); for a round tube A = pi (D^2 - d^2)/4,
I = pi (D^4 - d^4)/64, J = 2 I."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Material:
    """Moduli in GPa, and how far they may be off, as one sigma relative to them."""

    name: str
    e_gpa: float
    g_gpa: float
    sigma_rel: float


# Handbook values; a fibre's tube depends on its lay-up, a printed part on its filling.
MATERIALS = {
    material.name: material
    for material in (
        Material("steel", 200.0, 77.0, 0.05),
        Material("stainless", 193.0, 75.0, 0.05),
        Material("aluminium", 69.0, 26.0, 0.05),
        Material("titanium", 110.0, 42.0, 0.05),
        Material("brass", 100.0, 37.0, 0.08),
        Material("cfrp", 100.0, 5.0, 0.30),
        Material("gfrp", 30.0, 4.0, 0.30),
        Material("pla", 3.0, 1.1, 0.25),
        Material("petg", 2.0, 0.7, 0.25),
        Material("abs", 2.1, 0.75, 0.25),
        Material("nylon", 1.6, 0.6, 0.35),
        Material("pom", 2.8, 1.0, 0.15),
        Material("wood", 11.0, 0.7, 0.25),
    )
}
ALIASES = {"aluminum": "aluminium", "alu": "aluminium", "al": "aluminium", "carbon": "cfrp", "cfk": "cfrp",
           "gfk": "gfrp",
           "stahl": "steel", "carbon-fibre": "cfrp", "carbon-fiber": "cfrp", "ti": "titanium", "delrin": "pom",
           "pa12": "nylon", "pa": "nylon"}  # fmt: skip
POISSON = 0.3  # where only E is said: G = E/(2 (1 + nu))


@dataclass(frozen=True)
class Compliances:
    """Of a link at its far end."""

    axial_mm_per_n: float
    bending_mm_per_n: float
    lateral_mm_per_n: float
    torsion_rad_per_n_mm: float


def of_modulus(e_gpa: float) -> Material:
    """A material that is known by its modulus alone."""
    return Material(f"{e_gpa:g} GPa", e_gpa, e_gpa / (2.0 * (1.0 + POISSON)), 0.05)


def round_beam(length_mm: float, outer_mm: float, inner_mm: float, material: Material) -> Compliances:
    """A tube, or a rod where the inner diameter is 0."""
    e, g = material.e_gpa * 1e3, material.g_gpa * 1e3  # N/mm^2
    area = math.pi * (outer_mm**2 - inner_mm**2) / 4.0
    second = math.pi * (outer_mm**4 - inner_mm**4) / 64.0
    bending = length_mm**3 / (3.0 * e * second)
    return Compliances(length_mm / (e * area), bending, bending, length_mm / (g * 2.0 * second))
