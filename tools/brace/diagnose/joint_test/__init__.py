"""One joint's torque and angle: which effects the joint has, how large, and what stays unexplained.

The steps, a file each: intake, hold_out, record (readings, noise), terms (hypotheses), fit, choose (forward,
swap, drop), evidence (gains, bootstrap, intervals), localise, dead_zone (is a gap really one), words,
workflow (all in order).
"""

from brace.diagnose.joint_test.workflow import diagnose_joint_test

__all__ = ["diagnose_joint_test"]
