"""What the head of each effect's header says: which numbers its law reads, and what the law depends on.

The law is played, at other temperatures, at other times, from other sides and with other displacements. What moves a
reading is what the head must name. The limb turns by little (small displacements), so that a straight spring shows as
a straight line, and only the effect's own law bends it."""

from __future__ import annotations

import fnmatch
import itertools
import math
import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from brace.effects.catalogue import EFFECTS
from brace.effects.row import Effect
from brace.ground.errors import BraceError
from brace.model import LimbModel, load_limb
from brace.model.keys import KEY_BY_NAME
from brace.native.plant import LoadingPlayer
from command_bench import DATA

HEADERS = Path(__file__).resolve().parents[3] / "host_sim" / "effects"
NO_HEADER = "link_length_error"  # the plant's kinematics is its law
HEAD = re.compile(r"Reads ([^;]+); depends on ([^.]+)\.")
WORDS = {"temperature", "time", "the load", "what came before"}
NOTHING = "nothing else"

MATTERS_N = 0.02  # so much an effect moves some reading, before anybody asks what it depends on
MOVES_N = 1e-5  # a rest is promised to 1e-9 N; what an effect of MATTERS_N depends on moves it by far more
WARMER_DEGC = 10.0  # than the reference: there an effect of temperature acts
PATH_MM = (0.0, 0.4, 0.8, 1.6, 0.8, 0.0, -0.8, -1.6, 0.0)
APART_MM = (0.4, 0.8, 1.6, -0.4, -0.8, -1.6)
CLOCK_S = np.arange(len(PATH_MM)) * 10.0  # long enough for what creeps
AXES = ("dx_mm", "dz_mm")


def head_of(effect: Effect) -> tuple[list[str], set[str]]:
    """The keys that its header says it reads, and the words that say what it depends on."""
    text = (HEADERS / f"{effect.name}.h").read_text().partition("#pragma once")[0]
    found = HEAD.search(re.sub(r"\n// ?", " ", text))
    assert found, f"host_sim/effects/{effect.name}.h: its head lacks a line 'Reads ...; depends on ....'"
    words = set(re.split(r", | and ", found[2])) - {NOTHING}
    assert words <= WORDS, f"host_sim/effects/{effect.name}.h: 'depends on' knows {', '.join(sorted(WORDS))}, {NOTHING}"
    return re.split(r", | and ", found[1]), words


def forces(limb: LimbModel, axis: str, place_mm: tuple[float, ...], t_s: np.ndarray, warmer_degc: float) -> np.ndarray:
    """Readings [N] along x and z where one run moves the tip along an axis; shape (2, places)."""
    still = np.zeros(len(place_mm))
    columns: dict[str, np.ndarray] = {
        "run": np.zeros(len(place_mm), np.int32),
        "theta1_rad": still + 0.5,
        "theta2_rad": still + 1.2,
        "t_s": t_s[: len(place_mm)],
        "temp_degc": still + limb.number("thermal.reference_degc") + warmer_degc,
        "dx_mm": still,
        "dz_mm": still,
    }
    columns[axis] = np.array(place_mm)
    read = LoadingPlayer(columns, small_displacements=True).play(limb)
    return np.stack([read["fx_n"], read["fz_n"]])


def along_both(limb: LimbModel, t_s: np.ndarray = CLOCK_S, warmer_degc: float = WARMER_DEGC) -> np.ndarray:
    """Readings where the tip is moved along PATH_MM, first along x and then along z."""
    return np.concatenate([forces(limb, axis, PATH_MM, t_s, warmer_degc) for axis in AXES])


def is_other(a: np.ndarray, b: np.ndarray) -> bool:
    return float(np.abs(a - b).max()) > MOVES_N


def growing(effect: Effect, limb: LimbModel) -> Iterator[dict[str, float]]:
    """The effect's numbers at its last place, ever further from the limb's; one without a limit comes down from 1e9."""
    place = effect.places[-1]
    keys = {KEY_BY_NAME[number.key(place)]: number for number in effect.numbers}
    numbers = {key: number for key, number in keys.items() if key.kind != "text"}
    endless = [key for key in numbers if math.isinf(limb.number(key.name))]
    for power, fall in itertools.product(range(12), range(25) if endless else (0,)):
        values = {
            key.name: 1e9 / 3.0**fall if key in endless else limb.number(key.name) + number.scale * 3.0**power
            for key, number in numbers.items()
        }
        yield {key.name: min(max(values[key.name], key.low), key.high) for key in numbers}


def with_effect(effect: Effect) -> LimbModel:
    """The paper's limb with so much of the effect that it shows."""
    limb = load_limb(DATA / "paper-limb.toml")
    without = along_both(limb)
    for values in growing(effect, limb):
        try:
            turned = limb.with_values(values)
            if float(np.abs(along_both(turned) - without).max()) > MATTERS_N:
                return turned
        except BraceError:  # so much of it leaves the limb no rest
            continue
    raise AssertionError(f"{effect.name}: none of its numbers {', '.join(effect.keys)} moves a reading")


def played(limb: LimbModel) -> set[str]:
    """What the limb's readings depend on, in the words of the heads."""
    found = set()
    usual = along_both(limb)
    if any(is_other(usual, along_both(limb, warmer_degc=warmer_degc)) for warmer_degc in (0.0, 2.0 * WARMER_DEGC)):
        found.add("temperature")
    if any(is_other(usual, along_both(limb, t_s)) for t_s in (3.0 * CLOCK_S, CLOCK_S + 1e10)):
        found.add("time")
    for axis in AXES:
        there = [forces(limb, axis, (0.0, side_mm, 0.4), CLOCK_S, WARMER_DEGC)[:, -1] for side_mm in (1.6, -1.6)]
        if is_other(there[0], there[1]):
            found.add("what came before")
        ends = {mm: forces(limb, axis, (0.0, mm), CLOCK_S, WARMER_DEGC)[:, -1] for mm in (0.0, *APART_MM)}
        slopes = np.array([(ends[mm] - ends[0.0]) / mm for mm in APART_MM])
        if is_other(slopes.max(axis=0), slopes.min(axis=0)):
            found.add("the load")
    return found


LAWS = [pytest.param(effect, id=effect.name) for effect in EFFECTS if effect.name != NO_HEADER]


@pytest.mark.parametrize("effect", LAWS)
def test_the_head_names_what_the_law_depends_on(effect: Effect) -> None:
    _, said = head_of(effect)
    does = played(with_effect(effect))
    at = f"host_sim/effects/{effect.name}.h: its head says 'depends on {' and '.join(sorted(said)) or NOTHING}'"
    assert said == does, f"{at}, but played, its law depends on {' and '.join(sorted(does)) or NOTHING}"


@pytest.mark.parametrize("effect", LAWS)
def test_the_head_names_the_numbers_that_the_row_turns(effect: Effect) -> None:
    read, _ = head_of(effect)
    at = f"host_sim/effects/{effect.name}.h: its head says 'Reads {', '.join(read)}'"
    unknown = [one for one in read if not fnmatch.filter(KEY_BY_NAME, one)]
    assert not unknown, f"{at}, and limb.toml has no key {', '.join(unknown)}"
    left_out = [key for key in effect.keys if not any(fnmatch.fnmatch(key, one) for one in read)]
    assert not left_out, f"{at}, and its row in effects/catalogue.py turns {', '.join(left_out)} too"


def law_of(effect: Effect) -> str:
    """The text of its header behind the head, without remarks."""
    return re.sub(r"//.*", "", (HEADERS / f"{effect.name}.h").read_text().partition("#pragma once")[2])


def not_in(law: str, read: list[str]) -> list[str]:
    """Those that a head names, and no number of whose kind the law's text has."""
    leaves = {one: {key.rpartition(".")[2] for key in fnmatch.filter(KEY_BY_NAME, one)} for one in read}
    return [one for one in read if not any(re.search(rf"\b{leaf}", law) for leaf in leaves[one])]


@pytest.mark.parametrize("effect", LAWS)
def test_the_head_names_the_numbers_that_the_law_reads(effect: Effect) -> None:
    read, _ = head_of(effect)
    law = law_of(effect)
    at = f"host_sim/effects/{effect.name}.h: its head says 'Reads {', '.join(read)}'"
    used = [f"{table}.{number}" for table, number in re.findall(r"\bmodel\.(\w+)\.(\w+)", law)]
    left_out = {key for key in used if key in KEY_BY_NAME and not any(fnmatch.fnmatch(key, one) for one in read)}
    assert not left_out, f"{at}, and its law reads {', '.join(sorted(left_out))} too"
    assert not not_in(law, read), f"{at}, and its law does not have {', '.join(not_in(law, read))}"


def test_a_head_that_names_too_much_is_seen() -> None:
    (effect,) = [effect for effect in EFFECTS if effect.name == "creep"]
    read, _ = head_of(effect)
    assert not_in(law_of(effect), [*read, "gravity.knee_n", "joint.*.gap_rad"]) == ["gravity.knee_n", "joint.*.gap_rad"]
