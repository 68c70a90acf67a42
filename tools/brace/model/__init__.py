"""The limb model: limb.toml in, limb.toml out, and a flat map of dotted keys in between."""

from brace.model.limb import LimbModel, load_limb
from brace.model.keys import LIMB_KEYS

__all__ = ["LIMB_KEYS", "LimbModel", "load_limb"]
