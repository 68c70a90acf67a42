"""Set-points that `brace stance set` says, executed in the judge's world: is the smallest margin as large as it can be,
do the feet bear what was wanted?

    .venv/bin/python tests/judges/stance/set_points.py --seed 1 --count 50 --jobs 2

Seeds below 1000 are for practice. A case is a drawn stance whose feet hold its payload with 5 % of the load to spare.
The command knows the forces under the payload, read with noise, and nothing that is hidden. It is asked a second time
when its set-points have been executed and the forces read again. Every set-point may move by TRAVEL_MM each time. The
best margin is that of TRIES ways, tried in the truth's own law made linear at its rest: half anywhere, half near the
best so far. Wanted are the forces of a way drawn in the same law, so that there are such.
Beside it stands what sensors alone cost: a way by that law, so with K exact, from forces read once.
"""

from __future__ import annotations

import argparse
import json
import resource
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from judge import SPARE_BEFORE, TIME_OUT_S, _stands, share
from limbs import Array, loaded
from scipy.optimize import linprog
from truth import NoStance, Siconos, State, World, crossing, execute, frames, margins, payload, stand
from world import Hidden, Stance, draw, write, write_measured

TRAVEL_MM = 3.0
WANTED_MM = 1.0
TRIES = 100_000
CHUNK = 10_000
ROUNDS = 2
GOOD = 0.95  # of the best margin
NEAR = 0.05  # of the load, from the wanted force
SLOW_S = 2.0
FACES = 24  # of a cone


@dataclass(frozen=True)
class Case:
    """before_share, margin_share: of the best margin, as it stood and after each round; exact_k_share: after a way by
    exact K. off: of each foot's force from
    the wanted one, of the load, after each round. slipped: how many feet did while set-points moved. seconds: the
    command's, of processor."""

    number: int
    kind: str
    before_share: float
    exact_k_share: float
    margin_share: list[float]
    off: list[list[float]]
    slipped: int
    seconds: float
    failed: str = ""


def _by_ways(world: World, state: State) -> Array:
    """(3n, 3n) [N/mm]: forces by the ways of the tips' set-points in the body's frame, while all feet stick."""
    turn = state.turned @ world.turn
    limbs = replace(world.limbs, theta_rad=world.limbs.theta_rad + world.zero_rad)
    tip, own, _ = loaded(limbs, np.einsum("nab,na->nb", turn, state.force_n), state.coordinates)
    about = np.einsum("nab,nb->na", turn, tip) + world.mount_mm @ state.turned.T
    k = np.linalg.inv(np.einsum("nab,nbc,ndc->nad", turn, own, turn))
    n = len(k)
    springs, levers = np.zeros((3 * n, 3 * n)), np.zeros((3 * n, 6))
    for i in range(n):
        springs[3 * i : 3 * i + 3, 3 * i : 3 * i + 3] = k[i]
        levers[3 * i : 3 * i + 3] = np.hstack([np.eye(3), -crossing(about[i])])
    body = np.linalg.solve(levers.T @ springs @ levers, levers.T @ springs)
    by_ways: Array = -springs @ (np.eye(3 * n) - levers @ body) @ np.kron(np.eye(n), state.turned)
    return by_ways


def _least(world: World, force_n: Array) -> Array:
    """The smallest margin of each of many sets of forces (m, 3n)."""
    force = force_n.reshape(len(force_n), -1, 3)
    pressing = np.einsum("nc,mnc->mn", world.normal, force)
    sideways = np.linalg.norm(force - pressing[..., None] * world.normal, axis=2)
    least: Array = (world.friction * (pressing + world.grip_n) - sideways).min(axis=1)
    return least


def _best(world: World, state: State, by_ways: Array, rng: np.random.Generator) -> float:
    """The largest smallest margin of TRIES ways."""
    now, size = state.force_n.ravel(), len(by_ways)
    best, way = float(margins(world, state.force_n).min()), np.zeros(size)
    for chunk in range(TRIES // CHUNK):
        near = chunk >= TRIES // CHUNK // 2
        spread = TRAVEL_MM * (0.5 ** (chunk - TRIES // CHUNK // 2) if near else 1.0)
        ways = rng.uniform(-spread, spread, (CHUNK, size)) + (way if near else 0.0)
        ways = np.clip(ways, -TRAVEL_MM, TRAVEL_MM)
        least = _least(world, now + ways @ by_ways.T)
        if least.max() > best:
            best, way = float(least.max()), ways[np.argmax(least)]
    return best


def _by_exact_k(world: World, state: State, by_ways: Array, sensor_n: float, rng: np.random.Generator) -> float:
    """The smallest margin after the best way that forces read once allow, K exact: a linear programme."""
    internal = np.linalg.svd(by_ways)[0][:, : len(by_ways) - 6]  # of balanced forces: the rest of the noise is known
    read = state.force_n.ravel() + internal @ (internal.T @ rng.normal(0.0, sensor_n, len(by_ways)))
    rows, limits = [], []
    for i, along in enumerate(frames(world.normal)):
        for at in 2 * np.pi * np.arange(FACES) / FACES:
            side = np.cos(at) * along[:, 1] + np.sin(at) * along[:, 2] - world.friction[i] * along[:, 0]
            foot = slice(3 * i, 3 * i + 3)
            rows.append(np.append(side @ by_ways[foot], 1.0))
            limits.append(world.friction[i] * world.grip_n[i] - side @ read[foot])
    bounds = [(-TRAVEL_MM, TRAVEL_MM)] * len(by_ways) + [(None, None)]
    way = linprog(np.append(np.zeros(len(by_ways)), -1.0), np.array(rows), np.array(limits), bounds=bounds).x[:-1]
    return float(_least(world, (state.force_n.ravel() + by_ways @ way)[None])[0])


@dataclass(frozen=True)
class Round:
    """What the command has said: angles (n, 3), the footholds' offsets then, seconds of processor."""

    theta_rad: Array
    offset_mm: Array
    seconds: float


def _ask(brace: list[str], stance: Stance, offset_mm: Array, read_n: Array, wanted_n: Array | None) -> Round:
    """OSError with what went wrong."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_measured(stance, read_n, folder / "measured.csv")
        ask = [*brace, "stance", "set", str(write(stance, folder, offset_mm)), "--json", "--with-payload"]
        ask += ["--measured", str(folder / "measured.csv"), "--travel", str(TRAVEL_MM)]
        if wanted_n is not None:
            write_measured(stance, wanted_n, folder / "wanted.csv")
            ask += ["--for", "forces", "--wanted", str(folder / "wanted.csv")]
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run(ask, capture_output=True, text=True, timeout=TIME_OUT_S)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode:
        raise OSError(f"exit {done.returncode}: {(done.stderr.strip().splitlines() or ['no word'])[0]}")
    said = json.loads(done.stdout)["limbs"]
    theta, offset = (np.array([limb[key] for limb in said]) for key in ("theta_rad", "offset_mm"))
    return Round(theta, offset, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)


def _rounds(
    brace: list[str], stance: Stance, solver: Siconos, state: State, wanted_n: Array | None, rng: np.random.Generator
) -> Iterator[tuple[State, int, float]]:
    """After each round: the state, the feet that slipped, the command's seconds."""
    offset, world = np.zeros_like(state.force_n), stance.world
    for _ in range(ROUNDS):
        read = state.force_n @ state.turned + stance.hidden.sensor_n * rng.normal(size=state.force_n.shape)
        wanted = None if wanted_n is None else wanted_n @ state.turned
        said = _ask(brace, stance, offset, read, wanted)
        stance = replace(stance, nominal=replace(stance.nominal, theta_rad=said.theta_rad))
        world, state = execute(world, solver, state, said.theta_rad, 1.0)
        offset = said.offset_mm
        yield state, int(state.slipped.sum()), said.seconds


def case(seed: int, number: int, hidden: Hidden, brace: list[str], solver: Siconos) -> Case | None:
    """One stance of a seed; None where it is no case."""
    if not _stands(draw(seed, number, hidden, finite=False), solver):  # the cheap world first
        return None
    stance = draw(seed, number, hidden)
    world, rng = stance.world, np.random.default_rng([seed, number, 3])
    load_n = float(np.linalg.norm(world.weight_n + world.payload_n))
    try:
        state = payload(world, solver, stand(world, solver), 0, 1, 1)
    except NoStance:
        return None
    least = float(margins(world, state.force_n).min())
    if state.slipped.any() or state.gone.any() or least < SPARE_BEFORE * load_n:
        return None
    by_ways = _by_ways(world, state)
    best = _best(world, state, by_ways, rng)
    wanted = state.force_n + (by_ways @ rng.uniform(-WANTED_MM, WANTED_MM, len(by_ways))).reshape(-1, 3)
    if margins(world, wanted).min() < SPARE_BEFORE * load_n:
        wanted = state.force_n + 0.3 * (wanted - state.force_n)
    exact_k = _by_exact_k(world, state, by_ways, hidden.sensor_n, np.random.default_rng([seed, number, 5]))
    found = Case(number, stance.name.split()[0], least / best, exact_k / best, [], [], 0, 0.0)
    try:
        for after, slipped, seconds in _rounds(brace, stance, solver, state, None, rng):
            shares = [*found.margin_share, float(margins(world, after.force_n).min()) / best]
            found = replace(found, margin_share=shares, slipped=found.slipped + slipped, seconds=seconds)
        for after, slipped, _ in _rounds(brace, stance, solver, state, wanted, rng):
            off = (np.linalg.norm(after.force_n - wanted, axis=1) / load_n).tolist()
            found = replace(found, off=[*found.off, off], slipped=found.slipped + slipped)
    except (OSError, subprocess.TimeoutExpired, NoStance) as error:
        return replace(found, failed=str(error))
    return found


_solver: Siconos | None = None


def _work(ask: tuple[int, int, Hidden, list[str]]) -> Case | None:
    global _solver  # one of each process
    _solver = _solver or Siconos()
    return case(*ask, _solver)


def run(seed: int, hidden: Hidden, brace: list[str], count: int, jobs: int) -> Iterator[Case]:
    """The first `count` cases of a seed, in order."""
    with ProcessPoolExecutor(jobs) as pool:
        first = found = 0
        while found < count:
            for one in pool.map(_work, [(seed, number, hidden, brace) for number in range(first, first + 4 * jobs)]):
                if one is not None and found < count:
                    found += 1
                    yield one
            first += 4 * jobs


def table(cases: list[Case]) -> str:
    """Lines of text."""
    before = np.median([one.before_share for one in cases])
    exact_k = np.array([one.exact_k_share for one in cases])
    lines = [
        f"smallest margin before: median {before:.2f} of the best of {TRIES}",
        f"K exact, forces read once: at least {GOOD:g} of the best {share((exact_k >= GOOD).tolist())}, median "
        f"{np.median(exact_k):.2f}",
    ]
    for k in range(ROUNDS):
        shares = np.array([one.margin_share[k] if len(one.margin_share) > k else -np.inf for one in cases])
        off = [value for one in cases for value in (one.off[k] if len(one.off) > k else [np.inf])]
        lines += [
            f"round {k + 1}: margin at least {GOOD:g} of the best {share((shares >= GOOD).tolist())}, median "
            f"{np.median(shares):.2f}; force within {NEAR:g} of the load of the wanted one "
            f"{share([value <= NEAR for value in off])}, median {np.median(off):.3f}"
        ]
    seconds = [one.seconds for one in cases if one.seconds]
    lines += [
        f"under {SLOW_S:g} s of processor: {share([value < SLOW_S for value in seconds])}",
        f"feet that slipped while set-points moved: {sum(one.slipped for one in cases)}",
    ]
    return "\n".join(lines + [f"failed: stance {one.number}: {one.failed}" for one in cases if one.failed])


def main() -> int:
    """Exit 4 where Siconos is not installed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--count", type=int, default=50)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--exact", action="store_true", help="nothing is hidden and the sensors have no noise")
    parser.add_argument("--out", type=Path, help="a line of JSON a case")
    options = parser.parse_args()
    try:
        Siconos().close()
    except OSError as error:
        print(error, file=sys.stderr)
        return 4
    hidden = Hidden.none() if options.exact else Hidden(tells_play=True)
    cases: list[Case] = []
    with (options.out or Path("/dev/null")).open("w") as out:
        brace = [str(Path(sys.executable).parent / "brace")]
        for one in run(options.seed, hidden, brace, options.count, options.jobs):
            cases.append(one)
            print(json.dumps(vars(one)), file=out, flush=True)
    print(table(cases))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
