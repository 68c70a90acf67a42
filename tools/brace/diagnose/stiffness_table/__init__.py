"""A diagnosis of a table of stiffness matrices: what is wrong with it and which kinds of limb fit it. A table names
almost nothing.

Each step has a file: alternatives (kinds of limb beside the believed one, judged on rows left out), localise, workflow
(all in order)."""

from brace.diagnose.stiffness_table.workflow import diagnose_table

__all__ = ["diagnose_table"]
