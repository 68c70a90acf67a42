"""Joint tests with a hidden truth, by formulas written out here: nothing of the tool's plant is used.

`python joint_cases.py [CASES] [SEED]` diagnoses that many and prints how often what was hidden is named.
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

KINDS: tuple[str, ...] = (
    "none",
    "backlash",
    "coulomb_friction",
    "joint_hardening",
    "backlash+coulomb_friction",
    "backlash+coulomb_friction+joint_hardening",
    "asymmetric",
    "cogging",
)
OUTSIDE = ("asymmetric", "cogging")


@dataclass(frozen=True)
class Case:
    """`truth` are keys of limb.toml's joint; `columns` the record."""

    kind: str
    truth: dict[str, float]
    columns: dict[str, np.ndarray]

    @property
    def hidden(self) -> set[str]:
        return set() if self.kind in ("none", *OUTSIDE) else set(self.kind.split("+"))

    def write(self, folder: Path) -> Path:
        """As a dataset."""
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "meta.toml").write_text('format = 1\nkind = "joint_test"\n')
        names = ["t_s", "angle_rad", "torque_n_mm", "test"]
        table = np.column_stack([self.columns[name] for name in names])
        lines = [f"{t:.4f},{a:.8f},{q:.4f},{int(k)}" for t, a, q, k in table]
        (folder / "data.csv").write_text("\n".join([",".join(names), *lines]) + "\n")
        return folder


def cases(count: int, seed: int) -> Iterator[Case]:
    """Every kind in turn."""
    random = np.random.default_rng(seed)
    for number in range(count):
        yield case(KINDS[number % len(KINDS)], random)


def case(kind: str, random: np.random.Generator) -> Case:
    """Five tests, three small and two large, on one joint."""
    reach = random.uniform(0.01, 0.06)  # of the large tests [rad]
    stiffness = 10.0 ** random.uniform(4.5, 5.7)  # N mm/rad
    whole = stiffness * reach
    noise = whole * 10.0 ** random.uniform(-2.7, -1.8)
    has = set(kind.split("+"))
    gap = reach * random.uniform(0.1, 0.6) if "backlash" in has else 0.0
    dry = whole * random.uniform(0.03, 0.15) if "coulomb_friction" in has else 0.0
    share = random.uniform(0.05, 0.2) if "coulomb_friction" in has and random.random() < 0.5 else 0.0
    cubic = random.uniform(0.2, 1.0) * stiffness / reach**2 if "joint_hardening" in has else 0.0
    one_side = random.uniform(0.15, 0.5) * random.choice([-1, 1]) if kind == "asymmetric" else 0.0
    tooth = whole * random.uniform(0.03, 0.1) if kind == "cogging" else 0.0
    period, phase = 2 * reach / random.uniform(5, 12), random.uniform(0, 6.28)
    zero, offset = random.uniform(-0.2, 0.2), whole * random.uniform(-0.02, 0.02)
    rows: list[np.ndarray] = []
    for test in range(5):
        size = reach * (0.45 if test < 3 else 1.0) * random.uniform(0.95, 1.0)
        legs = 260
        angle = size * np.interp(np.linspace(0, 4, legs), [0, 1, 3, 4], [0, 1, -1, 0])
        beyond = np.sign(angle) * np.maximum(np.abs(angle) - gap / 2, 0.0)
        spring = stiffness * beyond * np.where(beyond > 0, 1 + one_side, 1.0) + cubic * beyond**3
        sense = np.sign(np.diff(angle, prepend=-1e-9))
        torque = (
            spring
            + (dry + share * np.abs(spring)) * sense
            + tooth * np.sin(2 * np.pi * angle / period + phase)
        )
        torque = torque + offset + noise * random.standard_normal(legs)
        read = np.round((angle + zero) / 1e-5) * 1e-5
        rows.append(np.column_stack([0.02 * np.arange(legs), read, torque, np.full(legs, test)]))
    table = np.vstack(rows)
    columns = dict(zip(("t_s", "angle_rad", "torque_n_mm", "test"), table.T))
    truth = {
        "compliance_rad_per_n_mm": 1.0 / stiffness,
        "gap_rad": gap,
        "coulomb_n_mm": dry,
        "coulomb_per_load_ratio": share,
        "hardening_n_mm_per_rad3": cubic,
    }
    return Case(kind, truth, columns)


@dataclass
class Tally:
    """Counts over cases."""

    right: Counter[str]
    total: Counter[str]
    false_names: int = 0
    held: int = 0
    intervals: int = 0
    misses: list[str] = None  # type: ignore[assignment]


def tally(count: int, seed: int, folder: Path) -> Tally:
    """Diagnoses `count` cases. Right is: exactly what is hidden, nothing for none, and for what is outside
    the catalogue no effect named with a confidence of half or more."""
    from brace.dataset import load_dataset
    from brace.diagnose.options import Options
    from brace.diagnose.run import diagnose

    result = Tally(Counter(), Counter(), misses=[])
    for number, one in enumerate(cases(count, seed)):
        found = diagnose(load_dataset(one.write(folder / f"c{number}")), None, Options())
        named = {effect.name for effect in found.effects if effect.confidence >= 0.5}
        result.total[one.kind] += 1
        right = named == one.hidden and (one.kind not in OUTSIDE or found.verdict == "unknown")
        right = right and (one.kind != "none" or found.verdict == "none")
        result.right[one.kind] += right
        result.false_names += bool(named - one.hidden)
        if not right:
            result.misses.append(
                f"{number} {one.kind}: {found.verdict} {sorted(named)} {found.sentence[:160]}"
            )
        for effect in found.effects:
            for key, interval in effect.parameters.items():
                truth = one.truth.get(key.rpartition(".")[2])
                if truth is not None and effect.name in one.hidden and truth > 0.0:
                    result.intervals += 1
                    result.held += interval.low <= truth <= interval.high
    return result


def main() -> None:
    """Prints the rates."""
    import tempfile

    count = int(sys.argv[1]) if len(sys.argv) > 1 else 104
    seed = int(sys.argv[2]) if len(sys.argv) > 2 else 1
    with tempfile.TemporaryDirectory() as folder:
        found = tally(count, seed, Path(folder))
    for kind in KINDS:
        print(f"{kind:45s} {found.right[kind]:4d} of {found.total[kind]}")
    print(f"named what is not there: {found.false_names} of {count}")
    print(f"90 % intervals that hold the truth: {found.held} of {found.intervals}")
    print(*found.misses, sep="\n")


if __name__ == "__main__":
    main()
