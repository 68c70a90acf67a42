"""The simulated rig: how it loads a limb, a test on it, and the rows of a record played again."""
