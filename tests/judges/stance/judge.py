"""Which foot slips first, at which payload, and what each foot bears: `brace stance load` against the judge's truth.

    .venv/bin/python tests/judges/stance/judge.py --seed 1 --count 100 --jobs 2
    .venv/bin/python tests/judges/stance/judge.py --seed 1 --count 100 --exact
    .venv/bin/python tests/judges/stance/judge.py --seed 1 --count 100 --changes

Seeds below 1000 are for practice. A case is a drawn stance in which all feet hold before the payload, the nearest by
5 % of the weight, and some foot slips within 60 N; its payload is then scaled so that a foot slips at a factor drawn
between 0.6 and 2.5. With --changes, a limb's tip is commanded by 0.3 to 1 mm, and in a stance of its own a foot is let
go, both without payload; the foot is one without which the others hold, if there is one. With --currents the forces
before the payload come from servos' currents (servos.py). Writes a line of JSON a case to --out, and the table on
stdout.
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
from typing import Any

import baselines
import numpy as np
import servos
from limbs import Array
from truth import NoStance, Siconos, State, by_joints, execute, first_slip, lift, margins, payload, stand
from world import Hidden, Stance, draw, moved_rad, unit, write, write_measured, write_torques

FALLS = "exit 5: the body does not stand"
SPARE_BEFORE = 0.05  # of the weight; the sensors' noise is 1 % of it, in each direction
SLIPS_AT = (0.6, 2.5)
NEAR = 0.05  # of the load: two feet so near are not told apart
NEAR_CHANGE = 0.05  # of the payload, or of the weight
MOVES_MM = (0.3, 1.0)
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
    changes: bool = False


@dataclass(frozen=True)
class Change:
    """What moved set-points or a lifted foot change, without payload: `kind` is "set-point" or "lift", `limb` the one.
    A law's `said` is empty where it has no answer."""

    kind: str
    limb: int
    slipped: bool  # some foot
    change_n: Forces
    said: dict[str, Forces | None]
    failed: str = ""

    def feet(self) -> list[int]:
        """That bear the body after it."""
        return [foot for foot in range(len(self.change_n)) if self.kind != "lift" or foot != self.limb]


@dataclass(frozen=True)
class Reading:
    """What is known of the feet before the payload (n, 3): forces in the body's frame, or the motors' torques by their
    currents, and the forces that these would be without friction."""

    force_n: Array
    torque_n_mm: Array | None = None

    def write(self, stance: Stance, path: Path) -> None:
        if self.torque_n_mm is None:
            write_measured(stance, self.force_n, path)
        else:
            write_torques(stance, self.torque_n_mm, path)


@dataclass(frozen=True)
class Said:
    """An answer. `foot` -1 and no factor: none slips; `falls`: no stance exists; `failed`: why there is no answer."""

    foot: int = -1
    factor: float | None = None
    change_n: Forces | None = None
    factor_interval: tuple[float, float] | None = None
    force_n: Forces | None = None
    force_low_n: Forces | None = None
    force_high_n: Forces | None = None
    before_n: Forces | None = None
    before_low_n: Forces | None = None
    before_high_n: Forces | None = None
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
    changes: list[Change] = field(default_factory=list)
    weight_n: float = 0.0
    load_n: float = 0.0  # weight and payload
    before_n: Forces = field(default_factory=list)


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
    state = standing = _stands(stance, solver)
    if standing is None or state is None or (slip := first_slip(stance.world, solver, state, MOST)) is None:
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
                 float(np.linalg.norm(world.payload_n)), forces, change, state.residual_n,
                 weight_n=float(np.linalg.norm(world.weight_n)),
                 load_n=float(np.linalg.norm(world.weight_n + world.payload_n)), before_n=before.tolist())
    read = _read(asked, number, stance, standing)
    found.said["brace"] = _ask(asked, stance, read)
    for name, law in (("convex", baselines.convex(stance, read.force_n)), ("rigid", baselines.rigid(stance))):
        found.said[name] = Said(law.foot, law.factor, None if law.change_n is None else law.change_n.tolist())
    if asked.changes:
        found.changes.extend(_changes(asked, number, stance, standing, read, solver))
    return found


def _read(asked: Asked, number: int, stance: Stance, state: State) -> Reading:
    """Before the payload."""
    if not asked.hidden.currents:
        return Reading(_in_body(state, asked.finite) + stance.noise_n)
    rng = np.random.default_rng([asked.seed, number, 4])
    by = by_joints(stance.world, state)
    torque = servos.read(rng, by, np.einsum("nic,nc->ni", by, state.force_n))
    in_body = by @ state.turned if asked.finite else by
    return Reading(np.linalg.solve(in_body, torque[..., None])[..., 0].astype(np.float64), torque)


def _changes(asked: Asked, number: int, stance: Stance, before: State, read: Reading,
             solver: Siconos) -> Iterator[Change]:
    """A set-point that moves; a foot that is let go: the first, in a drawn order, without which the body stands."""
    rng = np.random.default_rng([asked.seed, number, 2])
    stance = replace(stance, world=replace(stance.world, payload_n=np.zeros(3)))
    world, n = stance.world, len(stance.friction)
    limb = int(rng.integers(n))
    way = np.zeros((n, 3))
    way[limb] = rng.uniform(*MOVES_MM) * unit(rng.normal(size=3))
    theta = world.limbs.theta_rad + moved_rad(stance, way) - stance.nominal.theta_rad
    order = rng.permutation(n)
    try:
        after = execute(world, solver, before, theta, 0.0)[1]
    except NoStance:
        after = None
    if after is not None:
        said = {"convex": baselines.convex_change(stance, read.force_n, way_mm=way)}
        move = f"{stance.names()[limb]}:" + ",".join(repr(float(part)) for part in way[limb])
        yield _change(asked, stance, "set-point", limb, before, after, said, read, ["set", "--move", move])
    for foot in order:
        if not baselines.may_stand(stance, foot):
            continue
        try:
            after = lift(world, solver, before, int(foot))
        except NoStance:
            continue
        said = {"convex": baselines.convex_change(stance, read.force_n, lifted=int(foot))}
        ask = ["lift", "--limb", stance.names()[foot]]
        yield _change(asked, stance, "lift", int(foot), before, after, said, read, ask)
        return


def _change(asked: Asked, stance: Stance, kind: str, limb: int, before: State, after: State,
            said: dict[str, Array | None], read: Reading, ask: list[str]) -> Change:
    """With the command's answer."""
    true = _in_body(after, asked.finite) - _in_body(before, asked.finite)
    laws = {name: None if change is None else change.tolist() for name, change in said.items()}
    found = Change(kind, limb, bool(after.slipped.any()), true.tolist(), laws)
    answer = _run(asked, stance, read, ask)
    if isinstance(answer, str):
        found.said["brace"] = None
        return replace(found, failed=answer)
    if kind == "lift":
        (answer,) = answer["lifted"]
    changes = {one["name"]: one["change_n"] for one in answer["limbs"]}
    nothing = [0.0, 0.0, 0.0]  # of the lifted foot itself: it is not counted
    found.said["brace"] = [changes.get(name, nothing) for name in stance.names()] if changes else None
    return found


def _run(asked: Asked, stance: Stance, read: Reading, ask: list[str]) -> dict[str, Any] | str:
    """What the command says of the files it gets, or why it does not. `ask`: the action, and its own options."""
    with tempfile.TemporaryDirectory() as name:
        whole = [*asked.brace, "stance", ask[0], str(write(stance, Path(name))), *ask[1:], "--json"]
        if asked.measured:
            measured = Path(name) / "measured.csv"
            read.write(stance, measured)
            whole += ["--measured", str(measured)]
            if not asked.hidden.currents:
                whole += ["--measured-sd", str(max(asked.hidden.sensor_n, LEAST_SENSOR_N))]
        try:
            done = subprocess.run(whole, capture_output=True, text=True, timeout=TIME_OUT_S)
        except subprocess.TimeoutExpired:
            return f"no answer in {TIME_OUT_S:.0f} s"
    if done.returncode == 5:
        return FALLS
    if done.returncode:
        return f"exit {done.returncode}: {(done.stderr.strip().splitlines() or ['no word'])[0]}"
    said: dict[str, Any] = json.loads(done.stdout)
    return said


def _ask(asked: Asked, stance: Stance, read: Reading) -> Said:
    """What `brace stance load` says."""
    said = _run(asked, stance, read, ["load"])
    if isinstance(said, str):
        return Said(falls=True) if said == FALLS else Said(failed=said)
    slip = said["first_slip"]
    foot = stance.names().index(slip["limb"]) if slip["limb"] else -1
    interval = None if slip["low"] is None or slip["high"] is None else (slip["low"], slip["high"])
    change = [limb["force_n"] for limb in said["change"]["limbs"]]
    force, before = _ends(said["limbs"]), _ends(said["before"]["limbs"])
    return Said(foot, slip["payload_factor"], change, interval, *force, *before)


def _ends(limbs: list[dict[str, Any]]) -> tuple[Forces, Forces, Forces]:
    """What is said of forces, and their intervals' low and high ends."""
    said, low, high = ([limb[key] for limb in limbs] for key in ("force_n", "force_low_n", "force_high_n"))
    return said, low, high


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


def _errors_n(change: Change, name: str) -> Array:
    """Of each foot's change; infinite without an answer."""
    said, feet = change.said.get(name), change.feet()
    if said is None:
        return np.full(len(feet), np.inf)
    errors: Array = np.linalg.norm(np.array(said)[feet] - np.array(change.change_n)[feet], axis=1)
    return errors


def changes_table(cases: list[Case]) -> list[str]:
    """A row for each kind of change and each law. A payload's change has rows of its own, as before it slips."""
    payloads = [(one, Change("payload", -1, one.factor <= 1, one.change_n,
                             {name: one.said[name].change_n for name in ("brace", "convex")}))
                for one in cases if one.change_n is not None]
    every = payloads + [(one, change) for one in cases for change in one.changes]
    lines = ["| change by | law | within 5 % of the payload, all hold | where one has slipped | both "
             "| 95 % of the feet are within, of the payload | within 5 % of the weight, both |", "|" + "---|" * 7]
    for kind in ("payload", "set-point", "lift", "all three"):
        those = [(one, change) for one, change in every if kind in (change.kind, "all three")]
        for name in ("brace", "convex"):
            rows = [(change.slipped, _errors_n(change, name) / one.payload_n, _errors_n(change, name) / one.weight_n)
                    for one, change in those]
            hold, slipped = ([bool(off <= NEAR_CHANGE) for slips, errors, _ in rows if slips == one for off in errors]
                             for one in (False, True))
            errors = [float(off) for _, errors, _ in rows for off in errors]
            most = f"{100 * np.percentile(errors, 95, method='higher'):.1f} %" if errors else "-"
            weight = [bool(off <= NEAR_CHANGE) for _, _, errors in rows for off in errors]
            lines.append(f"| {kind} | {name} | " + " | ".join(
                [share(hold), share(slipped), share(hold + slipped), most, share(weight)]) + " |")
    return lines + [f"failed: stance {one.number}, {change.kind} of limb {change.limb}: {change.failed}"
                    for one in cases for change in one.changes if change.failed]


def _forces(cases: list[Case], name: str) -> tuple[list[bool], list[float]]:
    """Of the command's forces, `before` the payload or under it (`force`): does each component lie in its interval, and
    how far is each foot's off, of what the body carries?"""
    inside, errors = [], []
    for one in cases:
        true, load = (one.before_n, one.weight_n) if name == "before" else (one.force_n, one.load_n)
        said, low, high = (getattr(one.said["brace"], f"{name}{end}_n") for end in ("", "_low", "_high"))
        if not true or low is None or high is None:
            continue
        inside += ((np.array(low) <= true) & (true <= np.array(high))).ravel().tolist()
        if said is not None:
            errors += (np.linalg.norm(np.array(said) - true, axis=1) / load).tolist()
    return inside, errors


def table(cases: list[Case]) -> str:
    """Markdown: a row for the command and for each of the others, then intervals, falls and failures."""
    lines = ["| law | first foot, where the next is 5 % of the load away | factor within 10 % | within 2 % | "
             "change within 5 % of the payload, all hold | where one has slipped |", "|---|---|---|---|---|---|"]
    lines += [_row(name, cases) for name in ("brace", "convex", "rigid")]
    factors = []
    for one in cases:
        said = one.said["brace"]
        if said.factor_interval is not None:
            factors.append(said.factor_interval[0] <= one.factor <= said.factor_interval[1])
    inside, _ = _forces(cases, "force")
    kinds = [one.kind for one in cases]
    fell = [one.said["brace"].falls for one in cases if one.force_n is None]
    stood = [one.said["brace"].falls for one in cases if one.force_n is not None]
    lines += ["", f"90 % intervals of the forces hold in {share(inside)}, of the factor in {share(factors)}.",
              f"{len(cases)} stances: " + ", ".join(f"{kinds.count(kind)} {kind}" for kind in sorted(set(kinds))) + ".",
              f"The body fell in {len(fell)}: the command said so of {sum(fell)}, and of {sum(stood)} that stood."]
    for name, of in (("before", "before the payload, in % of the weight"), ("force", "under it, of the load")):
        inside, errors = _forces(cases, name)
        if errors:
            half, most = (100 * np.percentile(errors, q, method="higher") for q in (50, 95))
            lines.append(f"Forces {of}: of {len(errors)} feet 50 % are off by less than {half:.1f} %, 95 % by "
                         f"{most:.1f} %; 90 % intervals hold in {share(inside)}.")
    lines += [f"failed: stance {one.number}: {one.said['brace'].failed}" for one in cases if one.said["brace"].failed]
    if any(one.changes for one in cases):
        lines += ["", *changes_table(cases)]
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
    parser.add_argument("--currents", action="store_true", help="servos' currents instead of sensors at the tips")
    parser.add_argument("--changes", action="store_true", help="changes by a set-point and by a lift, too")
    parser.add_argument("--friction-rel", type=float, default=0.0, help="hidden spread of friction, one sigma")
    parser.add_argument("--brace", nargs="+", default=[str(Path(sys.executable).parent / "brace")], help="the judged")
    parser.add_argument("--out", type=Path, help="a line of JSON a case")
    options = parser.parse_args()
    try:
        Siconos().close()
    except OSError as error:
        print(error, file=sys.stderr)
        return 4
    hidden = Hidden(friction_rel=options.friction_rel, tells_play=options.tell_play, currents=options.currents)
    known: dict[str, float] = {key: 0.0 for name, key in HIDES.items() if options.exact or name not in options.hide}
    hidden = Hidden(**{**asdict(hidden), **known})
    asked = Asked(options.seed, hidden, not options.small, not options.unmeasured, options.brace, options.changes)
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
