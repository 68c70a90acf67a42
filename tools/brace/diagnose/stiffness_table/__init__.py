"""A table of stiffness matrices: what is wrong with it, which kinds of limb fit, and that it names almost
nothing.

The steps, a file each: alternatives (kinds of limb beside the believed one, judged on rows left out),
localise, workflow (all in order).
"""

from brace.diagnose.stiffness_table.workflow import diagnose_table

__all__ = ["diagnose_table"]
