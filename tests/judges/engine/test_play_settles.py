"""`brace k` under a load, and a controller on which this load has rested for two seconds: the same flags and K.

The judge knows statics alone: what each motor carries where `brace k` says the limb rests. The controller runs on a fake
board and is given the motors' angles, these torques and the force.

A gap that counts as open has a memory: the joint stands where its load has last shown it. So where a tenth more of the
force would show a side, K may be that of either place; such limbs are counted, and their flags are compared."""

from __future__ import annotations

import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
from brace.model import LimbModel
from brace.params import pack
from brace.stiffness.at_rest import PLANAR_K, PostureError
from brace.stiffness.play_under_load import JOINTS, PlayUnderLoad, put_into
from brace.stiffness.under_load import LoadedLimb, stiffness_under_load
from cases import Case, limb_model, random_cases

SETTLED = Path(__file__).resolve().parents[3] / "build" / "host" / "tests" / "judges" / "play" / "settled"
SAME_K = 1e-5  # of K's largest eigenvalue with every gap closed: singles, rounded on two ways
MORE = 1.1  # times the force: by as much the load may differ before the limb has come to rest
FLAGS = 0xFFFF


def with_play(case: Case, draw: np.random.Generator) -> tuple[LimbModel, Case]:
    """The limb with play in one joint or both, drives by lot, and less of the load."""
    keys = dict(case.keys)
    for joint in JOINTS:
        keys |= {
            f"joint.{joint}.gap_rad": draw.choice([0.0, draw.uniform(0.0005, 0.01), draw.uniform(0.0005, 0.01)]),
            f"joint.{joint}.coulomb_n_mm": draw.choice([0.0, draw.uniform(0, 300)]),
            f"joint.{joint}.coulomb_per_load_ratio": draw.choice([0.0, draw.uniform(0, 0.3)]),
            f"joint.{joint}.zero_offset_rad": draw.uniform(-0.05, 0.05),
            f"motor.{joint}.friction_n_mm": draw.uniform(0, 400),
            f"motor.{joint}.friction_tolerance_ratio": draw.uniform(0, 1),
            f"motor.{joint}.torque_noise_n_mm": 10 ** draw.uniform(0, 2.7),
            f"motor.{joint}.torque_range_n_mm": 40000.0,  # no load is beyond what the motors hold
            f"motor.{joint}.torque_bias_n_mm": draw.uniform(0, 100),
            f"motor.{joint}.takeup_torque_n_mm": draw.choice([1000.0, 4000.0]),
        }
    keys |= {
        "sensor.noise_n": draw.uniform(0.0, 0.2),
        "gravity.direction_rad": float(np.arctan2(case.gravity[2], case.gravity[0])),
        "controller.node_id": 5.0,
    }
    force_n = case.force_n * 10 ** draw.uniform(-1.7, 0.0)
    return limb_model({key: float(value) for key, value in keys.items()}), replace(case, force_n=force_n)


def carried_n_mm(model: LimbModel, stands_rad: np.ndarray, force_n: np.ndarray) -> np.ndarray:
    """What the motors of femur and tibia joint carry where the limb rests: moments of the force on the tip and of the
    weights, each half a link's at its ends."""
    rest, load, _ = LoadedLimb(model).rest_at((stands_rad[0], stands_rad[1]), (force_n[0], force_n[1]))
    femur, tibia = model.number("geometry.femur_mm"), model.number("geometry.tibia_mm")
    tip = femur * np.exp(1j * stands_rad[0]) + tibia * np.exp(1j * (stands_rad[0] - stands_rad[1]))
    tip += complex(rest.displacement.x_mm, rest.displacement.z_mm)
    knee = tip - complex(rest.tibia_mm.x, rest.tibia_mm.z)
    down = complex(load.down.x, load.down.z)
    shank = 0.5 * model.number("gravity.tibia_n")
    at_knee = (0.5 * model.number("gravity.femur_n") + model.number("gravity.knee_n") + shank) * down
    at_tip = shank * down + complex(*force_n)

    def moment(arm: complex, force: complex) -> float:
        return (arm.conjugate() * force).imag

    return np.array([-moment(tip, at_tip) - moment(knee, at_knee), moment(tip - knee, at_tip)])


def test_brace_k_says_what_the_controller_settles_at(limbs: int, seed: int) -> None:
    """As many limbs as --limbs says; 500 are a quarter of a minute."""
    draw = np.random.default_rng(seed)
    records, said = b"", []
    for case in random_cases(seed, 3 * limbs, in_space=False):
        model, pressed = with_play(case, draw)
        offset = np.array([model.number(f"joint.{joint}.zero_offset_rad") for joint in JOINTS])
        true_rad = np.array(pressed.theta_rad[1:])
        try:
            limb = PlayUnderLoad(model)
            play = limb.at(*true_rad, *pressed.force_n)
            if play is None:
                continue
            stands = true_rad - [0.5 * play.stands.get(joint, 0) * limb.gaps_rad[joint] for joint in JOINTS]
            torque_n_mm = carried_n_mm(model, stands, pressed.force_n)
            columns = [np.array([value]) for value in (*stands, *pressed.force_n)]
            whole = stiffness_under_load(model, *columns)
            more = limb.at(*true_rad, *(MORE * pressed.force_n))
        except PostureError:
            continue
        values = {name: whole[name][0].item() for name in whole.dtype.names or ()}
        put_into(values, play)
        load = np.concatenate([true_rad - offset, torque_n_mm, pressed.force_n]).astype(np.float32)
        records += pack(model).content + load.tobytes()
        has_memory = more is not None and more.stands != play.stands
        said.append((values, play, has_memory, float(whole["lambda_max_n_per_mm"][0])))
        if len(said) == limbs:
            break
    assert len(said) == limbs
    told = subprocess.run([SETTLED], input=records, capture_output=True, check=True, timeout=600).stdout.decode()
    rows = [line.split() for line in told.splitlines()]
    assert len(rows) == limbs
    worst, by_memory, seen = 0.0, 0, {"open": 0, "assumed": 0, "proven": 0}
    for row, (values, play, has_memory, largest) in zip(rows, said, strict=True):
        status, is_valid, flags, gaps = map(int, row[:4])
        assert status == 0 and is_valid, (row, values, play)
        assert flags & FLAGS == int(values["flags"]), (row, values, play)
        assert gaps == sum(1 << JOINTS.index(joint) for joint in play.open)
        apart = [abs(float(text) - values[name]) / largest for text, name in zip(row[4:], PLANAR_K, strict=True)]
        if max(apart) < SAME_K:
            worst = max(worst, *apart)
        else:
            assert has_memory and play.open, (row, values, play)
            by_memory += 1
        kind = "open" if play.open else "assumed" if play.assumed else "proven"
        seen[kind] += 1
    print(f"{limbs} limbs: {seen}; K apart by at most {worst:.2g}; {by_memory} stand elsewhere in an open gap")
    assert by_memory <= limbs // 50
    assert min(seen.values()) >= limbs // 20
