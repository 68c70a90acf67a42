"""One record from its folder to the contents of its three files; what the command, the fleet and tests share."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

from brace.dataset import Dataset, load_dataset
from brace.diagnose.diagnosis import Diagnosis
from brace.diagnose.options import Advance, Options, silent
from brace.diagnose.run import diagnose
from brace.diagnose.write import Written, contents
from brace.ground.errors import UsageError
from brace.ground.files import TOML_LIMIT_BYTES, read_text
from brace.model import LimbModel, load_limb
from brace.model.limb import WHAT


NEW_OBJECTS = 100_000  # before Python looks for cycles again; its default is 700


@dataclass(frozen=True)
class Given:
    """A record, the model believed of it (None: none), and that model's text."""

    dataset: Dataset
    believed: LimbModel | None
    believed_text: str


def model_of(folder: Path, model: Path | None) -> Path | None:
    """The model that is believed: the one given, or the limb.toml that lies in the dataset's folder, or none."""
    if model is not None:
        return model
    own = folder / "limb.toml"
    return own if own.is_file() else None


def load(folder: Path, model: Path | None) -> Given:
    """Reads both. Only a joint test can do without a model."""
    path = model_of(folder, model)
    believed = load_limb(path) if path is not None else None
    text = read_text(path, TOML_LIMIT_BYTES, WHAT) if path is not None else ""
    dataset = load_dataset(folder, keep_unreadable=True)  # reported as faults, not refused
    if believed is None and dataset.kind != "joint_test":
        raise UsageError(
            "no model",
            where=str(folder),
            why=f"a {dataset.kind.replace('_', ' ')} record is compared with a limb; only a joint test can start from "
            "a spring alone",
            next_step="--model limb.toml, or a limb.toml in the dataset's folder",
        )
    return Given(dataset, believed, text)


def diagnosed(
    given: Given, options: Options, advance: Advance = silent, report: bool = True
) -> tuple[Diagnosis, Written]:
    """The diagnosis, and what it leaves behind; `report` as for `contents`."""

    def load_figures() -> None:
        from brace.plots.figure import load

        load()

    with _cycles_sought_rarely():
        asked = replace(options, meanwhile=load_figures) if report else options
        found = diagnose(given.dataset, given.believed, asked, advance)
        written = contents(given.dataset, given.believed, given.believed_text, found, report, options.processes)
    return written.diagnosis, written


@contextmanager
def _cycles_sought_rarely() -> Iterator[None]:
    """A diagnosis and its pictures make hundreds of thousands of small objects, hardly any of them in cycles: looking
    for cycles after every 700 of them takes a tenth of the time."""
    before = gc.get_threshold()
    gc.set_threshold(max(before[0], NEW_OBJECTS) if before[0] else 0, *before[1:])
    try:
        yield
    finally:
        gc.set_threshold(*before)
