"""Brace: stiffness at the tip of a climbing robot's limb. Units: mm, N, N mm, rad, s, degC."""

__version__ = "0.1.0"
