"""A controller on a bus, as the robot's computer reaches it."""
