"""`brace new`: a limb.toml from what people know; units said, guesses told, nothing asked without a terminal."""

from __future__ import annotations

import io
import json
import math
import tomllib
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from command_bench import Outcome, physics_k

from brace.cli import new_questions
from brace.newlimb.beams import MATERIALS, round_beam
from brace.newlimb.quantity import joint, link, play_rad

Brace = Callable[..., Outcome]
TUBES = (
    "--femur",
    185,
    "--tibia",
    "0.3135m",
    "--femur-link",
    "tube 20 16 aluminium",
    "--tibia-link",
    "rod 12 70GPa",
    "--femur-joint",
    "60 N m/rad",
    "--tibia-joint",
    "1.2 N m/deg",
)
PLAYS = (
    "--femur-play",
    "20arcmin",
    "--tibia-play",
    "0.5deg",
    "--femur-travel",
    "-60deg",
    "90deg",
    "--tibia-travel",
    "10deg",
    "140deg",
)


def test_a_round_beam_by_integration() -> None:
    """Deflection of a cantilever is the integral of (L - x)^2/(E I); twist that of 1/(G J), by numbers."""
    found = round_beam(200.0, 20.0, 16.0, MATERIALS["aluminium"])
    r = np.linspace(8.0, 10.0, 20001)
    second = np.trapezoid(math.pi * r**3, r)  # of a ring: pi r^3 dr
    x = np.linspace(0.0, 200.0, 20001)
    assert found.bending_mm_per_n == pytest.approx(np.trapezoid((200.0 - x) ** 2, x) / (69e3 * second), rel=1e-6)
    assert found.axial_mm_per_n == pytest.approx(200.0 / (69e3 * np.trapezoid(2 * math.pi * r, r)), rel=1e-9)
    assert found.torsion_rad_per_n_mm == pytest.approx(200.0 / (26e3 * np.trapezoid(2 * math.pi * r**3, r)), rel=1e-6)


def test_materials_that_are_alike_in_all_directions_have_a_poisson_ratio_of_such() -> None:
    """G = E / (2 (1 + nu)); metals and plastics have 0.28 to 0.45."""
    for name in MATERIALS.keys() - {"cfrp", "gfrp", "wood"}:
        material = MATERIALS[name]
        assert 0.28 < material.e_gpa / (2.0 * material.g_gpa) - 1.0 < 0.45, name


def test_units_of_gears_and_joints() -> None:
    assert play_rad("20 arcmin") == pytest.approx(0.0058178, rel=1e-4)
    assert play_rad("0.5deg") == pytest.approx(0.0087266, rel=1e-4) and play_rad("0.006 rad") == 0.006
    for text in ("60", "60 N m/rad", "60 Nm/rad", "1.0472 Nm/deg", "1.66667e-5 rad/(N mm)", "1.66667e-2 rad/Nm"):
        assert joint(text).compliance_rad_per_n_mm == pytest.approx(1.66667e-5, rel=1e-4), text
    assert joint("unknown").guessed and joint("rigid").compliance_rad_per_n_mm == 0.0
    assert link("rod 10 steel", 100.0).compliances == link("tube 10 0 200GPa", 100.0).compliances.__class__(
        *round_beam(100.0, 10.0, 0.0, MATERIALS["steel"]).__dict__.values()
    )


def test_tubes_give_the_k_of_beams(brace: Brace, tmp_path: Path) -> None:
    out = tmp_path / "limb.toml"
    told = json.loads(brace("new", "--out", out, *TUBES, *PLAYS, "--json").out)
    femur, tibia = (
        round_beam(185.0, 20.0, 16.0, MATERIALS["aluminium"]),
        round_beam(313.5, 12.0, 0.0, MATERIALS["aluminium"]),
    )
    soft = {"axial": 313.5 / (70e3 * math.pi * 36.0), "bending": tibia.bending_mm_per_n * 69.0 / 70.0}
    k = physics_k(
        told["theta1_rad"],
        told["theta2_rad"],
        axial=(femur.axial_mm_per_n, soft["axial"]),
        bending=(femur.bending_mm_per_n, soft["bending"]),
        joint=(1e-3 / 60.0, 1e-3 / (1.2 * 180 / math.pi)),
        moment_transfer=1.0,
    )
    assert told["k_xx_n_per_mm"] == pytest.approx(k[0, 0], rel=1e-4)
    assert told["k_zz_n_per_mm"] == pytest.approx(k[1, 1], rel=1e-4)
    assert 0.0 < told["sigma_k_xx_n_per_mm"] < told["k_xx_n_per_mm"]
    limb = tomllib.loads(out.read_text())
    assert limb["joint"]["tibia"]["gap_rad"] == pytest.approx(math.radians(0.5), rel=1e-5)
    assert limb["motor"]["femur"]["angle_min_rad"] == pytest.approx(-math.pi / 3, rel=1e-5)
    at = ("--theta1", told["theta1_rad"], "--theta2", told["theta2_rad"])
    again = json.loads(brace("k", "--model", out, *at, "--json").out)
    assert again["k_xx_n_per_mm"] == pytest.approx(told["k_xx_n_per_mm"], rel=1e-5)
    assert brace("params", "pack", "--model", out, "--out", tmp_path / "limb.bin").code == 0


def test_guesses_are_told_in_words_and_in_the_file(brace: Brace, tmp_path: Path) -> None:
    out = tmp_path / "limb.toml"
    given = [text if text != "1.2 N m/deg" else "unknown" for text in TUBES]
    told = brace("new", "--out", out, *given)
    assert told.code == 0 and "joint.tibia: a servo of 60 N m/rad is a guess" in told.out
    assert "play of femur and tibia: not given" in told.out and "may be off by 50 %" in told.out
    text = out.read_text()
    assert "A GUESS" in text and "# gap_rad = 0.0" in text and "compliance_rel = 0.5" in text


def test_a_limb_that_nothing_lets_yield_is_refused_by_its_file(brace: Brace, tmp_path: Path) -> None:
    rigid = [part for name in ("femur", "tibia") for part in (f"--{name}-link", "rigid", f"--{name}-joint", "rigid")]
    out = tmp_path / "limb.toml"
    refused = brace("new", "--out", out, "--femur", 185, "--tibia", 313, *rigid)
    assert refused.code == 3 and f"{out}:" in refused.err and "nothing in this limb yields" in refused.err, refused.err
    assert not out.exists()


def test_without_a_terminal_the_missing_options_are_named(brace: Brace, tmp_path: Path) -> None:
    outcome = brace("new", "--out", tmp_path / "limb.toml", *TUBES[:6])
    assert outcome.code == 2 and "missing: --tibia-link, --femur-joint, --tibia-joint" in outcome.err
    assert not (tmp_path / "limb.toml").exists()


@pytest.mark.parametrize(
    ("option", "value", "words"),
    [
        ("--femur", "0.185", "185 if it was in metres"),
        ("--femur", "185 parsec", "not a unit of length"),
        ("--femur-link", "tube 16 20 aluminium", "not smaller than the outer"),
        ("--femur-link", "tube 0.02 0.016 aluminium", "if it was in metres"),
        ("--femur-link", "tube 20 16 alumium", "did you mean alumin"),
        ("--femur-link", "tub 20 16 steel", "did you mean tube"),
        ("--femur-link", "tube 20 16 70000GPa", "70000MPa"),
        ("--femur-link", "measured 60", "0.06 if it was in um/N"),
        ("--femur-joint", "60000", None),
        ("--femur-joint", "0.00002", "is the unit right"),
        ("--femur-play", "0.5", "in which unit"),
        ("--femur-play", "20deg", "20arcmin"),
        ("--femur-play", "20mas", "'mas' is not a unit of angle"),
        ("--femur-joint", "unbekannt", "e.g. '60 N m/rad', or: unknown"),
        ("--femur-play", "20,5arcmin", "point"),
        ("--femur-travel", ("-60", "90"), "in which unit"),
        ("--femur-travel", ("90deg", "-60deg"), "the smaller angle comes first"),
        ("--femur-travel", ("-60rad", "90rad"), "more than a turn"),
    ],
)
def test_what_cannot_be_is_refused_with_the_likely_unit(
    brace: Brace, tmp_path: Path, option: str, value: str | tuple[str, str], words: str | None
) -> None:
    options = [*TUBES, option, *((value,) if isinstance(value, str) else value)]
    outcome = brace("new", "--out", tmp_path / "limb.toml", *options)
    if words is None:
        assert outcome.code == 0
        return
    assert outcome.code == 2 and words in outcome.err and f"{option}:" in outcome.err, outcome.err


def test_a_limb_that_is_there_is_not_overwritten(brace: Brace, tmp_path: Path) -> None:
    out = tmp_path / "limb.toml"
    assert brace("new", "--out", out, *TUBES).code == 0
    again = brace("new", "--out", out, *TUBES)
    assert again.code == 2 and "not overwritten" in again.err


def test_questions_at_a_terminal(brace: Brace, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(new_questions, "has_terminal", lambda: True)
    answers = [
        "0.185",
        "185",
        "313.5",
        "tube 20 16",
        "tube 20 16 alu",
        "'rod 12 cfrp'",
        "",  # asked again: only play and travel may stay open
        "unknown",
        "60",
        "20arcmin",
        "",
        "-60deg 90deg",
        "",
    ]
    monkeypatch.setattr("sys.stdin", io.StringIO("\n".join(answers) + "\n"))
    out = tmp_path / "limb.toml"
    done = brace("new", "--out", out)
    assert done.code == 0, done.err
    assert done.err.count("empty: unknown") == 4
    assert "The femur's length" in done.err and "if it was in metres" not in done.out
    limb = tomllib.loads(out.read_text())
    assert limb["geometry"]["femur_mm"] == 185.0 and "tibia" not in limb["motor"]
    assert limb["motor"]["femur"]["angle_max_rad"] == pytest.approx(math.pi / 2, rel=1e-5)


URDF = """<robot name="leg">
<link name="base"/><link name="a"><visual><geometry><mesh filename="package://x/a.stl"/></geometry></visual></link>
<link name="b"/><link name="c"/><link name="foot"/>
<joint name="yaw" type="revolute"><parent link="base"/><child link="a"/><origin xyz="0.1 0.02 0" rpy="0 0 {yaw}"/>
<axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="8" velocity="1"/></joint>
<joint name="hip" type="revolute"><parent link="a"/><child link="b"/><origin xyz="0.057 0 0" rpy="0 {down} 0"/>
<axis xyz="0 {hip} 0"/><limit lower="-1.2" upper="1.5" effort="8" velocity="1"/></joint>
<joint name="knee" type="revolute"><parent link="b"/><child link="c"/><origin xyz="0.185 0 0"/>
<axis xyz="0 {knee} 0"/><limit lower="0.2" upper="2.4" effort="8" velocity="1"/></joint>
<joint name="tip" type="fixed"><parent link="c"/><child link="foot"/><origin xyz="0.3135 0 0"/></joint></robot>"""


@pytest.mark.parametrize(
    ("yaw", "down", "hip", "knee", "theta1", "theta2"),
    [
        (0.0, 0.0, -1, 1, (-1.2, 1.5), (0.2, 2.4)),
        (1.1, 0.0, 1, 1, (-1.5, 1.2), (0.2, 2.4)),  # the hip counts the other way; the leg stands aside
        (0.0, 0.3, -1, -1, (-1.5, 1.2), (-2.4, -0.2)),  # the leg hangs at zero; the knee bends down
    ],
)
def test_a_urdf_gives_lengths_and_travel(
    brace: Brace,
    tmp_path: Path,
    yaw: float,
    down: float,
    hip: int,
    knee: int,
    theta1: tuple[float, float],
    theta2: tuple[float, float],
) -> None:
    pytest.importorskip("mujoco")
    robot = tmp_path / "leg.urdf"
    robot.write_text(URDF.format(yaw=yaw, down=down, hip=hip, knee=knee))
    out = tmp_path / "limb.toml"
    given = [*TUBES[4:], "--coxa-joint", "60"]
    done = brace("new", "--out", out, "--urdf", robot, *given)
    assert done.code == 0, done.err
    limb = tomllib.loads(out.read_text())
    assert limb["geometry"] == pytest.approx({"coxa_mm": 57.0, "femur_mm": 185.0, "tibia_mm": 313.5}, abs=1e-3)
    for joint_name, travel in (("femur", theta1), ("tibia", theta2)):
        motor = limb["motor"][joint_name]
        assert (motor["angle_min_rad"], motor["angle_max_rad"]) == pytest.approx(travel, abs=1e-4), joint_name


def test_a_robot_without_such_a_leg_is_refused(brace: Brace, tmp_path: Path) -> None:
    pytest.importorskip("mujoco")
    robot = tmp_path / "arm.urdf"
    for text, words in (
        ("<robot", "no URDF"),
        ('<robot name="x"><link name="base"/></robot>', "0 chains"),
        (URDF.format(yaw=0, down=0, hip=1, knee=1).replace('xyz="0 1 0"', 'xyz="1 0 0"', 1), "one plane"),
        (
            URDF.format(yaw=0, down=0, hip=1, knee=1).replace('lower="0.2" upper="2.4"', 'lower="2.4" upper="0.2"'),
            "lower 2.4 is above upper 0.2",
        ),
        (
            URDF.format(yaw=0, down=0, hip=1, knee=1).replace('lower="0.2" upper="2.4"', 'lower="10" upper="140"'),
            "in degrees they would be 0.1745 and 2.443",
        ),
        (
            URDF.format(yaw=0, down=0, hip=1, knee=1).replace('xyz="0.3135 0 0"', 'xyz="313.5 0 0"'),
            "313.5 mm are 0.3135 there",
        ),
    ):
        robot.write_text(text)
        outcome = brace("new", "--out", tmp_path / "limb.toml", "--urdf", robot, *TUBES[4:])
        assert outcome.code == 3 and words in outcome.err, outcome.err
