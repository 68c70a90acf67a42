"""Which foot slips first, at which payload, and what each foot bears: `brace stance load` against the judge's truth.

    .venv/bin/python tests/judges/stance/judge.py --seed 1 --count 100 --jobs 2
    .venv/bin/python tests/judges/stance/judge.py --seed 1 --count 100 --exact

Seeds below 1000 are for practice. A case is a drawn stance in which all feet hold before the payload, the nearest by
5 % of the weight, and some foot slips within 60 N; its payload is then scaled so that a foot slips at a factor drawn
between 0.6 and 2.5. Writes a line of JSON a case to --out, and the table on stdout.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path

import baselines
import numpy as np
from limbs import Array
from truth import NoStance, Siconos, State, first_slip, margins, payload, stand
from world import Hidden, Stance, draw, write, write_measured

SPARE_BEFORE = 0.05  # of the weight; the sensors' noise is 1 % of it, in each direction
SLIPS_AT = (0.6, 2.5)
NEAR = 0.05  # of the load: two feet so near are not told apart
MOST = 6.0  # times 10 N
COLLAPSES_N = 0.1  # no foot is so near its cone, and yet there is no further stance: a limb gave way
TIME_OUT_S = 120.0
LEAST_SENSOR_N = 0.001  # the command is asked with a sensor of this noise where it has none

HIDES = {"zeros": "zero_rad", "offsets": "offset_mm", "play": "play_rad", "compliance": "compliance_rel",
         "noise": "sensor_n"}

Forces = list[list[float]]  # a foot each, in the body's frame


@dataclass(frozen=True)
class Asked:
    """What is judged: `brace` is the command, `measured` whether it has the forces before the payload."""

    seed: int
    hidden: Hidden
    finite: bool
    measured: bool
    brace: list[str]


@dataclass(frozen=True)
class Said:
    """An answer. `foot` -1 and no factor: none slips; `falls`: no stance exists; `failed`: why there is no answer."""

    foot: int = -1
    factor: float | None = None
    change_n: Forces | None = None
    factor_interval: tuple[float, float] | None = None
    force_low_n: Forces | None = None
    force_high_n: Forces | None = None
    falls: bool = False
    failed: str = ""


@dataclass(frozen=True)
class Case:
    """A stance's truth, and what was said of it. `spare`: the next foot's margin at the first slip, of the load."""

    number: int
    kind: str
    foot: int
    factor: float
    spare: float
    payload_n: float
    force_n: Forces | None  # at the payload's factor 1; None: the body has fallen
    change_n: Forces | None
    residual_n: float
    said: dict[str, Said] = field(default_factory=dict)


def _stands(stance: Stance, solver: Siconos, steps: int = 8) -> State | None:
    try:
        state = stand(stance.world, solver, steps)
    except NoStance:
        return None
    least = SPARE_BEFORE * np.linalg.norm(stance.world.weight_n)
    return state if margins(stance.world, state.force_n).min() > least else None


def _in_body(state: State, finite: bool) -> Array:
    """Forces in the body's frame, as sensors have them; small displacements turn none."""
    return state.force_n @ state.turned if finite else state.force_n


def case(asked: Asked, number: int, solver: Siconos) -> Case | None:
    """One stance of a seed: the truth, the command's answer, the baselines'; None where it is no case."""
    # The cheap worlds first: most stances that do not hold in the last hold in none of them.
    if not _stands(draw(asked.seed, number, Hidden.none(), finite=False), solver, 2):
        return None
    if asked.finite and not _stands(draw(asked.seed, number, asked.hidden, finite=False), solver):
        return None
    stance = draw(asked.seed, number, asked.hidden, asked.finite)
    state = _stands(stance, solver)
    if state is None or (slip := first_slip(stance.world, solver, state, MOST)) is None:
        return None
    if margins(stance.world, slip.before.force_n)[slip.foot] > COLLAPSES_N:
        return None
    factor = float(np.random.default_rng([asked.seed, number, 1]).uniform(*SLIPS_AT))
    world = replace(stance.world, payload_n=stance.world.payload_n * slip.factor / factor)
    stance = replace(stance, world=world)
    before = _in_body(state, asked.finite)
    try:
        if factor > 1:
            state = payload(world, solver, state, 0, 1, 1)
        else:
            state = payload(world, solver, slip.after, factor, 1, 1 + int(20 * (1 - factor)))
        after = _in_body(state, asked.finite)
    except NoStance:
        after = None
    load = float(np.linalg.norm(world.weight_n + factor * world.payload_n))
    forces, change = (None, None) if after is None else (after.tolist(), (after - before).tolist())
    found = Case(number, stance.name.split()[0], slip.foot, factor, slip.spare_n / load,
                 float(np.linalg.norm(world.payload_n)), forces, change, state.residual_n)
    read = before + stance.noise_n
    found.said["brace"] = _ask(asked, stance, read)
    for name, law in (("convex", baselines.convex(stance, read)), ("rigid", baselines.rigid(stance))):
        found.said[name] = Said(law.foot, law.factor, None if law.change_n is None else law.change_n.tolist())
    return found


def _ask(asked: Asked, stance: Stance, read_n: Array) -> Said:
    """What the command says of the files it gets."""
    with tempfile.TemporaryDirectory() as name:
        ask = [*asked.brace, "stance", "load", str(write(stance, Path(name))), "--json"]
        if asked.measured:
            measured = Path(name) / "measured.csv"
            write_measured(stance, read_n, measured)
            ask += ["--measured", str(measured), "--measured-sd", str(max(asked.hidden.sensor_n, LEAST_SENSOR_N))]
        try:
            done = subprocess.run(ask, capture_output=True, text=True, timeout=TIME_OUT_S)
        except subprocess.TimeoutExpired:
            return Said(failed=f"no answer in {TIME_OUT_S:.0f} s")
    if done.returncode == 5:
        return Said(falls=True)
    if done.returncode:
        return Said(failed=f"exit {done.returncode}: {(done.stderr.strip().splitlines() or ['no word'])[0]}")
    said = json.loads(done.stdout)
    slip = said["first_slip"]
    foot = stance.names().index(slip["limb"]) if slip["limb"] else -1
    interval = None if slip["low"] is None or slip["high"] is None else (slip["low"], slip["high"])
    low, high = ([limb[key] for limb in said["limbs"]] for key in ("force_low_n", "force_high_n"))
    change = [limb["force_n"] for limb in said["change"]["limbs"]]
    return Said(foot, slip["payload_factor"], change, interval, low, high)


def share(values: list[bool]) -> str:
    """A share with its 90 % interval (Wilson's) and how many it counts."""
    n, z = len(values), 1.645
    if not n:
        return "-"
    p = sum(values) / n
    middle, half = p + z * z / 2 / n, z * np.sqrt(p * (1 - p) / n + z * z / 4 / n / n)
    low, high = (100 * (middle + side * half) / (1 + z * z / n) for side in (-1, 1))
    return f"{100 * p:.1f} % ({low:.1f} to {high:.1f}; {n})"


def _row(name: str, cases: list[Case]) -> str:
    foot, ten, two = [], [], []
    changes: dict[bool, list[bool]] = {True: [], False: []}
    for one in cases:
        said = one.said[name]
        error = np.inf if said.factor is None else abs(said.factor / one.factor - 1)
        ten.append(bool(error <= 0.1))
        two.append(bool(error <= 0.02))
        if one.spare >= NEAR:
            foot.append(said.foot == one.foot)
        if one.change_n is None or name == "rigid":  # the rigid body knows no change
            continue
        change = said.change_n if said.change_n is not None else np.full_like(one.change_n, np.inf)
        off = np.linalg.norm(np.array(change) - np.array(one.change_n), axis=1) / one.payload_n
        changes[one.factor > 1] += (off <= 0.05).tolist()
    return f"| {name} | " + " | ".join(map(share, (foot, ten, two, changes[True], changes[False]))) + " |"


def table(cases: list[Case]) -> str:
    """Markdown: a row for the command and for each of the others, then intervals, falls and failures."""
    lines = ["| law | first foot, where the next is 5 % of the load away | factor within 10 % | within 2 % | "
             "change within 5 % of the payload, all hold | where one has slipped |", "|---|---|---|---|---|---|"]
    lines += [_row(name, cases) for name in ("brace", "convex", "rigid")]
    inside, factors = [], []
    for one in cases:
        said = one.said["brace"]
        if said.force_low_n is not None and one.force_n is not None:
            low, high, force = (np.array(values) for values in (said.force_low_n, said.force_high_n, one.force_n))
            inside += ((low <= force) & (force <= high)).ravel().tolist()
        if said.factor_interval is not None:
            factors.append(said.factor_interval[0] <= one.factor <= said.factor_interval[1])
    kinds = [one.kind for one in cases]
    fell = [one.said["brace"].falls for one in cases if one.force_n is None]
    stood = [one.said["brace"].falls for one in cases if one.force_n is not None]
    lines += ["", f"90 % intervals of the forces hold in {share(inside)}, of the factor in {share(factors)}.",
              f"{len(cases)} stances: " + ", ".join(f"{kinds.count(kind)} {kind}" for kind in sorted(set(kinds))) + ".",
              f"The body fell in {len(fell)}: the command said so of {sum(fell)}, and of {sum(stood)} that stood."]
    lines += [f"failed: stance {one.number}: {one.said['brace'].failed}" for one in cases if one.said["brace"].failed]
    return "\n".join(lines)


_solver: Siconos | None = None


def _work(ask: tuple[Asked, int]) -> Case | None:
    global _solver  # one of each process
    _solver = _solver or Siconos()
    return case(*ask, _solver)


def run(asked: Asked, count: int, jobs: int) -> Iterator[Case]:
    """The first `count` cases of a seed, in order."""
    with ProcessPoolExecutor(jobs) as pool:
        first = found = 0
        while found < count:
            numbers = range(first, first + 8 * jobs)
            for one in pool.map(_work, [(asked, number) for number in numbers]):
                if one is not None and found < count:
                    found += 1
                    yield one
            first = numbers.stop


def main() -> int:
    """Exit 4 where Siconos is not installed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--exact", action="store_true", help="nothing is hidden and the sensors have no noise")
    parser.add_argument("--hide", nargs="+", choices=HIDES, default=list(HIDES), help="what is hidden; default: all")
    parser.add_argument("--tell-play", action="store_true", help="limb.toml says how wide the play is")
    parser.add_argument("--small", action="store_true", help="the world of small displacements")
    parser.add_argument("--unmeasured", action="store_true", help="no forces are measured before the payload")
    parser.add_argument("--friction-rel", type=float, default=0.0, help="hidden spread of friction, one sigma")
    parser.add_argument("--brace", nargs="+", default=[str(Path(sys.executable).parent / "brace")], help="the judged")
    parser.add_argument("--out", type=Path, help="a line of JSON a case")
    options = parser.parse_args()
    try:
        Siconos().close()
    except OSError as error:
        print(error, file=sys.stderr)
        return 4
    hidden = Hidden(friction_rel=options.friction_rel, tells_play=options.tell_play)
    known = {key: 0.0 for name, key in HIDES.items() if options.exact or name not in options.hide}
    hidden = Hidden(**{**asdict(hidden), **known})
    asked = Asked(options.seed, hidden, not options.small, not options.unmeasured, options.brace)
    cases: list[Case] = []
    with (options.out or Path("/dev/null")).open("w") as out:
        for one in run(asked, options.count, options.jobs):
            cases.append(one)
            print(json.dumps(asdict(one)), file=out, flush=True)
            if sys.stderr.isatty():
                print(f"\r{len(cases)} of {options.count}", end="", file=sys.stderr, flush=True)
    print(table(cases))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
