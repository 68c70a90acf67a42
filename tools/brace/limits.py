"""What the firmware takes at most. Nothing else, so that a command line knows it without loading numpy."""

FORCE_MOST_N = 1e4  # each component of the force on the tip: firmware/core/src/loaded/loaded.c
