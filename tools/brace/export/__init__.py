"""A limb for the simulators that people have: a MuJoCo model with its compliances, a URDF of its lengths and travel."""
