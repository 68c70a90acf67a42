"""Where the two other worlds and the tool's judge are."""

import os
import sys
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before numpy is there: its threads would wait for one another
sys.path += [str(Path(__file__).resolve().parents[1] / name) for name in ("blind", "engine")]
