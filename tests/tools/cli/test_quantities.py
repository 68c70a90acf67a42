"""Numbers with units, in every option of every command that takes a quantity; and command lines that lack something."""

from __future__ import annotations

import argparse
import json
import math
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from command_bench import LIMB, Outcome

from brace.cli.bus_options import bit_rate
from brace.cli.command_line import build_parser
from brace.cli.options import Quantity, RefusedValue
from brace.ground.units import OWN, UNITS

Brace = Callable[..., Outcome]
IN_UNITS = ("N", "MM", "RAD", "S", "DEGC", "N_PER_MM", "MU", "RATIO", "LOW", "HIGH", "FX", "FZ", "DX", "DZ", "XX", "Y")
COUNTS = ("N",)  # metavars that stand for a count, too


def actions(parser: argparse.ArgumentParser, name: str) -> Iterator[tuple[str, argparse.Action]]:
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for below, sub in action.choices.items():
                yield from actions(sub, f"{name} {below}".strip())
        else:
            yield name, action


ALL = [
    (f"{command} {'/'.join(action.option_strings) or action.dest}", action)
    for command, action in actions(build_parser(), "")
]
QUANTITIES = {name: action.type for name, action in ALL if isinstance(action.type, Quantity)}


def refused(kind: Quantity, text: str) -> RefusedValue:
    with pytest.raises(RefusedValue) as caught:
        kind(text)
    return caught.value


@pytest.mark.parametrize("name", QUANTITIES)
def test_with_a_unit_without_one_and_in_a_wrong_one(name: str) -> None:
    kind = QUANTITIES[name]
    value = kind(kind.example)
    plain = f"{value!r}"
    assert kind(plain) == value  # a number alone is in our unit
    for unit, (factor, offset) in kind.units.items():
        written = f"{(value - offset) / factor!r}{unit}"
        assert kind(written) == pytest.approx(value, rel=1e-12), written
    for wrong in (unit for of, unit in OWN.items() if of != kind.of):
        said = refused(kind, f"{plain}{wrong}")
        assert UNITS[wrong].quantity in said.what and kind.of in said.why and (kind.own or "%") in said.why
        assert said.way == f"OPTION {kind.example}"
    for nothing in ("", "much", "nan", "1e999", f"{plain}furlong", "1,5"):
        said = refused(kind, nothing)
        assert said.why and "OPTION" in said.way


def test_every_option_that_names_a_unit_takes_it() -> None:
    assert len(QUANTITIES) > 50
    for name, action in ALL:
        metavars = action.metavar if isinstance(action.metavar, tuple) else (action.metavar,)
        counts = getattr(action.type, "__name__", "") in ("parse", "_node")  # brace.cli.options.count, a node's number
        if name.startswith("new "):  # it reads these texts as it reads answers at a terminal: test_new_command.py
            continue
        if set(metavars) & set(IN_UNITS) and not (counts and set(metavars) <= set(COUNTS)):
            assert isinstance(action.type, Quantity), name
        assert action.type is not float, name


@pytest.mark.parametrize(
    ("option", "written", "ours"),
    [
        ("--fz", "10N", 10.0),
        ("--fz", "1kg", 9.80665),
        ("--fz", "-1kgf", -9.80665),
        ("--theta1", "30deg", math.pi / 6),
        ("--theta1", "-30 deg", -math.pi / 6),
        ("--theta1", "1800arcmin", math.pi / 6),
        ("--temp", "300K", 26.85),
        ("--temp", "86degF", 30.0),
    ],
)
def test_k_is_the_same(brace: Brace, tmp_path: Path, option: str, written: str, ours: float) -> None:
    limb = tmp_path / "limb.toml"
    limb.write_text(LIMB + "[thermal]\njoint_compliance_per_degc = 0.01\n")
    rest = [] if option == "--theta1" else ["--theta1", 1.0]
    line = ("k", "--model", limb, *rest, "--theta2", 1.4, "--json", option)
    told = [json.loads(brace(*line, value).out)["k_xx_n_per_mm"] for value in (written, ours)]
    assert told[0] == pytest.approx(told[1], rel=1e-6)  # a step of float32


def test_a_plan_in_units(brace: Brace, tmp_path: Path) -> None:
    limb = tmp_path / "limb.toml"
    limb.write_text(LIMB)
    few = ("plan", "--model", limb, "--places", 300)
    in_units = brace(*few, "--payload", "1kg", "--friction", "50%", "--x", "10cm", "0.4m", "--normal", "90deg")
    plain = brace(*few, "--payload", 9.80665, "--friction", 0.5, "--x", 100, 400, "--normal", math.pi / 2)
    assert in_units.code == 0 and in_units.out == plain.out and "they are the weight of 1 kg" in plain.out
    refused = brace(*few, "--payload", 1000, "--sag-most", "0.01mm")
    assert refused.code == 1 and "--payload below 1000N, the weight of 102 kg" in refused.err


@pytest.mark.parametrize(
    ("line", "completed"),
    [
        (("k",), "brace k --model limb.toml"),
        (("k", "mine.toml", "--theta1", "1"), "brace k --model mine.toml --theta1 1"),
        (("take-up",), "brace take-up femur+ --bus can0"),
        (("take-up", "femur+"), "brace take-up femur+ --bus can0"),
        (("take-up", "--bus", "can0", "knee+"), "brace take-up tibia+"),
        (("simulate", "--model", "a b.toml"), "brace simulate --model 'a b.toml' --rig rig.toml --out out"),
        (("diagnose",), "brace diagnose DATASET --out out"),
        (("k", "--model"), "--model limb.toml"),
        (("k", "--model", "limb.toml", "--fz"), "--fz 10N"),
        (("k", "--model", "limb.toml"), "brace k --model limb.toml --theta1 0.5 --theta2 1.2"),
        (("plan", "--model", "limb.toml", "--friction", "10deg"), "--friction 50%"),
    ],
)
def test_what_lacks_is_completed(brace: Brace, line: tuple[str, ...], completed: str) -> None:
    done = brace(*line)
    assert done.code == 2 and completed in done.err and "--help" not in done.err


@pytest.mark.parametrize("text", ["500000", "500k", "500K", "500kbit/s", "500 kbps", "0.5M", "0.5Mbit/s", "5e5"])
def test_a_bit_rate_in_its_units(text: str) -> None:
    assert bit_rate(text) == 500000


@pytest.mark.parametrize("text", ["500", "2M", "fast", "500kHz", "-1k", "nan", ""])
def test_a_bit_rate_that_is_none_is_refused(text: str) -> None:
    with pytest.raises(RefusedValue) as caught:
        bit_rate(text)
    assert "OPTION 500k" in caught.value.way
