"""The firmware's own C and the simulated limb, through cffi: the K of a tool is the K of the limb."""

from brace.native.loader import Library, library, node_library, servos_library

__all__ = ["Library", "library", "node_library", "servos_library"]
