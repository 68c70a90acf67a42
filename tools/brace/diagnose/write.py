"""What a diagnosis leaves behind: diagnosis.json, limb.toml, report.html; the same bytes for the same
input."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from brace import __version__
from brace.dataset import Dataset
from brace.diagnose import plain_words
from brace.diagnose.already import sentences
from brace.diagnose.diagnosis import Diagnosis, GapPair, Interval, NamedEffect
from brace.diagnose.export import export
from brace.diagnose.limb_change import in_words
from brace.diagnose.provenance import Provenance, provenance
from brace.diagnose.stiffness_change import stiffness_change
from brace.ground import files
from brace.ground.files import OutputSet, is_unchanged, marked, refuse_written
from brace.model import LimbModel

JSON, MODEL, REPORT = "diagnosis.json", "limb.toml", "report.html"
_DIGITS = 9
# By what a file of an earlier diagnosis is known, which the next may replace.
_OWN = {
    JSON: lambda data: data.startswith(b'{\n "format": 1,\n "verdict": "'),
    MODEL: is_unchanged,
    REPORT: lambda data: b'<meta name="generator" content="brace diagnose">' in data[:2000],
}


@dataclass(frozen=True)
class Written:
    """The three files' contents, and the JSON as a person's program gets it."""

    json_ready: Mapping[str, Any]
    files: Mapping[str, bytes]
    diagnosis: Diagnosis  # with the notes of the export


def contents(
    dataset: Dataset,
    believed: LimbModel | None,
    believed_text: str,
    found: Diagnosis,
    report: bool = True,
    processes: int = 1,
) -> Written:
    """The three files of a diagnosis; without the report two of them, in half the time. `processes` may draw it."""
    from brace.diagnose.report.page import page

    origin = provenance(dataset, believed_text)
    header = _header(found, origin)
    if believed is None:
        header.append("no model was given: only the tested joint is of the record; all else is an example limb's")
    exported = export(found, believed, believed_text, header)
    found = replace(
        found,
        model=exported.model,
        sentence=" ".join([found.sentence, *sentences(believed, found), *in_words(exported.model, found)]),
        notes=(*found.notes, *exported.notes),
        stiffness=None if believed is None else stiffness_change(dataset, believed, exported.model),
    )
    is_exported = believed is None or exported.model.values != believed.values
    data = as_json(found, origin, is_exported)
    files = {
        JSON: (json.dumps(data, indent=1, ensure_ascii=False) + "\n").encode(),
        MODEL: marked(exported.text).encode(),
    }
    if report:
        files[REPORT] = page(dataset, believed, found, origin, processes).encode()
    return Written(data, files, found)


def write(out: Path, written: Written, inputs: tuple[Path, ...] = ()) -> None:
    """OUT/ gets all of them or stays as it was."""
    with OutputSet(inputs) as outputs:
        for name, content in written.files.items():
            outputs.add(out / name, content)
        outputs.commit()


def check_folder(out: Path, inputs: tuple[Path, ...]) -> None:
    """Refuses a folder that cannot take the files, before any work is done."""
    files.check_folder(out, (JSON, MODEL, REPORT), inputs)
    for name, is_own in _OWN.items():
        refuse_written(out / name, is_own)


def as_json(found: Diagnosis, origin: Provenance, exported: bool) -> dict[str, Any]:
    """diagnosis.json. `exported`: limb.toml differs from what was given. Sizes carry the gap's unit in their names."""
    unit = found.gap.unit if found.gap else "n"
    left, after = found.unexplained, found.next_experiment
    data: dict[str, Any] = {
        "format": 1,
        "verdict": found.verdict,
        "exported": exported,
        "sentence": found.sentence,
        "effects": [_effect(effect) for effect in found.effects],
        "indistinguishable": [list(members) for members in found.indistinguishable],
        "could_be": list(found.could_be),
        "members": [
            {"take": one.label, "probability": one.probability, **asdict(one.k)} for one in found.members
        ],
        "localised": [
            {
                "where": spot.where,
                "p": spot.p,
                f"size_{unit}": spot.size,
                **({} if spot.share is None else {"share": spot.share}),
            }
            for spot in found.localised
        ],
        "unexplained": left
        and {f"rms_{unit}": left.rms, "structured": bool(left.structured), "description": left.description},
        "gap": found.gap
        and {
            "unit": unit,
            "noise_floor": found.gap.noise_floor,
            "before": _pair(found.gap.before),
            "after": _pair(found.gap.after),
            "steps": [
                {
                    "added": step.added,
                    **_pair(step.gap),
                    **({} if step.pull_sigma is None else {"pull_sigma": step.pull_sigma}),
                }
                for step in found.gap.steps
            ],
        },
        "held_out": [
            {
                "by": part.by,
                "which": part.words,
                f"off_{unit}": part.off,
                f"expected_{unit}": part.expected,
                "p": part.p,
                "holds": part.holds,
                f"largest_{unit}": part.largest,
            }
            for part in found.held_out
        ],
        "next_experiment": after
        and {
            "action": after.action,
            "separates": list(after.separates),
            "power": after.power,
            "minutes": after.minutes,
            "rig_toml": after.rig_toml,
        },
        "stiffness": found.stiffness
        and {"believed": asdict(found.stiffness.believed), "exported": asdict(found.stiffness.exported)},
        "joint": found.joint
        and {
            "parameters": _intervals(found.joint.parameters),
            "torque_n_mm": found.joint.torque_n_mm,
            "gear_positions": found.joint.gear_positions,
        },
        "data_faults": [fault.as_json() for fault in found.data_faults],
        "candidates": [
            {"label": tried.label, "gain": tried.gain, "posterior": tried.posterior}
            for tried in found.candidates
        ],
        "notes": [*found.cautions, *found.notes],
        "kind": origin.kind,
        "title": origin.title,
        "rows": origin.rows,
        "seed": found.seed,
        "versions": dict(origin.versions),
        "data_sha256": origin.data_sha256,
        "model_sha256": origin.model_sha256,
    }
    ready: dict[str, Any] = plain(data)
    return ready


def plain(value: Any) -> Any:
    """numpy to plain values, floats to nine digits (no last-bit noise in the bytes), what is not finite to
    null."""
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    if hasattr(value, "tolist"):
        return plain(value.tolist())
    if isinstance(value, float):
        return float(f"{value:.{_DIGITS}g}") + 0.0 if math.isfinite(value) else None
    return value


def _effect(effect: NamedEffect) -> dict[str, Any]:
    return {
        "name": effect.name,
        "where": effect.where,
        "confidence": effect.confidence,
        "parameters": _intervals(effect.parameters),
        "gap_share": effect.gap_share,
    }


def _intervals(held: Mapping[str, Interval]) -> dict[str, Any]:
    return {key: {"value": one.value, "low": one.low, "high": one.high} for key, one in held.items()}


def _pair(pair: GapPair) -> dict[str, Any]:
    return {"fitted": pair.fitted, "held_out": pair.held_out}


def _header(found: Diagnosis, origin: Provenance) -> list[str]:
    """Comments on top of limb.toml: what was added, from which data."""
    lines = [f"by brace diagnose {__version__}, verdict {found.verdict}, seed {found.seed}"]
    lines += [f"from {_one_line(origin.name)}, data sha256 {origin.data_sha256}"]
    if found.verdict in ("effect", "ambiguous"):
        for effect in found.effects:
            values = ", ".join(
                f"{key} {plain_words.interval(held)} {plain_words.key_unit(key)}".rstrip()
                for key, held in effect.parameters.items()
            )
            lines.append(f"{effect.label}, confidence {effect.confidence:.2f}: {values} (90 % intervals)")
    return lines


def _one_line(text: str) -> str:
    return " ".join(text.split())
