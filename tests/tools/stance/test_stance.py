"""`brace stance`: the file, the answers, what is refused."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from command_bench import Outcome

from brace.ground.errors import BadFileError
from brace.stance.limb_law import LimbLaw
from brace.stance.measured import load_measured
from brace.stance.stance_file import load_stance, turn_of
from brace.stance.world import believed

LIMB = """format = 1
[geometry]
coxa_mm = 55.0
femur_mm = 110.0
tibia_mm = 130.0
[link.coxa]
bending_mm_per_n = 0.01
lateral_mm_per_n = 0.01
[link.femur]
bending_mm_per_n = 0.05
lateral_mm_per_n = 0.05
torsion_rad_per_n_mm = 1e-6
[link.tibia]
bending_mm_per_n = 0.1
lateral_mm_per_n = 0.1
[joint.coxa]
compliance_rad_per_n_mm = 1e-5
[joint.femur]
compliance_rad_per_n_mm = 1e-5
[joint.tibia]
compliance_rad_per_n_mm = 1e-5
[gravity]
femur_n = 0.5
knee_n = 0.8
tibia_n = 0.4
[uncertainty]
length_mm = 0.2
angle_rad = 0.003
compliance_rel = 0.1
"""
CORNERS = {  # x, y and yaw in quarters of pi
    "front left": (120, 90, 1),
    "front right": (120, -90, -1),
    "rear left": (-120, 90, 3),
    "rear right": (-120, -90, -3),
}
WEIGHT_N, LIMBS_N = 30.0, 4 * 1.7
PAYLOAD = "[payload]\nforce_n = [4.0, 0.0, -2.0]\nat_mm = [20.0, 0.0, 30.0]\n"


def write(
    folder: Path, payload: str = PAYLOAD, friction: float = 0.9, corners: dict[str, tuple[int, int, int]] = CORNERS
) -> Path:
    (folder / "limb.toml").write_text(LIMB)
    text = f'format = 1\nname = "four"\n[body]\nweight_n = {WEIGHT_N}\n{payload}'
    for name, (x, y, quarter) in corners.items():
        text += f'[[limb]]\nname = "{name}"\nmodel = "limb.toml"\nmount_mm = [{x}.0, {y}.0, 0.0]\n'
        text += f"mount_rpy_rad = [0.0, 0.0, {quarter * math.pi / 4}]\ntheta_rad = [0.0, 0.4, 1.6]\n"
        text += f"[limb.foothold]\nfriction = {friction}\n"
    path = folder / "stance.toml"
    path.write_text(text)
    return path


@pytest.fixture
def stance(tmp_path: Path) -> Path:
    return write(tmp_path)


def forces(answer: dict[str, list[dict[str, list[float]]]]) -> np.ndarray:
    return np.array([limb["force_n"] for limb in answer["limbs"]])


def test_the_feet_bear_weight_limbs_and_payload(brace: Callable[..., Outcome], stance: Path) -> None:
    found = json.loads(brace("stance", "load", stance, "--draws", 20, "--json").out)
    assert list(found) == ["limbs", "body", "change", "before", "first_slip", "flags"]
    borne = forces(found).sum(axis=0)
    assert borne == pytest.approx([-4.0, 0.0, WEIGHT_N + LIMBS_N + 2.0], abs=1e-6)
    assert forces(found["change"]).sum(axis=0) == pytest.approx([-4.0, 0.0, 2.0], abs=1e-6)
    assert forces(found["before"]) == pytest.approx(forces(found) - forces(found["change"]))
    for limb in found["limbs"]:
        low, force, high = (np.array(limb[key]) for key in ("force_low_n", "force_n", "force_high_n"))
        assert np.all(low < force) and np.all(force < high) and limb["state"] == "sticks"
    first = found["first_slip"]
    assert first["limb"] in CORNERS and first["low"] <= first["payload_factor"] <= first["high"]
    assert forces(found)[0][0] == pytest.approx(forces(found)[1][0]) and found["body"]["displacement_mm"][2] < 0.0


def test_the_text_tells_each_foots_force(brace: Callable[..., Outcome], stance: Path) -> None:
    """As --json has it, to two decimals, and its interval."""
    found = json.loads(brace("stance", "load", stance, "--draws", 20, "--json").out)
    lines = brace("stance", "load", stance, "--draws", 20).out.splitlines()
    for limb in found["limbs"]:
        line = next(line for line in lines if line.strip().startswith(limb["name"]))
        for axis, force, low, high in zip(
            "xyz", limb["force_n"], limb["force_low_n"], limb["force_high_n"], strict=True
        ):
            assert f"{axis} {force + 0.0:8.2f} ({low:.2f} to {high:.2f})" in line


def test_a_payload_at_its_factor_makes_the_first_foot_slide(brace: Callable[..., Outcome], tmp_path: Path) -> None:
    first = json.loads(brace("stance", "load", write(tmp_path), "--draws", 20, "--json").out)["first_slip"]
    for more, slides in ((0.98, False), (1.03, True)):
        factor = more * first["payload_factor"]
        path = write(
            tmp_path, f"[payload]\nforce_n = [{4.0 * factor}, 0.0, {-2.0 * factor}]\nat_mm = [20.0, 0.0, 30.0]\n"
        )
        found = json.loads(brace("stance", "load", path, "--draws", 20, "--json").out)
        states = {limb["name"]: limb["state"] for limb in found["limbs"]}
        assert (states[first["limb"]] == "slides") == slides, states


def test_a_foothold_that_is_known_to_be_higher_bears_more(brace: Callable[..., Outcome], stance: Path) -> None:
    level = forces(json.loads(brace("stance", "load", stance, "--draws", 20, "--json").out))[:, 2]
    head, at, tail = stance.read_text().partition('[[limb]]\nname = "rear left"')
    stance.write_text(head + at + tail.replace("[limb.foothold]", "[limb.foothold]\noffset_mm = [0.0, 0.0, 0.5]", 1))
    found = json.loads(brace("stance", "load", stance, "--draws", 20, "--json").out)
    more = forces(found)[:, 2] - level
    assert min(more[1], more[2]) > 0.2 and max(more[0], more[3]) < -0.2  # the other diagonal bears less
    rear_left = found["limbs"][2]
    assert rear_left["force_low_n"][2] < rear_left["force_n"][2] < rear_left["force_high_n"][2]


def test_two_limbs_of_one_controller_are_refused(stance: Path) -> None:
    stance.write_text(stance.read_text().replace("[limb.foothold]", "node = 3\n[limb.foothold]"))
    with pytest.raises(BadFileError, match="two limbs have node 3"):
        load_stance(stance)


def test_measured_forces_make_the_answer_narrow(brace: Callable[..., Outcome], stance: Path, tmp_path: Path) -> None:
    measured = tmp_path / "m.csv"
    rows = [(-4.0, -4.0, 9.2), (-4.5, 4.2, 9.5), (4.2, -4.0, 9.0), (4.1, 3.9, 9.1)]
    lines = [f"{name},{x},{y},{z}" for name, (x, y, z) in zip(CORNERS, rows)]
    measured.write_text("\n".join(["limb,fx_n,fy_n,fz_n", *reversed(lines)]) + "\n")
    free = json.loads(brace("stance", "load", stance, "--json").out)
    known = json.loads(brace("stance", "load", stance, "--measured", measured, "--json").out)
    for a, b in zip(free["limbs"], known["limbs"]):
        wide, narrow = (np.subtract(limb["force_high_n"], limb["force_low_n"]) for limb in (a, b))
        assert np.all(narrow < 0.5 * wide)
    before = forces(known) - forces(known["change"])
    assert before == pytest.approx(np.array(rows), abs=0.5) and known["flags"] == []


def test_forces_that_do_not_carry_the_weight_are_flagged(
    brace: Callable[..., Outcome], stance: Path, tmp_path: Path
) -> None:
    measured = tmp_path / "m.csv"
    measured.write_text("limb,fx_n,fy_n,fz_n\n" + "".join(f"{name},0,0,4\n" for name in CORNERS))
    found = json.loads(brace("stance", "load", stance, "--measured", measured, "--draws", 20, "--json").out)
    assert any(
        flag.startswith("measured_unbalanced: forces and weight leave 0.00 0.00 -20.80 N") for flag in found["flags"]
    )


def test_torques_are_the_forces_they_come_from(brace: Callable[..., Outcome], stance: Path, tmp_path: Path) -> None:
    drawn = load_stance(stance)
    rows = np.array([(-2.0, -2.0, 9.2), (-2.0, 2.0, 9.2), (2.0, -2.0, 9.2), (2.0, 2.0, 9.2)])
    by_force, by_torque = tmp_path / "f.csv", tmp_path / "t.csv"
    by_force.write_text("limb,fx_n,fy_n,fz_n\n" + "".join(f"{n},{x},{y},{z}\n" for n, (x, y, z) in zip(CORNERS, rows)))
    torques = [LimbLaw(limb, drawn.down).torques_n_mm(force) for limb, force in zip(drawn.limbs, rows)]
    by_torque.write_text(
        "limb,tau0_n_mm,tau1_n_mm,tau2_n_mm\n" + "".join(f"{n},{a},{b},{c}\n" for n, (a, b, c) in zip(CORNERS, torques))
    )
    first, second = (
        json.loads(brace("stance", "load", stance, "--measured", path, "--draws", 20, "--json").out)
        for path in (by_force, by_torque)
    )
    # gears hide up to 200 N mm a joint, some 2 N of a force: the interval is wider, and a load that grew until its joint
    # slipped is more than its motor gives
    read = load_measured(by_torque, drawn, believed(drawn), 0.3)
    assert all(np.linalg.eigvalsh(one)[-1] > 0.5 for one in read.covariance_n2)
    for law, force, torque in zip(believed(drawn).laws, read.force_n, torques, strict=True):
        assert law.torques_n_mm(force) == pytest.approx(torque + np.clip(0.5 * torque, -100.0, 100.0), abs=0.1)
    assert forces(first) == pytest.approx(forces(second), abs=1.0)
    width = [np.ptp([answer["limbs"][0][f"force_{end}_n"][2] for end in ("low", "high")]) for answer in (first, second)]
    assert width[1] > width[0]
    none = "".join(f"\n[motor.{joint}]\nfriction_n_mm = 0.0\n" for joint in ("coxa", "femur", "tibia"))
    (stance.parent / "limb.toml").write_text(LIMB + none)
    drawn = load_stance(stance)
    assert load_measured(by_torque, drawn, believed(drawn), 0.3).force_n == pytest.approx(rows, abs=1e-3)


def test_a_current_holds_any_load_that_the_published_friction_lets_it_hold(stance: Path, tmp_path: Path) -> None:
    """The band of docs/joints.md: a motor that gives 2.0 N m may hold 0.97 to 3.28 N m."""
    friction = "".join(
        f"\n[motor.{joint}]\nfriction_n_mm = 122.0\nfriction_per_torque_ratio = 0.40\n"
        "friction_per_load_ratio = 0.11\nfriction_tolerance_ratio = 0.0\ntorque_gain_rel = 0.03\n"
        for joint in ("coxa", "femur", "tibia")
    )
    (stance.parent / "limb.toml").write_text(LIMB + friction)
    drawn, table = load_stance(stance), tmp_path / "t.csv"
    table.write_text("limb,tau0_n_mm,tau1_n_mm,tau2_n_mm\n" + "".join(f"{name},0,0,-2000\n" for name in CORNERS))
    read, world = load_measured(table, drawn, believed(drawn), 1e-6), believed(drawn)
    for law, force, covariance in zip(world.laws, read.force_n, read.covariance_n2, strict=True):
        low, high, torque = 971.0, 3280.0, law.torques_n_mm(force)
        assert torque == pytest.approx([0.0, 0.0, -(low + 3.0 * high) / 4], abs=15.0), "half way to the outer end"
        by_force = np.linalg.inv(law.force_by_torque())
        sd = np.sqrt(np.diag(by_force @ covariance @ by_force.T))
        assert sd[2] == pytest.approx(np.hypot((high - low) / 2, 0.03 * (low + high) / 2), rel=0.01)


def test_torques_are_the_moments_of_force_and_weights(stance: Path) -> None:
    """About each joint's axis, by cross products of places found by turning the limb a little."""
    drawn = load_stance(stance)
    limb = drawn.limbs[2]
    law, force, small = LimbLaw(limb, drawn.down), np.array([1.5, -2.0, 9.0]), 1e-6
    work = []
    for joint in range(3):
        theta = limb.theta_rad.copy()
        theta[joint] += small
        other = LimbLaw(type(limb)(**{**vars(limb), "theta_rad": theta}), drawn.down)
        by_weights = sum(n * drawn.down @ (b - a) for (n, a), (_, b) in zip(law.weights(), other.weights()))
        work.append((force @ (other.tip_mm - law.tip_mm) + by_weights) / small)
    assert law.torques_n_mm(force) == pytest.approx(work, rel=1e-4)


def test_without_a_stance_the_nearest_load_is_said(brace: Callable[..., Outcome], tmp_path: Path) -> None:
    path = write(tmp_path, "[payload]\nforce_n = [80.0, 0.0, 0.0]\n")
    done = brace("stance", "load", path, "--draws", 20, "--json")
    assert done.code == 5
    found = json.loads(done.out)
    nearest, first = found["nearest_load"]["payload_factor"], found["first_slip"]
    assert "slide" in found["reason"] and 0.1 < first["payload_factor"] < nearest < 0.5 and first["limb"] in CORNERS
    done = brace("stance", "load", path, "--draws", 20)
    borne = re.search(r"([\d.]+) % of the payload is borne; first to slide", done.err)
    assert done.code == 5 and borne and float(borne[1]) == pytest.approx(100.0 * nearest, abs=1.0) and done.out == ""
    two = {name: CORNERS[name] for name in ("front left", "rear right")}
    done = brace("stance", "load", write(tmp_path, corners=two), "--json")
    assert done.code == 5 and "do not hold the body" in json.loads(done.out)["reason"]


def test_limbs_that_give_way_are_said(brace: Callable[..., Outcome], tmp_path: Path) -> None:
    path = write(tmp_path, "[payload]\nforce_n = [0.0, 0.0, -4000.0]\n")
    done = brace("stance", "load", path, "--draws", 20, "--json")
    found = json.loads(done.out)
    assert done.code == 5 and "give way" in found["reason"] and 0.01 < found["nearest_load"]["payload_factor"] < 0.9


def test_play_that_no_load_holds_is_flagged_and_softens(brace: Callable[..., Outcome], tmp_path: Path) -> None:
    path = write(tmp_path)
    stiff = json.loads(brace("stance", "load", path, "--draws", 20, "--json").out)
    (tmp_path / "limb.toml").write_text(LIMB.replace("[joint.coxa]", "[joint.coxa]\ngap_rad = 0.006"))
    found = json.loads(brace("stance", "load", path, "--draws", 20, "--json").out)
    assert [flag for flag in found["flags"] if flag.startswith("gap_open")] == [f"gap_open: {n}, coxa" for n in CORNERS]
    # a push forward loads all coxa joints; they yield within their play
    assert found["body"]["displacement_mm"][0] > 1.2 * stiff["body"]["displacement_mm"][0]


def test_a_picture_is_drawn_and_replaces_no_input(brace: Callable[..., Outcome], stance: Path, tmp_path: Path) -> None:
    picture = tmp_path / "s.png"
    assert brace("stance", "load", stance, "--draws", 20, "--picture", picture).code == 0
    assert picture.read_bytes().startswith(b"\x89PNG") and picture.stat().st_size > 20_000
    assert brace("stance", "load", stance, "--draws", 20, "--picture", stance).code == 2
    assert brace("stance", "load", stance, stance, "--picture", picture).code == 2


def test_several_stances_are_lines(brace: Callable[..., Outcome], stance: Path) -> None:
    lines = brace("stance", "load", stance, stance, "--draws", 20, "--json").out.splitlines()
    assert len(lines) == 2 and lines[0] == lines[1] and json.loads(lines[0])["limbs"][0]["name"] == "front left"


def test_show_and_lift_say_it_in_words(brace: Callable[..., Outcome], stance: Path) -> None:
    shown = brace("stance", "show", stance)
    assert shown.code == 0 and "rear right" in shown.out and "the body gives way by" in shown.out
    found = json.loads(brace("stance", "show", stance, "--json").out)
    assert found["limbs"][0]["foot_mm"][:2] == pytest.approx([263.8, 233.8], abs=0.1)
    assert forces(found).sum(axis=0) == pytest.approx([0.0, 0.0, WEIGHT_N + LIMBS_N], abs=1e-6), "weight, no payload"
    mrad_per_n_m = " ".join(f"{1e6 * found['body']['compliance'][i][i]:.2f}" for i in (3, 4, 5))
    assert f"by {mrad_per_n_m} mrad for each N m about them" in shown.out
    lifted = json.loads(brace("stance", "lift", stance, "--json").out)["lifted"]
    assert [one["name"] for one in lifted] == list(CORNERS)
    for one in lifted:
        if one["stands"]:
            assert forces(one).sum(axis=0)[2] == pytest.approx(WEIGHT_N + LIMBS_N + 2.0, abs=1e-6)
            assert len(one["limbs"]) == 3
    assert brace("stance", "lift", stance, "--limb", "front").code == 2
    measured = Path(str(stance)).parent / "m.csv"
    rows = ((-6.0, -6.0, 9.2), (-6.0, 6.0, 9.2), (6.0, -6.0, 9.2), (6.0, 6.0, 9.2))
    lines = [f"{name},{x},{y},{z}" for name, (x, y, z) in zip(CORNERS, rows)]
    measured.write_text("\n".join(["limb,fx_n,fy_n,fz_n", *lines]) + "\n")
    known = json.loads(brace("stance", "lift", stance, "--measured", measured, "--json").out)["lifted"]
    assert known != lifted  # feet that press harder outwards bear other forces when one is gone


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("weight_n = 30.0", "weight_n = -1.0", "body.weight_n = -1.0 is not allowed"),
        ("weight_n = 30.0", "wieght_n = 30.0", "unknown key body.wieght_n"),
        ("mount_mm = [120.0, 90.0, 0.0]", "mount_mm = [120.0, 90.0]", "limb.0.mount_mm"),
        ('name = "front right"', 'name = "front left"', "two limbs are named 'front left'"),
        ('model = "limb.toml"', 'node = 200\nmodel = "limb.toml"', "limb.0.node = 200 is not allowed"),
        ("friction = 0.9", "friction = 0.9\nnormal = [0, 0, 0]", "limb.0.foothold.normal has no direction"),
        ('model = "limb.toml"', 'model = "none.toml"', "none.toml"),
        ("theta_rad = [0.0, 0.4, 1.6]", "", "limb.0.theta_rad is missing"),
    ],
)
def test_a_stance_file_that_is_wrong_is_refused_by_its_line(stance: Path, old: str, new: str, says: str) -> None:
    stance.write_text(stance.read_text().replace(old, new, 1))
    with pytest.raises(BadFileError) as refused:
        load_stance(stance)
    assert says in f"{refused.value.where} {refused.value.what}"


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("limb,fx,fy,fz\n", "no forces of limbs"),
        ("limb,fx_n,fy_n,fz_n\nfront,1,2,3\n", "limb 'front' is none of this stance"),
        ("limb,fx_n,fy_n,fz_n\nfront left,1,2,x\n", "fz_n = 'x' is no number"),
        ("limb,fx_n,fy_n,fz_n\nfront left,1,2,nan\n", "fz_n = 'nan' is no number"),
        ("limb,fx_n,fy_n,fz_n\nfront left,1,2,3\n", "no row for front right"),
        ("", "no forces of limbs"),
    ],
)
def test_a_table_that_is_wrong_is_refused(
    brace: Callable[..., Outcome], stance: Path, tmp_path: Path, text: str, says: str
) -> None:
    table = tmp_path / "m.csv"
    table.write_text(text)
    done = brace("stance", "load", stance, "--measured", table)
    assert done.code == 3 and says in done.err


def test_a_mount_turns_as_urdf_says() -> None:
    """Roll about the fixed x first, then pitch about the fixed y, then yaw about the fixed z."""
    quarter = math.pi / 2
    assert turn_of(quarter, 0.0, 0.0) @ [0, 1, 0] == pytest.approx([0, 0, 1])
    assert turn_of(0.0, quarter, 0.0) @ [0, 0, 1] == pytest.approx([1, 0, 0])
    assert turn_of(0.0, 0.0, quarter) @ [1, 0, 0] == pytest.approx([0, 1, 0])
    assert turn_of(quarter, 0.0, quarter) @ [0, 1, 0] == pytest.approx([0, 0, 1])
    assert turn_of(0.0, quarter, quarter) @ [1, 0, 0] == pytest.approx([0, 0, -1])


# ------------------------------------------------------------------------------------------------ set-points


def test_set_points_raise_the_smallest_margin(brace: Callable[..., Outcome], stance: Path) -> None:
    """More than any of many ways that are tried at random, each judged by the whole law."""
    found = json.loads(brace("stance", "set", stance, "--travel", 2, "--json").out)
    best = min(limb["margin_n"] for limb in found["limbs"])
    assert best > min(limb["margin_before_n"] for limb in found["limbs"]) + 1.0
    assert all(abs(part) <= 2.0 + 1e-9 for limb in found["limbs"] for part in limb["tip_moves_mm"])
    world = believed(load_stance(stance))
    _, state = world.load(world.stand(), [world.payload])
    statics = world.statics_at(state)
    force, stiffness = statics.linear(state, [*world.weight, world.payload])
    chance = np.random.default_rng(3)
    for _ in range(2000):
        tried = (force - stiffness @ chance.uniform(-2.0, 2.0, force.size)).reshape(-1, 3)
        assert min(statics.margin_n(i, one) for i, one in enumerate(tried)) <= best / 0.95


def test_set_points_are_asked_for_again_when_they_have_been_executed(
    brace: Callable[..., Outcome], stance: Path, tmp_path: Path
) -> None:
    """What was printed, written into the file, with the forces then: the feet stand where they stood."""
    found = json.loads(brace("stance", "set", stance, "--json").out)["limbs"]
    table, text = tmp_path / "m.csv", stance.read_text()
    table.write_text("\n".join(["limb,fx_n,fy_n,fz_n", *(
        ",".join([limb["name"], *map(str, limb["force_n"])]) for limb in found)]) + "\n")  # fmt: skip
    head, *limbs = text.split("[[limb]]")
    for i, (part, limb) in enumerate(zip(limbs, found, strict=True)):
        part = re.sub(r"(?m)^theta_rad = .*$", f"theta_rad = {limb['theta_rad']}", part)
        limbs[i] = part.replace("[limb.foothold]\n", f"[limb.foothold]\noffset_mm = {limb['offset_mm']}\n")
    executed = stance.with_name("executed.toml")
    executed.write_text("[[limb]]".join([head, *limbs]))
    assert executed.read_text().count("offset_mm = [") == len(found)
    measured = ("--measured", table, "--with-payload", "--json")
    again = json.loads(brace("stance", "set", executed, *measured).out)["limbs"]
    for before, after in zip(found, again, strict=True):
        assert after["force_before_n"] == pytest.approx(before["force_n"], abs=0.05)
    assert min(limb["margin_n"] for limb in again) > min(limb["margin_n"] for limb in found) - 0.05
    assert brace("stance", "set", executed, "--with-payload").code == 2


def test_set_points_make_wanted_forces(brace: Callable[..., Outcome], stance: Path, tmp_path: Path) -> None:
    before = json.loads(brace("stance", "set", stance, "--for", "sag", "--json").out)
    wanted = np.array([limb["force_n"] for limb in before["limbs"]])
    wanted += 0.5 * np.array([(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)])  # of no resultant but a little moment
    table = tmp_path / "w.csv"
    lines = [f"{name},{x},{y},{z}" for name, (x, y, z) in zip(CORNERS, wanted)]
    table.write_text("\n".join(["limb,fx_n,fy_n,fz_n", *lines]) + "\n")
    found = json.loads(brace("stance", "set", stance, "--for", "forces", "--wanted", table, "--json").out)
    assert forces(found) == pytest.approx(wanted, abs=0.05 * WEIGHT_N / 4)
    assert brace("stance", "set", stance, "--for", "forces").code == 2


def test_set_points_take_the_sag_away(brace: Callable[..., Outcome], stance: Path) -> None:
    found = json.loads(brace("stance", "set", stance, "--for", "sag", "--json").out)
    assert found["body"]["displacement_mm"] == pytest.approx([0.0, 0.0, 0.0], abs=0.03)
    for limb in found["limbs"]:
        assert limb["force_n"] == pytest.approx(limb["force_before_n"], abs=0.05)
        assert limb["tip_moves_mm"][2] < -0.5


def test_a_given_way_of_a_set_point_changes_the_forces_as_k_says(brace: Callable[..., Outcome], stance: Path) -> None:
    """Every foot sticks: forces change as when the foot moved back, and what all feet bear together stays. A foot that
    moves takes its force along, and so a moment that a set-point does not make: 4 % here."""
    name, way = list(CORNERS)[1], np.array([0.1, -0.2, 0.3])
    move = f"{name}:" + ",".join(map(str, way))
    found = json.loads(brace("stance", "set", stance, "--move", move, "--json").out)["limbs"]
    change = np.array([limb["change_n"] for limb in found])
    world = believed(load_stance(stance))
    _, state = world.load(world.stand(), [world.payload])
    _, stiffness = world.statics_at(state).linear(state, [*world.weight, world.payload])
    expected = -(stiffness[:, 3:6] @ way).reshape(-1, 3)
    assert np.abs(expected).max() > 0.2
    assert change == pytest.approx(expected, abs=0.06 * np.abs(expected).max())
    assert change.sum(axis=0) == pytest.approx([0.0, 0.0, 0.0], abs=1e-6)
    low, high = (np.array([limb[f"change_{end}_n"] for limb in found]) for end in ("low", "high"))
    assert np.all(low < high) and np.mean((low <= change) & (change <= high)) > 0.7
    words = brace("stance", "set", stance, "--move", move).out
    assert "what that changes [N], with 90 % between" in words and f"({low[0][0]:.2f} to {high[0][0]:.2f})" in words
    assert np.array([limb["tip_moves_mm"] for limb in found]) == pytest.approx(np.outer([0, 1, 0, 0], way))
    assert brace("stance", "set", stance, "--move", move, "--for", "sag").code == 2
    for wrong in ("nobody:0,0,1", f"{name}:0,1", f"{name}:0,0,nan"):
        assert brace("stance", "set", stance, "--move", wrong).code == 2


def test_a_lift_says_what_it_changes(brace: Callable[..., Outcome], stance: Path) -> None:
    """The others take what the foot has borne."""
    lifted = json.loads(brace("stance", "lift", stance, "--json").out)["lifted"]
    loaded = json.loads(brace("stance", "load", stance, "--json").out)["limbs"]
    before = {limb["name"]: limb["force_n"] for limb in loaded}
    one = next(one for one in lifted if one["stands"])
    change = sum(np.array(limb["change_n"]) for limb in one["limbs"])
    assert change == pytest.approx(before[one["name"]], abs=0.05)
    for limb in one["limbs"]:
        assert np.array(limb["force_n"]) - limb["change_n"] == pytest.approx(before[limb["name"]], abs=0.05)
        for of in ("force", "change"):
            assert np.all(np.array(limb[f"{of}_low_n"]) < limb[f"{of}_high_n"])


def test_what_a_way_changes_is_the_median_of_draws_where_joints_have_play(
    brace: Callable[..., Outcome], stance: Path, tmp_path: Path
) -> None:
    """Forces were measured: the draws' forces before, the change, and those after it fit each other."""
    (stance.parent / "limb.toml").write_text(LIMB.replace("1e-5\n", "1e-5\ngap_rad = 0.006\n"))
    table = tmp_path / "m.csv"
    rows = [(-2.0, -2.0, 7.5), (-2.0, 2.0, 7.5), (2.0, -2.0, 7.5), (2.0, 2.0, 7.5)]
    lines = [f"{name},{x},{y},{z}\n" for name, (x, y, z) in zip(CORNERS, rows)]
    table.write_text("limb,fx_n,fy_n,fz_n\n" + "".join(lines))
    asked = ("--measured", table, "--json", "--move", f"{list(CORNERS)[0]}:0,0,-0.5")
    for with_payload in (("--with-payload",), ()):
        found = json.loads(brace("stance", "set", stance, *asked, *with_payload).out)["limbs"]
        before, change, after = (
            np.array([limb[key] for limb in found]) for key in ("force_before_n", "change_n", "force_n")
        )
        assert change == pytest.approx(after - before, abs=0.15)  # medians of each
        assert change[0][2] > 0.1 and abs(change.sum(axis=0)).max() < 0.1
    loaded = json.loads(brace("stance", "load", stance, "--measured", table, "--json").out)
    assert before == pytest.approx(forces(loaded), abs=0.1)
