"""The 90 % interval of a tip force from currents, against servos after the published fit of the MX-106 (servos.c).

    python -m pytest -s tests/judges/currents                          a short form, on a seed of development
    python tests/judges/currents/test_currents.py SEED HELD MOVING     a judged run; its sizes are fixed before it

docs/joints.md has the figures. A judged run takes a seed that nobody has looked at."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from brace.model import load_limb
from brace.params import pack

HERE = Path(__file__).resolve().parent
CURRENTS = HERE.parents[2] / "build" / "host" / "tests" / "judges" / "currents" / "currents"
MUST = (0.86, 0.94)
DEVELOPED_ON = 11
# Of 300 cases with two components each. A share of 0.86 to 0.94 among these is found between the two with 99.9 %.
FOUND = (0.80, 0.98)


@dataclass
class Judged:
    """Cases of one kind: for each of x and z true force, low and high end, reported force [N]; of femur and tibia true
    load, low and high end [N mm]."""

    force: np.ndarray  # (cases, 2, 4)
    load: np.ndarray  # (cases, 2, 3)

    def holds(self) -> tuple[float, float]:
        """Shares of the intervals that hold the true force, and of those that hold the true load."""
        force, load = self.force, self.load
        return (
            float(np.mean((force[..., 1] <= force[..., 0]) & (force[..., 0] <= force[..., 2]))),
            float(np.mean((load[..., 1] <= load[..., 0]) & (load[..., 0] <= load[..., 2]))),
        )

    def words(self, kind: str) -> str:
        """One line."""
        force, load = self.holds()
        true, low, high = (self.force[..., index] for index in range(3))
        misses = [np.mean(true < low), np.mean(true > high)]
        wide = self.force[..., 2] - self.force[..., 1]
        off = np.abs(self.force[..., 3] - self.force[..., 0])
        return (
            f"{kind}: {len(self.force)} cases, force in its interval {100 * force:.1f} % (below it "
            f"{100 * misses[0]:.1f} %, above {100 * misses[1]:.1f} %), load {100 * load:.1f} %; interval's width "
            f"median {np.nanmedian(wide):.2f} N, reported force off by {np.nanmedian(off):.2f} N"
        )


def judge(seed: int, held: int, moving: int) -> dict[str, Judged]:
    """Runs the cases."""
    block = pack(load_limb(HERE / "mx106.toml")).content
    arguments = [str(CURRENTS), str(seed), str(held), str(moving)]
    printed = subprocess.run(arguments, input=block, capture_output=True, check=True).stdout.decode()
    rows: dict[str, list[list[float]]] = {"held": [], "moving": []}
    for line in printed.splitlines():
        kind, *numbers = line.split()
        rows[kind].append([float(number) for number in numbers])
    return {
        kind: Judged(np.array(of)[:, :8].reshape(-1, 2, 4), np.array(of)[:, 8:].reshape(-1, 2, 3))
        for kind, of in rows.items()
        if of
    }


def test_the_interval_holds_as_often_as_it_says() -> None:
    for kind, judged in judge(DEVELOPED_ON, 300, 300).items():
        print(judged.words(kind))
        assert FOUND[0] <= judged.holds()[0] <= FOUND[1], judged.words(kind)


if __name__ == "__main__":
    for name, cases in judge(*(int(argument) for argument in sys.argv[1:4])).items():
        print(cases.words(name))
