"""Joint tests of the actuator simulator: what is hidden, on what drive, read how. Sizes are those of robots' joints."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from actuator import Bench, Joint, Record, Test, read
from designs import Rng

WHERE = "joint.femur"
PLACE = {"creep": "creep"}  # of what has another place in the catalogue
ARCMIN = math.pi / 180.0 / 60.0


@dataclass
class Made:
    """A record and the truth about it. `effects`: names of the catalogue; `size`: parameters as limb.toml has them."""

    kind: str
    record: Record
    effects: tuple[str, ...]
    size: dict[str, float] = field(default_factory=dict)
    outside: str = ""  # what no entry of the catalogue describes
    trouble: str = ""  # of the instruments
    evidence: str = ""  # the case of the list of known failures that it rebuilds
    left_out: dict[str, float] = field(default_factory=dict)  # sizes of a gear position that the record has not
    about: dict[str, Any] = field(default_factory=dict)


def log_uniform(rng: Rng, low: float, high: float) -> float:
    """Between two sizes, each decade alike."""
    return float(math.exp(rng.uniform(math.log(low), math.log(high))))


@dataclass(frozen=True)
class Plain:
    """A joint with nothing hidden: full torque, and the angle that this winds its spring up by."""

    joint: Joint
    full: float
    reach: float


def plain(rng: Rng) -> Plain:
    """A spring, the motor's inertia and its bearings' viscosity: below a hundredth of the full torque at the speeds of
    a joint test, so that naming nothing is right."""
    full, reach = log_uniform(rng, 2e3, 3e4), log_uniform(rng, 0.008, 0.06)
    k = full / reach
    fastest = 2.0 * math.pi * 0.2 * reach
    natural = rng.uniform(60.0, 300.0)
    joint = Joint(
        k,
        zero=rng.uniform(-0.2, 0.2),
        inertia=k / natural**2,
        viscous=full * rng.uniform(0.001, 0.004) / fastest,
        bristle=full * 0.05 / (0.01 * reach),
    )
    return Plain(joint, full, reach)


def with_friction(rng: Rng, at: Plain, joint: Joint, law: str = "", load: bool | None = None) -> Joint:
    """LuGre with or without a Stribeck peak, Dahl, or generalised Maxwell slip; half of them grow with the load."""
    law = law or str(rng.choice(["lugre", "dahl", "maxwell"]))
    level = at.full * rng.uniform(0.04, 0.12)
    share = rng.uniform(0.05, 0.2) if (rng.random() < 0.5 if load is None else load) else 0.0
    bristle = level / (at.reach * rng.uniform(0.005, 0.05))  # N mm/rad: how far it is bent before it slips
    damping = 0.3 * math.sqrt(bristle * joint.inertia) if law == "lugre" else 0.0
    return replace(
        joint, coulomb=level, per_load=share, bristle=bristle, bristle_damping=damping, maxwell=float(law == "maxwell"),
        peak=rng.uniform(0.0, 0.4) if law == "lugre" else 0.0, stribeck=at.reach * rng.uniform(0.1, 0.5),
    )  # fmt: skip


def with_play(rng: Rng, at: Plain, joint: Joint) -> Joint:
    """3 to 60 arcmin, as far as the reach allows."""
    return replace(joint, gap=float(np.clip(at.reach * rng.uniform(0.15, 0.8), 3 * ARCMIN, 60 * ARCMIN)))


def with_hardening(rng: Rng, at: Plain, joint: Joint) -> Joint:
    """The cubic part has 0.25 to 1 of the spring's torque at full torque's angle."""
    return replace(joint, hardening=rng.uniform(0.25, 1.0) * joint.stiffness / at.reach**2)


def with_creep(rng: Rng, _at: Plain, joint: Joint) -> Joint:
    """A polymer's."""
    return replace(joint, creep=rng.uniform(0.1, 0.35), creep_s=log_uniform(rng, 1.0, 8.0))


PUT_IN: dict[str, Callable[[Rng, Plain, Joint], Joint]] = {
    "backlash": with_play,
    "coulomb_friction": with_friction,
    "joint_hardening": with_hardening,
    "creep": with_creep,
}


def sizes(joint: Joint, effects: tuple[str, ...]) -> dict[str, float]:
    """As limb.toml has them."""
    size = {f"{WHERE}.compliance_rad_per_n_mm": 1.0 / joint.stiffness}
    if "backlash" in effects:
        size[f"{WHERE}.gap_rad"] = joint.gap
    if "coulomb_friction" in effects:
        size[f"{WHERE}.coulomb_n_mm"] = joint.coulomb
    if "joint_hardening" in effects:
        size[f"{WHERE}.hardening_n_mm_per_rad3"] = joint.hardening
    return size


def bench(rng: Rng, at: Plain, torque_driven: bool | None = None) -> Bench:
    """A motor-side encoder of 12 to 14 bits behind a gear of 8 to 100, torque from a cell or a current."""
    bits, ratio = int(rng.integers(12, 15)), log_uniform(rng, 8.0, 100.0)
    driven = bool(rng.random() < 0.6) if torque_driven is None else torque_driven
    noise = at.full * log_uniform(rng, 0.001, 0.01)
    return Bench(
        driven, float(rng.choice([0.004, 0.005, 0.01])), 2 * math.pi / 2**bits / ratio, noise, at.full / 4096,
        with_command=bool(rng.random() < 0.4),
    )  # fmt: skip


def amplitude(at: Plain, joint: Joint, torque_driven: bool, share: float = 1.0) -> float:
    """Of the command: a share of the full torque, or about the angle at which the spring has it."""
    if torque_driven:
        return at.full * share
    wanted, x = at.full * share, at.reach * share
    for _ in range(40):  # Newton, for the cubic
        x -= (joint.stiffness * x + joint.hardening * x**3 - wanted) / (joint.stiffness + 3 * joint.hardening * x * x)
    return x + 0.5 * joint.gap


def plan(rng: Rng, at: Plain, joint: Joint, torque_driven: bool, hold_s: float = 0.0) -> list[Test]:
    """Two or three amplitudes, each twice or three times, at two rates."""
    shares = (0.4, 1.0) if rng.random() < 0.5 else (0.25, 0.5, 1.0)
    rates = log_uniform(rng, 0.04, 0.15), log_uniform(rng, 0.1, 0.25)
    wave = str(rng.choice(["ramp", "sine"]))
    tests = []
    for share in shares:
        for again in range(2 if len(shares) == 3 else 3):
            size = amplitude(at, joint, torque_driven, share)
            tests.append(Test(size, rates[again % 2], 2, wave, hold_s))
    return tests


def ordinary(rng: Rng, kind: str, effects: tuple[str, ...], law: str = "", load: bool | None = None,
             late: bool = False) -> Made:  # fmt: skip
    """A joint with these effects, tested as one would."""
    at = plain(rng)
    joint = at.joint
    for name in effects:
        joint = with_friction(rng, at, joint, law, load) if name == "coulomb_friction" else PUT_IN[name](rng, at, joint)
    how = bench(rng, at)
    late_s = rng.uniform(0.02, 0.1) if late else 0.0
    how = replace(how, late_s=late_s)
    hold_s = rng.uniform(3.0, 10.0) if "creep" in effects else 0.0
    tests = plan(rng, at, joint, how.torque_driven, hold_s)
    about = {"late_s": late_s, "torque_driven": how.torque_driven, "law": law, "wave": tests[0].wave}
    record = read(rng, [joint] * len(tests), tests, how)
    return Made(kind, record, effects, sizes(joint, effects), trouble="lag" if late else "", about=about)


# --- what the catalogue has not -------------------------------------------------------------------------------------


def outsider(rng: Rng, kind: str) -> Made:
    """Cogging, a spring of two stiffnesses, a stop, a spring that softens, a slider behind free travel, viscosity; half
    of them with friction besides, which then may be named."""
    at = plain(rng)
    joint = at.joint
    sign = float(rng.choice([-1.0, 1.0]))
    if kind == "cogging":
        period = at.reach * rng.uniform(0.15, 0.6)
        most = 0.4 * joint.stiffness * period / (2 * math.pi)
        ripple = min(at.full * rng.uniform(0.02, 0.1), most)
        joint = replace(joint, cogging=ripple, cogging_period=period, cogging_phase=rng.uniform(0, 2 * math.pi))
    elif kind == "one_sided":
        joint = replace(joint, one_sided=sign * rng.uniform(0.15, 0.5))
    elif kind == "end_stop":
        joint = replace(joint, stop_at=at.reach * rng.uniform(0.4, 0.75), stop=joint.stiffness * rng.uniform(0.7, 4.0))
    elif kind == "softening":
        joint = replace(joint, soft_at=at.reach * rng.uniform(1.3, 3.0))
    elif kind == "series_slip":
        level = at.full * rng.uniform(0.1, 0.25)
        joint = replace(joint, slip=at.reach * rng.uniform(0.2, 0.7), slip_torque=level,
                        slip_stiffness=level / (0.02 * at.reach))  # fmt: skip
    elif kind == "viscosity":
        fastest = 2.0 * math.pi * 0.15 * at.reach
        joint = replace(joint, viscous=at.full * rng.uniform(0.05, 0.2) / fastest)
    effects: tuple[str, ...] = ()
    if kind not in ("series_slip", "viscosity") and rng.random() < 0.5:
        effects, joint = ("coulomb_friction",), with_friction(rng, at, joint)
    how = bench(rng, at)
    if kind == "viscosity":
        how = replace(how, torque_driven=bool(rng.random() < 0.5))
    tests = plan(rng, at, joint, how.torque_driven)
    record = read(rng, [joint] * len(tests), tests, how)
    return Made(kind, record, effects, sizes(joint, effects), outside=kind)


def elastic_actuator(rng: Rng) -> Made:
    """A series elastic actuator: a soft spring, read by encoders of 14 bits on both sides, with the small hysteresis of
    its mounting and the motor's inertia left outside of its torque. A perfect spring, or one that stiffens."""
    k = log_uniform(rng, 3e4, 3e5)
    full = rng.uniform(0.1, 0.3) * k
    at = Plain(Joint(k, zero=rng.uniform(-0.05, 0.05), inertia=k / rng.uniform(60, 150) ** 2,
                     viscous=0.0005 * full), full, full / k)  # fmt: skip
    effects = ("joint_hardening",) if rng.random() < 0.5 else ()
    joint = with_hardening(rng, at, at.joint) if effects else at.joint
    how = Bench(False, 0.005, 2 * math.pi / 2**14, full * 0.004, full / 4096)
    tests = plan(rng, at, joint, False)
    return Made("elastic_actuator", read(rng, [joint] * len(tests), tests, how), effects, sizes(joint, effects))


# --- troubles of the instruments ------------------------------------------------------------------------------------


def coarse(rng: Rng, effects: tuple[str, ...] = ()) -> Made:
    """An encoder of 12 to 14 bits at the output itself: a count is 2 to 12 % of the reach."""
    at = plain(rng)
    count = 2 * math.pi / 2 ** int(rng.integers(12, 15))
    scale = max(1.0, count * rng.uniform(8, 25) / at.reach)
    at = Plain(replace(at.joint, stiffness=at.joint.stiffness / scale, inertia=at.joint.inertia / scale,
                       viscous=at.joint.viscous / scale, bristle=at.joint.bristle / scale),
               at.full, at.reach * scale)  # fmt: skip
    joint = at.joint
    for name in effects:
        joint = PUT_IN[name](rng, at, joint)
    how = replace(bench(rng, at), count_rad=count)
    tests = plan(rng, at, joint, how.torque_driven)
    record = read(rng, [joint] * len(tests), tests, how)
    return Made("+".join(("coarse_encoder", *effects)), record, effects, sizes(joint, effects),
                trouble="coarse_encoder", about={"count_rad": count})  # fmt: skip


def free_travel_left_in(rng: Rng) -> Made:
    """Between two tests the joint was unlocked and moved by 0.1 to 0.2 rad; these rows were left in the record."""
    made = ordinary(rng, "free_travel_left_in", ("coulomb_friction",))
    made.trouble = "free_travel_left_in"
    columns = made.record.columns
    tests = columns["test"]
    at = int(np.flatnonzero(tests == 1)[0])
    step_s = float(columns["t_s"][1] - columns["t_s"][0])
    count = int(min(1.8 / step_s, 400))  # in the pause before it
    level = made.size[f"{WHERE}.coulomb_n_mm"]
    travel = rng.uniform(0.1, 0.2) * rng.choice([-1.0, 1.0])
    t = columns["t_s"][at - 1] + step_s * np.arange(1, count + 1)
    to_and_fro = 0.5 * travel * (1.0 - np.cos(2 * math.pi * np.arange(count) / count))
    rubs = level * np.sign(np.gradient(to_and_fro)) + 0.02 * level * rng.standard_normal(count)
    new = {"t_s": t, "angle_rad": columns["angle_rad"][at - 1] + to_and_fro, "torque_n_mm": rubs,
           "test": np.zeros(count), "command_n_mm": np.zeros(count)}  # fmt: skip
    for name in columns:
        columns[name] = np.insert(columns[name], at, new[name])
    return made


# --- the list of known failures, rebuilt ----------------------------------------------------------------------------


def perfect_spring_12_bit(rng: Rng) -> Made:
    """A perfect spring, a 12-bit encoder at its output."""
    k, full = log_uniform(rng, 1e4, 1e5), 0.0
    count = 2 * math.pi / 4096
    full = k * count * rng.uniform(12, 40)
    joint = Joint(k, inertia=k / 200.0**2, viscous=full * 1e-4)
    how = Bench(False, 0.01, count, full * 0.002, 0.0)
    tests = [Test(full / k, 0.1, 2, "ramp") for _ in range(4)]
    return Made("perfect_spring_12_bit", read(rng, [joint] * 4, tests, how), (), sizes(joint, ()),
                trouble="coarse_encoder", evidence="perfect spring, 12-bit encoder")  # fmt: skip


def sine_over_play(rng: Rng) -> Made:
    """Torque-driven sine over 30 arcmin of play, with the little friction that every bearing has."""
    at = plain(rng)
    joint = with_friction(rng, at, replace(at.joint, gap=30 * ARCMIN), "lugre", False)
    joint = replace(joint, coulomb=0.02 * at.full, viscous=5 * joint.viscous)
    how = bench(rng, at, True)
    tests = [Test(at.full, 0.1, 3, "sine") for _ in range(4)]
    effects = ("backlash", "coulomb_friction")
    return Made("sine_over_play", read(rng, [joint] * 4, tests, how), effects, sizes(joint, effects),
                evidence="torque-driven sine over 30 arcmin of play")  # fmt: skip


def damper(rng: Rng) -> Made:
    """A friction damper: free travel at each reversal, in series with dry friction; at three amplitudes."""
    travel, level = rng.uniform(0.03, 0.08), log_uniform(rng, 2e3, 2e4)
    joint = Joint(1e-3 * level / travel, inertia=1.0, slip=travel, slip_torque=level,
                  slip_stiffness=level / (0.05 * travel))  # fmt: skip
    how = Bench(False, 0.008, 1.5e-5, 0.02 * level, 0.0)
    tests = [Test(travel * a, 0.5, 4, "sine") for a in (2.0, 4.0, 6.0)]
    return Made("damper", read(rng, [joint] * 3, tests, how), (), outside="damper",
                evidence="friction damper with free travel in series")  # fmt: skip


def standing_at_reversals(rng: Rng) -> Made:
    """A joint with friction that stands 2 to 5 s at each reversal, the torque held."""
    at = plain(rng)
    joint = with_friction(rng, at, at.joint, "lugre")
    how = bench(rng, at)
    tests = [replace(t, wave="ramp") for t in plan(rng, at, joint, how.torque_driven, rng.uniform(2.0, 5.0))]
    effects = ("coulomb_friction",)
    return Made("standing_at_reversals", read(rng, [joint] * len(tests), tests, how), effects, sizes(joint, effects),
                evidence="a joint standing at reversals")  # fmt: skip


def torque_50_ms_late(rng: Rng) -> Made:
    """A spring whose torque is read 50 ms late."""
    at = plain(rng)
    how = replace(bench(rng, at), late_s=0.05)
    tests = plan(rng, at, at.joint, how.torque_driven)
    return Made("torque_50_ms_late", read(rng, [at.joint] * len(tests), tests, how), (), sizes(at.joint, ()),
                trouble="lag", evidence="torque column 50 ms late", about={"late_s": 0.05})  # fmt: skip


def other_units(rng: Rng) -> Made:
    """Revolutions and N m in the columns of rad and N mm."""
    made = ordinary(rng, "other_units", ("coulomb_friction",))
    columns = made.record.columns
    columns["angle_rad"] = columns["angle_rad"] / (2 * math.pi)
    columns["torque_n_mm"] = columns["torque_n_mm"] / 1000.0
    if "command_n_mm" in columns:
        columns["command_n_mm"] = columns["command_n_mm"] / 1000.0
    made.trouble, made.evidence = "other_units", "revolutions and N m taken as rad and N mm"
    made.size = {}
    return made


def one_spring_at_four_amplitudes(rng: Rng) -> Made:
    """A spring that stiffens, with friction that grows with the load, measured at 1, 3, 5 and 9 N m."""
    k = log_uniform(rng, 5e5, 1.5e6)
    at = Plain(Joint(k, inertia=k / 150.0**2, viscous=5.0), 9000.0, 9000.0 / k)
    joint = with_hardening(rng, at, with_friction(rng, at, at.joint, "maxwell", True))
    how = bench(rng, at, True)
    tests = [Test(1000.0 * a, 0.1, 2, "ramp") for a in (1, 3, 5, 9) for _ in range(2)]
    effects = ("coulomb_friction", "joint_hardening")
    return Made("one_spring_at_four_amplitudes", read(rng, [joint] * len(tests), tests, how), effects,
                sizes(joint, effects), evidence="a spring measured at 1, 3, 5, 9 N m")  # fmt: skip


def one_spring_at_one_amplitude(rng: Rng) -> Made:
    """The same joint, measured at 1 N m alone, where its cubic part is nothing and friction carries most."""
    k = log_uniform(rng, 5e5, 1.5e6)
    at = Plain(Joint(k, inertia=k / 150.0**2, viscous=5.0), 9000.0, 9000.0 / k)
    joint = with_hardening(rng, at, with_friction(rng, at, at.joint, "maxwell", True))
    how = bench(rng, Plain(at.joint, 1000.0, 1000.0 / k), True)
    tests = [Test(1000.0, 0.1, 2, "ramp") for _ in range(4)]
    effects = ("coulomb_friction", "joint_hardening")
    return Made("one_spring_at_one_amplitude", read(rng, [joint] * 4, tests, how), effects, sizes(joint, effects),
                evidence="a spring measured at 1, 3, 5, 9 N m")  # fmt: skip


def small_ramps(rng: Rng) -> Made:
    """Friction and a spring, tested by small ramps: no gap is larger than the joint swung."""
    at = plain(rng)
    joint = with_friction(rng, at, at.joint, "maxwell", True)
    how = bench(rng, at, True)
    tests = [Test(0.15 * at.full, 0.1, 2, "ramp") for _ in range(5)]
    effects = ("coulomb_friction",)
    return Made("small_ramps", read(rng, [joint] * 5, tests, how), effects, sizes(joint, effects),
                evidence="a gap larger than the joint ever swung")  # fmt: skip


# --- several gear positions -----------------------------------------------------------------------------------------


def gear_positions(rng: Rng) -> Made:
    """One joint with play and friction at four to six gear positions, at each of which gap, stiffness and friction are
    a little other; the record has all but the last, and `left_out` has the last one's sizes. Angle zeros differ too."""
    at = plain(rng)
    base = with_play(rng, at, with_friction(rng, at, at.joint, "", None))
    spread = rng.uniform(0.03, 0.12)
    effects = ("backlash", "coulomb_friction")

    def one() -> Joint:
        a, b, c = np.exp(spread * rng.standard_normal(3))
        return replace(base, gap=base.gap * a, stiffness=base.stiffness * b, coulomb=base.coulomb * c,
                       zero=rng.uniform(-0.25, 0.25))  # fmt: skip

    places = [one() for _ in range(int(rng.integers(4, 7)))]
    how = bench(rng, at)
    joints, tests = [], []
    for joint in places[:-1]:
        for share in (0.4, 1.0):
            joints.append(joint)
            tests.append(Test(amplitude(at, joint, how.torque_driven, share), 0.1, 2, "ramp"))
    middle = {key: float(np.mean([sizes(j, effects)[key] for j in places[:-1]])) for key in sizes(base, effects)}
    return Made("gear_positions", read(rng, joints, tests, how), effects, middle,
                left_out=sizes(places[-1], effects),
                about={"spread": spread, "positions": len(places) - 1})  # fmt: skip


P, F, H, C = "backlash", "coulomb_friction", "joint_hardening", "creep"


def _kind(
    effects: tuple[str, ...], late: bool = False, law: str = "", load: bool | None = None
) -> Callable[[Rng], Made]:
    name = "+".join(effects) or "nothing"
    kind = name + (f"({law})" if law else "") + (", late" if late else "")
    return lambda rng: ordinary(rng, kind, effects, law, load, late)


def _outsider(kind: str) -> Callable[[Rng], Made]:
    return lambda rng: outsider(rng, kind)


Maker = Callable[[Rng], Made]
NAMED: dict[str, Maker] = {
    "nothing": _kind(()),
    "play": _kind((P,)),
    "lugre": _kind((F,), law="lugre"),
    "dahl": _kind((F,), law="dahl"),
    "maxwell": _kind((F,), law="maxwell", load=True),
    "hardening": _kind((H,)),
    "creep": _kind((C,)),
    "play_friction": _kind((P, F)),
    "play_maxwell": _kind((P, F), law="maxwell", load=True),
    "friction_hardening": _kind((F, H)),
    "play_hardening": _kind((P, H)),
    "all_three": _kind((P, F, H)),
    "elastic_actuator": elastic_actuator,
}
TROUBLED: dict[str, Maker] = {
    "late": _kind((), late=True),
    "play_late": _kind((P,), late=True),
    "friction_late": _kind((F,), late=True),
    "coarse": coarse,
    "coarse_friction": lambda rng: coarse(rng, (F,)),
    "coarse_play": lambda rng: coarse(rng, (P,)),
    "free_travel_left_in": free_travel_left_in,
}
OUTSIDE: dict[str, Maker] = {
    kind: _outsider(kind) for kind in ("cogging", "one_sided", "end_stop", "softening", "series_slip", "viscosity")
}
EVIDENCE: dict[str, Maker] = {
    maker.__name__: maker
    for maker in (
        perfect_spring_12_bit, sine_over_play, damper, standing_at_reversals, torque_50_ms_late, other_units,
        one_spring_at_four_amplitudes, one_spring_at_one_amplitude, small_ramps,
    )
}  # fmt: skip
POSITIONS: dict[str, Maker] = {"gear_positions": gear_positions}
