"""The controller's parameter block: a limb.toml as the firmware holds it, and back."""

from brace.params.block import Block, pack, read_block, read_either
from brace.params.difference import Difference, differences

__all__ = ["Block", "Difference", "differences", "pack", "read_block", "read_either"]
