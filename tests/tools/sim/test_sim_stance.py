"""`brace sim --stance`: the command, its file of the truth, what happens to the robot, what is refused; beside
`brace stance` and beside limbs that stand alone."""

from __future__ import annotations

import csv
import json
import shutil
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command_bench import PROJECT, Outcome

from brace.sim.node import LimbSetup, Node
from brace.sim.robot import Robot
from brace.stance.simulated import SERVO_N_MM_PER_RAD, SimulatedStance
from brace.stance.stance_file import load_stance

EXAMPLE = PROJECT / "examples" / "stance"
NO_PORTS = ("--can", "none", "--modbus", "none", "--fast")
NAMES = ["front left", "front right", "rear left", "rear right"]
BORNE_N = 30.0 + 4 * 1.7 + 2.0  # body, limbs, payload downwards


@pytest.fixture
def stance(tmp_path: Path) -> Path:
    for name in ("stance.toml", "limb.toml"):
        shutil.copy(EXAMPLE / name, tmp_path / name)
    return tmp_path / "stance.toml"


def events(outcome: Outcome, kind: str) -> list[Any]:
    assert outcome.code == 0, outcome.err
    lines = [json.loads(line) for line in outcome.out.splitlines()]
    return [line for line in lines if line["event"] == kind]


def forces(truth: dict[str, Any]) -> np.ndarray:
    return np.array([limb["force_n"] for limb in truth["limbs"]])


def test_the_feet_bear_what_the_statics_say(brace: Callable[..., Outcome], stance: Path) -> None:
    """Both know everything: their mechanics share no code. 0.1 % of the weight: the statics are of first order."""
    ran = brace("sim", "--stance", stance, *NO_PORTS, "--seconds", 3, "--payload", "2@0.5+1", "--json")
    truths = events(ran, "truth")
    assert [round(one["truth"]["time_s"]) for one in truths] == [0, 1, 2, 3]
    (end,) = events(ran, "end")
    text = stance.read_text().replace("force_n = [4.0, 0.0, -2.0]", "force_n = [8.0, 0.0, -4.0]")
    stance.write_text(text)
    estimated = json.loads(brace("stance", "load", stance, "--draws", 20, "--json").out)
    assert forces(end["truth"]) == pytest.approx(forces(estimated), abs=0.001 * BORNE_N)
    assert forces(end["truth"]).sum(axis=0) == pytest.approx([-8.0, 0.0, BORNE_N + 2.0], abs=0.02)  # the body tilts
    assert [limb["name"] for limb in end["truth"]["limbs"]] == NAMES
    before = forces(truths[0]["truth"])
    assert before.sum(axis=0) == pytest.approx([0.0, 0.0, BORNE_N - 2.0], abs=0.02)
    change = forces(estimated["change"])
    assert forces(end["truth"]) - before == pytest.approx(change, abs=0.001 * BORNE_N)
    assert truths[1]["truth"]["payload_factor"] == pytest.approx(1.0, abs=0.01)


def test_each_limb_has_its_controller_and_node(brace: Callable[..., Outcome], stance: Path) -> None:
    stance.write_text(stance.read_text().replace('name = "rear left"', 'name = "rear left"\nnode = 17'))
    (ready,) = events(brace("sim", "--stance", stance, *NO_PORTS, "--seconds", 0.1, "--json"), "ready")
    assert [(limb["name"], limb["node"]) for limb in ready["limbs"]] == list(zip(NAMES, [1, 2, 17, 4]))
    words = brace("sim", "--stance", stance, *NO_PORTS, "--seconds", 0.1)
    assert words.out.startswith("limb 1 (front left): node 1, no ports\n") and "front left   x" in words.out


def test_the_truth_at_100_hz(brace: Callable[..., Outcome], stance: Path, tmp_path: Path) -> None:
    path = tmp_path / "truth.csv"
    ran = brace("sim", "--stance", stance, *NO_PORTS, "--seconds", 1, "--payload", "3@0.2", "--truth", path)
    assert ran.code == 0, ran.err
    with path.open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 4 * 101 and list(rows[0])[:6] == ["t_s", "limb", "fx_n", "fy_n", "fz_n", "state"]
    assert [row["limb"] for row in rows[:4]] == NAMES
    assert [float(row["t_s"]) for row in rows[::4]] == pytest.approx(np.arange(101) / 100)
    down = [sum(float(row["fz_n"]) for row in rows[i : i + 4]) for i in (0, 400)]
    assert down == pytest.approx([BORNE_N - 2.0, BORNE_N + 4.0], abs=0.05)
    assert float(rows[-1]["payload_factor"]) == 3.0 and float(rows[-1]["body_x_mm"]) > 0.5
    # the rows from one time are a measured file of `brace stance`
    measured = tmp_path / "m.csv"
    measured.write_text("\n".join([",".join(rows[0]), *(",".join(row.values()) for row in rows[:4])]) + "\n")
    found = json.loads(brace("stance", "load", stance, "--measured", measured, "--draws", 20, "--json").out)
    assert "measured_unbalanced" not in " ".join(found["flags"])


def test_what_is_believed_is_not_what_is_true(brace: Callable[..., Outcome], stance: Path, tmp_path: Path) -> None:
    true = tmp_path / "true"
    true.mkdir()
    limb = (tmp_path / "limb.toml").read_text()
    (true / "limb.toml").write_text(limb)
    joint = "[joint.femur]\ncompliance_rad_per_n_mm = "
    soft = limb.replace(joint + "1e-5", joint + "4e-5")
    assert soft != limb
    (true / "soft.toml").write_text(soft)
    head, _, tail = stance.read_text().partition('model = "limb.toml"')
    (true / "true.toml").write_text(head + 'model = "soft.toml"' + tail)
    run = ("sim", "--stance", stance, *NO_PORTS, "--seconds", 0.2, "--json")
    exact, other = (events(brace(*run, *more), "end")[0] for more in ((), ("--stance-plant", true / "true.toml")))
    assert forces(other["truth"])[0][2] < forces(exact["truth"])[0][2] - 0.2  # front left gives way
    assert other["limbs"][0]["k_zz_n_per_mm"] == pytest.approx(exact["limbs"][0]["k_zz_n_per_mm"], rel=0.05)
    higher = stance.read_text().replace("[limb.foothold]", "[limb.foothold]\noffset_mm = [0.0, 0.0, 1.0]", 1)
    (true / "higher.toml").write_text(higher)
    (moved,) = events(brace(*run, "--stance-plant", true / "higher.toml"), "end")
    assert forces(moved["truth"])[0][2] > forces(exact["truth"])[0][2] + 0.5


def test_zeros_that_are_wrong_act_as_footholds_that_are(
    brace: Callable[..., Outcome], stance: Path, tmp_path: Path
) -> None:
    true = tmp_path / "true"
    true.mkdir()
    limb = (tmp_path / "limb.toml").read_text()
    (true / "limb.toml").write_text(limb)
    (true / "zero.toml").write_text(limb.replace("[joint.femur]", "[joint.femur]\nzero_offset_rad = 0.01"))
    head, _, tail = stance.read_text().partition('model = "limb.toml"')
    (true / "true.toml").write_text(head + 'model = "zero.toml"' + tail)
    run = ("sim", "--stance", stance, *NO_PORTS, "--seconds", 0.2, "--json")
    exact, other = (events(brace(*run, *more), "end")[0] for more in ((), ("--stance-plant", true / "true.toml")))
    lacks = forces(other["truth"])[0][2] - forces(exact["truth"])[0][2]
    assert lacks < -0.5  # a femur that stands higher lifts its tip off the ground where it was believed


def test_a_lifted_foot_and_a_moved_limb(brace: Callable[..., Outcome], stance: Path) -> None:
    stance.write_text(stance.read_text().replace("com_mm = [0.0, 0.0, 0.0]", "com_mm = [-40.0, 0.0, 0.0]"))
    run = ("sim", "--stance", stance, *NO_PORTS, "--json", "--payload", "0")
    lifted = brace(*run, "--seconds", 5, "--lift", "front left@1+2")
    truths = [one["truth"] for one in events(lifted, "truth")]
    assert [one["limbs"][0]["state"] for one in truths] == ["sticks", "sticks", "open", "open", "sticks", "sticks"]
    assert forces(truths[2])[0] == pytest.approx([0.0, 0.0, 0.0], abs=1e-4)
    up_mm = truths[2]["limbs"][0]["foot_mm"][2] - truths[0]["limbs"][0]["foot_mm"][2]
    assert 10.0 < up_mm < 20.0  # 20 mm, less what the body tilts
    for one in truths:
        assert forces(one)[:, 2].sum() == pytest.approx(BORNE_N - 2.0, abs=0.05)
    assert not events(lifted, "fall")
    moved = [one["truth"] for one in events(brace(*run, "--seconds", 2, "--move", "2:0,-0.02,0@1"), "truth")]
    assert forces(moved[2])[1][2] > forces(moved[0])[1][2] + 0.3  # pressed down, it bears more


def test_a_fall_is_said_once(brace: Callable[..., Outcome], stance: Path) -> None:
    ran = brace("sim", "--stance", stance, *NO_PORTS, "--seconds", 4, "--payload", "40@1+2", "--json")
    (fall,) = events(ran, "fall")
    assert 1.0 < fall["time_s"] < 3.5 and fall["message"].startswith(f"the body falls at {fall['time_s']:.3f} s")
    assert ran.err.count("the body falls at") == 1
    (end,) = events(ran, "end")
    assert [limb["state"] for limb in end["truth"]["limbs"]] == ["open"] * 4
    assert end["ticks"] == 4 * 4001  # the controllers go on


def test_the_clock_runs_a_robot_too(brace: Callable[..., Outcome], stance: Path) -> None:
    ran = brace("sim", "--stance", stance, "--can", "none", "--modbus", "none", "--seconds", 1.2, "--json")
    assert [round(one["truth"]["time_s"]) for one in events(ran, "truth")] == [0, 1]


@pytest.mark.parametrize(
    ("more", "says"),
    [
        (("--limbs", 2), "--limbs is for limbs without a body"),
        (("--press", "1,1"), "--press is for limbs without a body"),
        (("--servos", "/dev/ttyUSB0"), "a stance has simulated servos"),
        (("--lift", "front@1"), "--lift: this stance has no limb 'front'"),
        (("--lift", "5@1"), "--lift: this stance has no limb '5'"),
        (("--move", "1:0,0.1@1"), "no move of a limb"),
        (("--payload", "much"), "'much' is not a number"),
        (("--truth", "none/truth.csv"), "none"),
    ],
)
def test_what_does_not_go_with_a_stance(
    brace: Callable[..., Outcome], stance: Path, more: tuple[object, ...], says: str
) -> None:
    ran = brace("sim", "--stance", stance, *NO_PORTS, "--seconds", 0.1, *more)
    assert ran.code == 2 and says in ran.err


def test_what_needs_a_stance(brace: Callable[..., Outcome], stance: Path, tmp_path: Path) -> None:
    limb = tmp_path / "limb.toml"
    alone = brace("sim", "--model", limb, *NO_PORTS, "--seconds", 0.1, "--payload", 1)
    assert alone.code == 2 and "--payload is for limbs under one body" in alone.err
    assert brace("sim", "--stance", stance, "--model", limb).code == 2
    assert brace("sim", *NO_PORTS, "--seconds", 0.1).code == 2
    other = tmp_path / "other.toml"
    other.write_text(stance.read_text().replace('"rear left"', '"left rear"'))
    names = brace("sim", "--stance", stance, "--stance-plant", other, *NO_PORTS, "--seconds", 0.1)
    assert names.code == 3 and "the true stance has other limbs" in names.err
    rigid = [line for line in limb.read_text().splitlines() if "lateral" not in line and "torsion" not in line]
    limb.write_text("\n".join(rigid).replace("[joint.coxa]\ncompliance_rad_per_n_mm = 1e-5\n", "") + "\n")
    across = brace("sim", "--stance", stance, *NO_PORTS, "--seconds", 0.1)
    assert across.code == 3 and "does not yield across its plane" in across.err


def test_joints_that_rub_need_links_that_yield(brace: Callable[..., Outcome], stance: Path, tmp_path: Path) -> None:
    limb = (tmp_path / "limb.toml").read_text()
    rubs = limb + "".join(f"[motor.{joint}]\nfriction_per_load_ratio = 0.2\n" for joint in ("coxa", "femur", "tibia"))
    for joint in ("coxa", "femur", "tibia"):
        rubs = rubs.replace(f"[joint.{joint}]", f"[joint.{joint}]\ncoulomb_n_mm = 100.0\ncoulomb_per_load_ratio = 0.2")
    (tmp_path / "limb.toml").write_text(rubs)
    run = ("sim", "--stance", stance, *NO_PORTS, "--payload", "3@0.2+0.5", "--payload", "0@1+0.5", "--json")
    (end,) = events(brace(*run, "--seconds", 2), "end")
    assert end["truth"]["unbalanced_ratio"] < 1e-6  # it stands, and finds its rest
    rigid = [line for line in rubs.splitlines() if not line.startswith(("bending", "lateral"))]
    (tmp_path / "limb.toml").write_text("\n".join(rigid) + "\n")
    refused = brace(*run, "--seconds", 0.1)
    assert refused.code == 3 and "joints that rub and links that hardly yield" in refused.err


def test_a_body_costs_less_than_its_limbs_do() -> None:
    """At rest, in one run, in turn, each the best of many short parts. A seventh more on an idle core; two thirds more
    were seen where another program shares the core and its caches. A body that does not rest costs several times
    more."""
    stance = SimulatedStance(believed := load_stance(EXAMPLE / "stance.toml"), believed)
    drive = {"servo_n_mm_per_rad": SERVO_N_MM_PER_RAD}
    setups = [LimbSetup(limb.believed, limb.plant, theta_rad=limb.theta_rad, drive=drive) for limb in stance.limbs]

    def part_s(node: Node) -> float:
        began = time.process_time()
        node.step(0.02)
        return time.process_time() - began

    with Robot(stance.body, setups) as robot, Node(setups) as alone:
        in_turn = [(part_s(robot), part_s(alone)) for _ in range(100)]
    robot_s, alone_s = (min(parts) for parts in zip(*in_turn))
    assert robot_s < 2.0 * alone_s
