"""meta.toml: what kind of record this is and how it was taken. Unknown keys are kept."""

from __future__ import annotations

import math
import shlex
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from brace import toml
from brace.dataset.columns import KINDS
from brace.ground.errors import BadFileError, did_you_mean
from brace.toml import Key

WHAT = "dataset's meta.toml"
ZEROED = ("never", "per_run")
MOVED_BY = ("rig", "motors", "weights")
HELD = ("weightless", "at rest")
DISPLACEMENTS = ("finite", "small")

_KNOWN = (
    Key("format", None, "the version of the format, 1", "", 1, 1, kind="integer"),
    Key("kind", None, "the kind of record", kind="text", choices=tuple(KINDS)),
    Key("title", "", "a title", kind="text"),
    Key("zeroed", "never", "when the sensor was zeroed", kind="text", choices=ZEROED),
    Key("held", "weightless", "where the tip was when the rig took hold of it", kind="text", choices=HELD),
    Key("displacements", "", "whether the limb turned as it was displaced", kind="text", choices=DISPLACEMENTS),
    Key("joint", "femur", "the joint under test", kind="text", choices=("coxa", "femur", "tibia")),
    Key("sensor.resolution_n", 0.0, "the smallest step of the sensor", "N", 0.0, 1e6),
    Key(
        "sensor.range_n",
        math.inf,
        "the largest force that the sensor can read",
        "N",
        0.0,
        open_low=True,
        infinite=True,
    ),
    Key("rig.step_mm", 0.0, "the step of the imposed displacement", "mm", 0.0, 1e3),
    Key("rig.dwell_s", 0.0, "the wait before each reading", "s", 0.0, 1e6),
    Key("rig.zeroed", "never", "when the sensor was zeroed", kind="text", choices=ZEROED),
    Key(
        "rig.moved_by",
        "rig",
        "what moved the tip: a rig, the limb's own motors, hung weights",
        kind="text",
        choices=MOVED_BY,
    ),
)


@dataclass(frozen=True)
class Meta:
    """The known keys, typed, and the whole document."""

    values: Mapping[str, toml.Value]
    document: toml.Document

    @property
    def kind(self) -> str:
        return str(self.values["kind"])

    @property
    def title(self) -> str:
        return str(self.values["title"])

    @property
    def zeroed_per_run(self) -> bool:
        return "per_run" in (self.values["zeroed"], self.values["rig.zeroed"])

    @property
    def held_at_rest(self) -> bool:
        """Displacements count from where the limb hung under its weight, not from its weightless place."""
        return bool(self.values["held"] == "at rest")

    @property
    def displacements(self) -> str:
        """finite: of a limb that turned; small: of a simulation in which it does not; empty: the record does not say."""
        return str(self.values["displacements"])

    @property
    def moved_by_motors(self) -> bool:
        """Nothing held the tip sideways: the limb pressed by itself, its angles differing from row to row, or
        weights hung on it."""
        return bool(self.values["rig.moved_by"] in ("motors", "weights"))

    @property
    def joint(self) -> str:
        return str(self.values["joint"])

    @property
    def unit_as_printed(self) -> str:
        """The unit that a table's source prints, if the record says so; empty: N/mm."""
        source = self.document.content.get("source", {})
        unit = source.get("unit_as_printed", "") if isinstance(source, dict) else ""
        return unit if isinstance(unit, str) else ""

    def number(self, key: str) -> float:
        """`sensor.range_n` and the like."""
        return float(toml.number(self.values, key))


def _instead(named: Path) -> str:
    """What to try where a dataset's folder should stand."""
    beside = [entry.name for entry in named.parent.iterdir()][:1000] if named.parent.is_dir() else []
    near = did_you_mean(named.name, beside)
    if near and near != named.name:
        return f"did you mean {named.parent / near}?"
    if named.is_file() and "meta.toml" in beside:
        return f"name its folder: {named.parent}"
    if named.is_file() and named.suffix.lower() != ".toml":
        return f"brace import {shlex.quote(str(named))} --out DIR makes a dataset of a table"
    return "name the folder"


def read_meta(folder: Path) -> Meta:
    """Reads and checks FOLDER/meta.toml."""
    if not folder.is_dir():
        reason = "it is a file" if folder.exists() else "it does not exist"
        raise BadFileError(
            "no such dataset",
            where=str(folder),
            why=f"a dataset is a folder with meta.toml and data.csv; {reason}",
            next_step=_instead(folder),
        )
    if not (folder / "meta.toml").exists():
        only_csv = (folder / "data.csv").exists()
        raise BadFileError(
            "no meta.toml in this folder" if only_csv else "no dataset in this folder",
            where=str(folder),
            why="a dataset is a folder with meta.toml and data.csv; meta.toml says what kind of record data.csv is",
            next_step=(
                "add one: docs/datasets.md shows what it says; or "
                f"brace import {shlex.quote(str(folder / 'data.csv'))} --out DIR makes a dataset of it"
                if only_csv
                else "check the path"
            ),
        )
    document = toml.read(folder / "meta.toml", WHAT)
    _refuse_misspelt(document)
    values = toml.check(document, _KNOWN, WHAT, content=_known_part(document.content))
    _check_zeroed_once(document)
    return Meta(values, document)


def _refuse_misspelt(document: toml.Document) -> None:
    """A key, in a table that has keys of ours or at the top, that is nearly one of them and is not there by its right
    name. Others are kept."""
    names = {key.name for key in _KNOWN}
    given = dict(_dotted(document.content))
    for name in given:
        table, _, leaf = name.rpartition(".")
        siblings = {key.rpartition(".")[2]: key for key in names if key.rpartition(".")[0] == table}
        if name in names or not siblings:
            continue
        near = did_you_mean(leaf, [other for other, key in siblings.items() if key not in given], likeness=0.75)
        beside = [other for other in siblings if other.startswith(f"{leaf}_") and siblings[other] not in given]
        if near or len(beside) == 1:
            raise BadFileError(
                f"{name} is no key of ours, and nearly one",
                where=document.where(name),
                why="a misspelt key would silently do nothing",
                next_step=f"did you mean {siblings[near or beside[0]]}? Any other name is kept as a remark",
            )


def _dotted(content: Mapping[str, object]) -> Iterator[tuple[str, object]]:
    for name, value in content.items():
        if isinstance(value, Mapping):
            yield from ((f"{name}.{leaf}", item) for leaf, item in value.items())
        else:
            yield name, value


def _check_zeroed_once(document: toml.Document) -> None:
    """`zeroed` may stand at the top or under [rig]; the two places must not disagree."""
    rig = document.content.get("rig", {})
    if not isinstance(rig, dict):
        return
    if "zeroed" in document.content and "zeroed" in rig and document.content["zeroed"] != rig["zeroed"]:
        raise BadFileError(
            f"zeroed is {document.content['zeroed']!r} at the top and {rig['zeroed']!r} under [rig]",
            where=document.where("rig.zeroed"),
            why="whether each run's first reading was taken off decides what a bias and a gap look like",
            next_step="keep one of the two",
        )


def _known_part(content: Mapping[str, object]) -> dict[str, object]:
    """The document without keys and tables that are merely kept."""
    names = {key.name for key in _KNOWN}
    tables = {name.partition(".")[0] for name in names if "." in name}
    kept: dict[str, object] = {}
    for name, value in content.items():
        if name in tables and isinstance(value, Mapping):
            kept[name] = {leaf: item for leaf, item in value.items() if f"{name}.{leaf}" in names}
        elif name in names or name in tables:
            kept[name] = value
    return kept
