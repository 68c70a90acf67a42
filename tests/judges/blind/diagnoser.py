"""The tool under test, called as `brace diagnose` and `brace predict` call it. The only module here that imports it."""

from __future__ import annotations

import hashlib
import json
import signal
import time
import traceback
from pathlib import Path
from types import FrameType
from typing import Any

import numpy as np
from plant import BUILD, Array

PATIENCE_S = 180  # of processor time: a busy machine makes no diagnosis slow
PROJECT = BUILD.parents[1]


def version() -> str:
    """Hash of the tool's sources: results of another tool are not this tool's."""
    digest = hashlib.sha256()
    for path in sorted((PROJECT / "tools" / "brace").rglob("*.py")) + sorted(
        path for folder in ("host_sim", "firmware/core") for path in (PROJECT / folder).rglob("*.[ch]*")
    ):
        digest.update(str(path.relative_to(PROJECT)).encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:12]


def require() -> None:
    """Raises the tool's own error when it cannot run at all: rather at once than for every case."""
    from brace.native import library

    library()


class TooSlowError(Exception):
    """No diagnosis in time."""


def _alarm(_signal: int, _frame: FrameType | None) -> None:
    raise TooSlowError(f"no diagnosis after {PATIENCE_S} s of processor time")


def diagnose(case: Path, out: Path, seed: int = 0, report: bool = True) -> dict[str, Any]:
    """Diagnoses one folder into `out`: the tool's files, its report where wanted (it takes as long as the rest), and
    run.json. Errors are noted, not raised."""
    from brace.diagnose.one import diagnosed, load
    from brace.diagnose.options import Options
    from brace.diagnose.write import write
    from brace.ground.errors import BraceError

    out.mkdir(parents=True, exist_ok=True)
    note: dict[str, Any] = {"report": report}
    signal.signal(signal.SIGPROF, _alarm)
    signal.setitimer(signal.ITIMER_PROF, PATIENCE_S)
    begun, busy = time.perf_counter(), time.process_time()
    try:
        given = load(case, None)  # its limb.toml; of a joint test, perhaps none
        _, written = diagnosed(given, Options(seed=seed), report=report)
        write(out, written)
    except BraceError as error:
        note["refused"] = str(error)
    except TooSlowError as error:
        note["crashed"] = str(error)
    except Exception:  # whatever else comes is a fault of the tool, to be counted
        note["crashed"] = traceback.format_exc(limit=-3)
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
    note["seconds"] = time.perf_counter() - begun
    note["cpu_seconds"] = time.process_time() - busy
    (out / "run.json").write_text(json.dumps(note))
    return note


def k_under_load(limb: Path, theta: Array, force_n: Array) -> Array:
    """`brace k --fx --fz`: K (count x 2 x 2) at commanded angles under forces on the tip; NaN where it is refused."""
    from brace.model import load_limb
    from brace.stiffness.under_load import LoadedLimb

    model = load_limb(limb)
    offsets = [model.number(f"joint.{joint}.zero_offset_rad") for joint in ("femur", "tibia")]
    k = LoadedLimb(model).stiffness(*(theta + offsets).T, *force_n.T)
    names = ("k_xx_n_per_mm", "k_xz_n_per_mm", "k_xz_n_per_mm", "k_zz_n_per_mm")
    return np.stack([k[name].astype(float) for name in names], axis=-1).reshape(-1, 2, 2)


def predict(dataset: Path, limb: Path, out: Path) -> None:
    """`brace predict`: forces of a limb for a dataset's rows, as CSV."""
    from brace.dataset import load_dataset
    from brace.model import load_limb
    from brace.rig.predict import predict as played

    columns = played(load_dataset(dataset), load_limb(limb)).columns
    lines = ["fx_n,fz_n"] + [f"{x:.6f},{z:.6f}" for x, z in zip(columns["fx_n"], columns["fz_n"], strict=True)]
    out.write_text("\n".join(lines) + "\n")
