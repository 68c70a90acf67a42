"""K of a limb, and what follows from it, by the firmware's own C: at rest, under a load, in space, with open play."""
