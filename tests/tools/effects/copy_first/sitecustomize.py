"""Python reads this at its start where this folder is in PYTHONPATH: a copy of the project is looked at before the project
that the environment has installed, whose finder would come first."""

import sys

sys.meta_path[:] = [finder for finder in sys.meta_path if "editable" not in type(finder).__module__]
