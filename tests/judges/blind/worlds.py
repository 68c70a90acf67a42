"""Where cases come from: the simulator here, or the physics engine of tests/judges/engine. A world plays limbs and plans
tests; all else is shared."""

from __future__ import annotations

import argparse
import importlib
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import outsiders
import seeds
from designs import Design, Play, Rng, Trust, believed_limb, loading_test, trust
from detect import Bench
from outsiders import Outsider
from plant import Array, play
from scoring import Judged

ENGINE = str(Path(__file__).resolve().parents[1] / "engine")
OF_THE_ENGINE = ("engine", "finite")
Setting = tuple[Array, Trust, Design, Design, tuple[str, ...]]


def _as_it_is(p: Array, _names: Sequence[str]) -> Array:
    return p


def _nothing_besides(_rng: Rng, p: Array, _names: Sequence[str]) -> tuple[Array, dict[str, Any]]:
    return p, {}


def _nothing_judged(_root: Path, _name: str, _out: Path) -> None:
    return


@dataclass(frozen=True)
class World:
    """All in which cases of two worlds differ."""

    name: str
    play: Play
    setting: Callable[[Rng, Sequence[str]], Setting]
    """For effects that will be hidden: believed limb, its trust, the test shown and the one held back, and keys that
    limb.toml leaves out."""
    bench: Callable[[Design, Array, Trust], Bench]
    outsiders: tuple[str, ...]
    draw_outsider: Callable[..., Outsider]
    sources: tuple[Path, ...]  # what makes its cases beside the shared files
    development_seed: int
    test_seed: int
    development_cases: int | str
    test_cases: int | str
    page: str  # name of its page and figures
    prefix: str = ""  # of its folders' names
    classes: bool = True  # whether look-alikes of an effect are sought
    lacking: Callable[[Array, Sequence[str]], Array] = _as_it_is  # a believed limb that has not what will be hidden
    besides: Callable[[Rng, Array, Sequence[str]], tuple[Array, dict[str, Any]]] = _nothing_besides
    """A true limb, perhaps with something more that goes with its hidden effects; what the answer says of that."""
    disguised: tuple[tuple[str, tuple[str, ...]], ...] = ()  # outsiders, and the entries they cannot be distinguished from
    whole_beams: float = 0.5  # share of strong moment transfers that are a beam's
    least_whole_beam_s: float = 0.0
    displacements: str = "finite"  # small: its limb does not turn as it is displaced
    reported_cases: int = seeds.REPORTED_CASES
    follows_up: bool = True  # next experiments, repeats and baselines are run
    judge_besides: Callable[[Path, str, Path], None] = _nothing_judged  # set, case, and the folder of its diagnosis
    report: Callable[[list[Judged], dict[str, Any], str], tuple[str, str, dict[str, Any]]] | None = None
    """Table, page and figures of its own of judged cases, what made them, and the command."""

    def seed_and_cases(self, seed: int | None, cases: int | str | None, development: bool) -> tuple[int, int | str]:
        """What a command line means."""
        usual = (self.development_seed, self.development_cases) if development else (self.test_seed, self.test_cases)
        return seed if seed is not None else usual[0], cases or usual[1]


def _simulated(rng: Rng, _names: Sequence[str]) -> Setting:
    believed = believed_limb(rng)
    given = trust(rng)
    return believed, given, *loading_test(rng, believed), ()


SIMULATOR = World(
    "simulator",
    play,
    _simulated,
    Bench,
    outsiders.KINDS,
    outsiders.draw,
    (Path(__file__).with_name("simulator.c"),),
    seeds.DEVELOPMENT_SEED,
    seeds.TEST_SEED,
    seeds.DEVELOPMENT_CASES,
    seeds.TEST_CASES,
    "blind",
    displacements="small",
)


def world_called(name: str) -> World:
    """A world by its name."""
    if name == SIMULATOR.name:
        return SIMULATOR
    if ENGINE not in sys.path:
        sys.path.append(ENGINE)
    found: World = importlib.import_module(f"{name}_world").WORLD
    return found


def options_of_world(parser: argparse.ArgumentParser) -> None:
    """What says in which world to be; the simulator where nothing does."""
    says = {
        "engine": "limbs of beams in the physics engine of tests/judges/engine, strokes up to 2.54 mm",
        "finite": "the simulator's limbs and effects played by that engine, which turns them as they are displaced",
    }
    for name in OF_THE_ENGINE:
        parser.add_argument(
            f"--{name}", dest="world", action="store_const", const=name, default=SIMULATOR.name, help=says[name]
        )
