"""The foreign benchmark's sets: which cases, and how they are written and sealed."""

from __future__ import annotations

import hashlib
import json
import shutil
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import instruments
import joints
import numpy as np
import ringing
from actuator import write
from diagnoser import PROJECT as PROJECT
from files import limb_text, meta_text, write_dataset
from generate import PARTS, SEAL, listing
from generate import seal_of as seal_of
from plans import Plan
from words import FRICTION

HERE = Path(__file__).resolve().parent
# Effects that are hidden beside a trouble, by their number in tests/judges/blind/effects.py: both springs, the base, a link,
# play twice, friction, hardening, gravity, a joint's zero.
HIDDEN = (0, 1, 3, 5, 8, 9, 11, 13, 16, 18)
BUILD = PROJECT / "build" / "foreign"


@dataclass(frozen=True)
class Case:
    """One case: `group` and `kind` say what it is, `number` the how manieth of its kind."""

    seed: int
    group: str
    kind: str
    number: int

    @property
    def name(self) -> str:
        """An identity that says nothing, and stays when a plan grows."""
        text = f"{self.seed}/{self.group}/{self.kind}/{self.number}"
        return "f" + hashlib.sha256(text.encode()).hexdigest()[:7]

    @property
    def part(self) -> str:
        """joint, loading or ringing."""
        if self.group == "ringing":
            return "ringing"
        return "loading" if self.group in ("sound", "troubled", "beside") else "joint"

    @property
    def seeds(self) -> list[int]:
        """Of its own random numbers."""
        return [self.seed, int(hashlib.sha256(f"{self.group}/{self.kind}".encode()).hexdigest()[:8], 16), self.number]

    def write(self, out: Path) -> None:
        """cases/NAME as a tool may see it, answers/NAME/truth.json."""
        makers = {"joint": self._joint, "loading": self._loading, "ringing": self._ringing}
        truth = makers[self.part](out)
        truth = {
            "id": self.name,
            "group": self.group,
            "kind": self.kind,
            "number": self.number,
            "seed": self.seed,
            **truth,
        }
        answer = out / "answers" / self.name
        answer.mkdir(parents=True, exist_ok=True)
        (answer / "truth.json").write_text(json.dumps(truth, indent=1, default=float) + "\n")

    def _joint(self, out: Path) -> dict[str, Any]:
        makers = {"named": joints.NAMED, "misread": joints.TROUBLED, "outside": joints.OUTSIDE,
                  "evidence": joints.EVIDENCE, "positions": joints.POSITIONS}[self.group]  # fmt: skip
        made = makers[self.kind](np.random.default_rng(self.seeds))
        write(out / "cases" / self.name, f"case {self.name}", made.record)
        angle = made.record.columns["angle_rad"]
        test = made.record.columns["test"]
        swing = max(float(np.ptp(angle[test == t])) for t in np.unique(test))
        effects = [{"name": n, "where": joints.PLACE.get(n, joints.WHERE)} for n in made.effects]
        return {"part": self.part, "effects": effects, "cls": [],
                "outside": made.outside, "trouble": made.trouble, "evidence": made.evidence, "size": made.size,
                "left_out": made.left_out, "swing_rad": swing, "about": made.about}  # fmt: skip

    def _ringing(self, out: Path) -> dict[str, Any]:
        made = (ringing.sound if self.kind == "wandering" else ringing.single)(self.seed, self.number)
        ringing.write(made, out / "cases" / self.name)
        name, _, where = made.truth["effect"].partition("@")
        alike = list(made.truth["alike"])
        if name in FRICTION:
            alike += [f"{one}@{where}" for one in FRICTION]
        about = {key: made.truth[key] for key in ("s", "size", "law", "bristle_rad") if key in made.truth}
        effects = [{"name": name, "where": where}] if name else []
        return {"part": self.part, "effects": effects, "cls": sorted(set(alike)), "trouble": "", "outside": "",
                "evidence": "", "about": about}  # fmt: skip

    def _loading(self, out: Path) -> dict[str, Any]:
        trouble = "" if self.kind == "sound" else self.kind
        turn = list(instruments.TROUBLES).index(trouble) if trouble else 0
        hidden = HIDDEN[(3 * turn + self.number) % len(HIDDEN)] if self.group == "beside" else None
        made = instruments.drawn(self.seeds, trouble, hidden)
        folder = out / "cases" / self.name
        write_dataset(folder, meta_text(made.design, f"case {self.name}"), made.table)
        case = made.case
        text = limb_text(case["believed"], case["trust"], f"case {self.name}", case["left_out"])
        (folder / "limb.toml").write_text(text)
        return {"part": self.part, **made.truth, "outside": "", "evidence": "", "rows": len(made.table["run"])} | {
            "kind": self.kind
        }


def cases(seed: int, plan: Plan) -> list[Case]:
    """Those of a plan, in the order of their names: random, and always the same."""
    wanted: list[tuple[str, str, int]] = [
        *(("named", kind, plan.joint) for kind in joints.NAMED),
        *(("misread", kind, plan.joint) for kind in joints.TROUBLED),
        *(("outside", kind, plan.joint) for kind in joints.OUTSIDE),
        *(("evidence", kind, plan.evidence) for kind in joints.EVIDENCE),
        *(("positions", kind, plan.positions) for kind in joints.POSITIONS),
        ("sound", "sound", plan.sound),
        *(("troubled", kind, plan.troubled) for kind in instruments.TROUBLES),
        *(("beside", kind, plan.beside) for kind in instruments.TROUBLES),
        ("ringing", "single", plan.ringing),
        ("ringing", "wandering", plan.wandering),
    ]
    found = [Case(seed, group, kind, n) for group, kind, count in wanted for n in range(count)]
    return sorted(found, key=lambda case: case.name)


def sources_hash() -> str:
    """What made the cases: this folder's makers and what they use of the two others."""
    names = ["actuator.c", "actuator.py", "joints.py", "instruments.py", "sets.py", "ringing.c", "ringing.py"]
    paths = [HERE / name for name in names]
    for folder, files in (
        ("blind", ("designs", "effects", "detect", "files", "plant", "generate")),
        ("engine", ("engine_chain", "engine_limb", "many_rests", "engine_plant", "engine_bench", "engine_world")),
    ):
        paths += [HERE.parent / folder / f"{name}.py" for name in files]
    return hashlib.sha256(b"".join(path.read_bytes() for path in paths)).hexdigest()


def make(wanted: list[Case], out: Path) -> str:
    """Writes the cases that are not there yet and seals all; returns the seal. Cases of other sources are made
    anew, and so is a case whose making was interrupted."""
    stamp, seal = out / "made_by", out / SEAL
    if not stamp.exists() or stamp.read_text() != sources_hash():
        for part in PARTS:
            shutil.rmtree(out / part, ignore_errors=True)
        seal.unlink(missing_ok=True)
        out.mkdir(parents=True, exist_ok=True)
        stamp.write_text(sources_hash())
    # truth.json is the last file of a case
    lacking = [case for case in wanted if not (out / "answers" / case.name / "truth.json").exists()]
    begun = time.monotonic()
    for count, case in enumerate(lacking, start=1):
        seal.unlink(missing_ok=True)
        case.write(out)
        text = f"\rmade {count}/{len(lacking)} cases, {time.monotonic() - begun:.0f} s "
        print(text, end="" if count < len(lacking) else "\n", file=sys.stderr, flush=True)
    if not seal.exists():
        (out / "cases").mkdir(exist_ok=True)
        seal.write_text(listing(out))
    return seal_of(out)
