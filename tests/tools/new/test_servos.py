"""Servos by name in `brace new`: from three names to K with its uncertainty, and one list for everybody."""

from __future__ import annotations

import json
import math
import re
import tomllib
from collections.abc import Callable
from pathlib import Path

import pytest
from command_bench import PROJECT, Outcome

from brace.ground.errors import UsageError
from brace.model.servos import held, servos
from brace.newlimb.quantity import joint
from brace.sim.servos import MODELS

Brace = Callable[..., Outcome]
LINKS = ("--femur", 185, "--tibia", 313.5, "--femur-link", "tube 20 16 aluminium", "--tibia-link", "tube 16 14 cfrp")


def stiffness(text: str) -> float:
    """N m/rad"""
    return 1e-3 / joint(text).compliance_rad_per_n_mm


def test_three_names_to_k_in_one_command(brace: Brace, tmp_path: Path) -> None:
    limb = tmp_path / "limb.toml"
    names = ("--coxa-joint", "XM430-W350", "--femur-joint", "MX-106", "--tibia-joint", "XM540-W270 P1600")
    coxa = ("--coxa", 57, "--coxa-link", "rigid")
    done = brace("new", "--out", limb, *LINKS, *coxa, *names)
    assert done.code == 0, done.err
    assert re.search(r"k_xx [\d.]+ \+- [\d.]+, k_xz -[\d.]+ \+- [\d.]+, k_zz [\d.]+ \+- [\d.]+", done.out)
    assert "XM430-W350" in done.out and "is a guess, +- 40 %" in done.out and "emanual.robotis.com" in done.out
    written, text = tomllib.loads(limb.read_text()), limb.read_text()
    assert written["uncertainty"]["compliance_rel"] == 0.4  # of the least known joint that matters
    assert written["joint"]["femur"]["gap_rad"] == pytest.approx(math.radians(20 / 60), rel=1e-5)
    assert "XM430-W350 at position P gain 800 as delivered and 12 V: 18.9 N m/rad, A GUESS" in text
    assert written["motor"]["femur"]["friction_n_mm"] == 122.0 and "friction_n_mm" not in written["motor"]["tibia"]
    k = brace("k", "--model", limb, "--theta1", 0.5, "--theta2", 1.2, "--json")
    assert json.loads(k.out)["sigma_k_xx_n_per_mm"] > 0.0


@pytest.mark.parametrize("name", servos())
def test_every_servo_makes_a_limb_that_a_controller_takes(brace: Brace, tmp_path: Path, name: str) -> None:
    limb = tmp_path / "limb.toml"
    assert brace("new", "--out", limb, *LINKS, "--femur-joint", name, "--tibia-joint", name).code == 0
    done = brace("params", "pack", "--model", limb, "--out", tmp_path / "block.bin")
    assert done.code == 0, done.err


def test_stiffness_is_what_others_measured() -> None:
    """An MX-106 at its gain was measured at 54 to 66 N m/rad (docs/physics.md); an XM430 is nearer to 19."""
    assert 54.0 < stiffness("MX-106") < 66.0
    assert stiffness("XM430-W350") == pytest.approx(800 / 128 / 885 * 4096 / (2 * math.pi) * 4.1, rel=1e-9)
    assert joint("XM430-W350").sigma_rel > joint("MX-106").sigma_rel


def test_stiffness_follows_gain_and_supply() -> None:
    for name in servos():
        servo = servos()[name]
        doubled = f"{name} P{2 * servo.position_p_gain}"
        assert stiffness(doubled) == pytest.approx(2 * stiffness(name))
        more = f"{name} {1.2 * servo.supply_v:g}V P{servo.position_p_gain}"
        assert stiffness(more) == pytest.approx(1.2 * stiffness(name))


@pytest.mark.parametrize("text", ["xm430-w350", "XM430W350", "XM430-W350-T", "XM430-W350-R", "xm430_w350"])
def test_a_name_as_people_write_it(text: str) -> None:
    found = held(text)
    assert found is not None and found.servo.name == "XM430-W350"
    assert held("MX-106T") == held("MX106R") == held("mx-106")


@pytest.mark.parametrize(
    ("text", "way"),
    [
        ("XM430-W351", "did you mean XM430-W350?"),
        ("AX-12A", "'60 N m/rad', or: unknown"),
        ("XM430-W350 1200", "'XM430-W350 P800 12V'"),
        ("XM430-W350 P0", "'XM430-W350 P800', as delivered"),
        ("XM430-W350 24V", "'XM430-W350 12V'"),
        ("MX-106 60 N m/rad", "'MX-106 P850 12V'"),
    ],
)
def test_what_no_servo_has_is_refused(text: str, way: str) -> None:
    with pytest.raises(UsageError) as refused:
        joint(text)
    assert way in str(refused.value.next_step)


def test_a_play_that_is_said_counts_more_than_the_manual(brace: Brace, tmp_path: Path) -> None:
    limb = tmp_path / "limb.toml"
    names = ("--femur-joint", "MX-106", "--tibia-joint", "MX-106", "--femur-play", "none", "--tibia-play", "unknown")
    assert brace("new", "--out", limb, *LINKS, *names).code == 0
    gaps = {name: table["gap_rad"] for name, table in tomllib.loads(limb.read_text())["joint"].items()}
    assert gaps == {"femur": 0.0, "tibia": pytest.approx(math.radians(20 / 60), rel=1e-5)}


def test_unknown_stays() -> None:
    guess = joint("unknown")
    assert guess.guessed and guess.sigma_rel == 0.5 and stiffness("unknown") == pytest.approx(60.0)


@pytest.mark.parametrize(
    ("text", "n_m_per_rad"),
    [
        ("60", 60.0),
        ("60 Nm/rad", 60.0),
        ("60N m/rad", 60.0),
        ("1 N m/deg", 180 / math.pi),
        ("0.5 Nm/arcmin", 0.5 * 10800 / math.pi),
        ("10 kgf cm/deg", 10 * 0.0980665 * 180 / math.pi),
        ("10 kg cm/deg", 10 * 0.0980665 * 180 / math.pi),
        ("100 oz in/deg", 100 * 0.00706155 * 180 / math.pi),
        ("20 lbf in/deg", 20 * 0.1129848 * 180 / math.pi),
        ("1.6e-5 rad/(N mm)", 62.5),
        ("0.9 deg/(N m)", 180 / math.pi / 0.9),
        ("60000 N mm/rad", 60.0),
    ],
)
def test_units_of_datasheets(text: str, n_m_per_rad: float) -> None:
    assert stiffness(text) == pytest.approx(n_m_per_rad, rel=1e-6)


def test_one_list_for_everybody() -> None:
    """The driver's table is generated (test_interface.py sees drift); the page says the same numbers."""
    assert MODELS == {name: servo.number for name, servo in servos().items()}
    page = (PROJECT / "docs" / "joints.md").read_text()
    table = page.split("| model | number | current's step | torque by current |")[1].split("\n\n")[0]
    for name, servo in servos().items():
        family = name.rpartition("-")[0] if name.startswith("X") else name
        (row,) = (line for line in table.splitlines() if family in line and str(servo.number) in line)
        assert f"{servo.current_step_ma:g} mA" in row
        assert str(round(1e3 * servo.stall_torque_n_m / servo.stall_current_a)) in row
    for name in ("MX-106", "MX-64"):
        fit = servos()[name].fit
        assert fit is not None
        (heads,) = re.findall(r"^\| key \|.*$", page, re.M)
        column = [cell.strip() for cell in heads.split("|")].index(name)
        for key in ("friction_n_mm", "friction_per_torque_ratio", "friction_per_load_ratio", "torque_gain_rel"):
            (row,) = re.findall(rf"^\| `{key}`.*$", page, re.M)
            assert float(row.split("|")[column]) == getattr(fit, key), key
