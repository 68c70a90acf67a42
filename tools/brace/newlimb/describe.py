"""What is known of a limb, as a commented limb.toml and as values."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from brace import toml
from brace.model import LimbModel
from brace.model.assumed_trust import ASSUMED
from brace.model.limb import limb_from_document
from brace.newlimb.quantity import Joint, Link

PLANE = ("femur", "tibia")
LEAST_REL = 0.05
SHARE = 0.05  # of C's trace: a part that contributes less does not decide the trust


@dataclass(frozen=True)
class Known:
    """Joints and links by name (coxa is optional); play and travel may be missing."""

    name: str
    lengths_mm: Mapping[str, float]
    links: Mapping[str, Link]
    joints: Mapping[str, Joint]
    plays_rad: Mapping[str, float | None] = field(default_factory=dict)
    travels_rad: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    source: str = ""
    notes: tuple[str, ...] = ()  # what the source left open and how it was understood
    down: tuple[float, float] | None = None  # gravity.direction_rad and lean_rad, where down is not -z


def compliance_rel(known: Known) -> float:
    """The trust in the compliances, as one number: that of the least known part that matters."""
    femur, tibia = known.lengths_mm["femur"], known.lengths_mm["tibia"]
    lever = {"femur": 0.7 * (femur + tibia), "tibia": tibia}
    parts = [
        (known.joints[name].compliance_rad_per_n_mm * lever[name] ** 2, known.joints[name].sigma_rel) for name in PLANE
    ]
    parts += [(known.links[name].compliances.bending_mm_per_n, known.links[name].sigma_rel) for name in PLANE]
    total = sum(size for size, _ in parts)
    return max([LEAST_REL, *(rel for size, rel in parts if size > SHARE * total)])


def play_rad(known: Known, name: str) -> float | None:
    """A joint's play: as it was said, else its servo's by the manual, else None."""
    held = known.joints[name].held
    said = known.plays_rad.get(name)
    return held.servo.play_rad if said is None and held else said


def guesses(known: Known) -> list[str]:
    """What nobody said or measured, one sentence each."""
    told = list(known.notes)
    for name, joint in known.joints.items():
        if joint.held and joint.held.servo.fit:
            told.append(
                f"joint.{name}: {joint.words}, by others' measurements of this servo ({joint.held.servo.source}), +- "
                f"{100 * joint.sigma_rel:.0f} %; proportional to gain and supply"
            )
        elif joint.held:
            told.append(
                f"joint.{name}: {joint.words} is a guess, +- {100 * joint.sigma_rel:.0f} %, from the stall torque in "
                f"the manual ({joint.held.servo.source}); proportional to gain and supply; a joint test measures it "
                "(docs/joint-tests.md)"
            )
        elif joint.guessed:
            told.append(f"joint.{name}: {joint.words} is a guess; a joint test measures it (docs/joint-tests.md)")
    told += [
        f"play of {name}: {joint.held.servo.play_arcmin:g} arcmin, by the manual of {joint.held.servo.name}; a worn "
        "gear has more"
        for name, joint in known.joints.items()
        if joint.held and known.plays_rad.get(name) is None
    ]
    for name, link in known.links.items():
        if link.is_beam:
            told.append(
                f"link.{name}: {link.words}, computed as a beam, +- {100 * link.sigma_rel:.0f} %; glue and screws make "
                "it softer, and are not counted"
            )
    unsaid = [name for name in known.joints if play_rad(known, name) is None]
    if unsaid:
        told.append(f"play of {' and '.join(unsaid)}: not given, so none is counted; gears have 1 to 60 arcmin")
    free = [name for name in known.joints if name not in known.travels_rad]
    if free:
        told.append(
            f"travel of {' and '.join(free)}: not given; brace plan only keeps the knee from folding through itself"
        )
    return told


def text(known: Known) -> str:
    """The limb.toml."""
    lines = [
        f"# Written by brace new{f' from {known.source}' if known.source else ''}. docs/limb-keys.md has all keys."
    ]
    lines += [f"# {sentence}" for sentence in guesses(known)]
    lines += ["format = 1", f'name = "{_escaped(known.name)}"', "", "[geometry]"]
    if "coxa" in known.lengths_mm:
        lines.append(f"coxa_mm = {known.lengths_mm['coxa']!r}")
    lines += [f"{name}_mm = {known.lengths_mm[name]!r}" for name in PLANE]
    for name, link in known.links.items():
        c = link.compliances
        lines += ["", f"[link.{name}]  # {link.words}"]
        lines += [f"axial_mm_per_n = {c.axial_mm_per_n:.6g}", f"bending_mm_per_n = {c.bending_mm_per_n:.6g}"]
        lines += [
            "# across the limb's plane; brace sim gives a coxa joint to a limb that yields there",
            f"lateral_mm_per_n = {c.lateral_mm_per_n:.6g}",
            f"torsion_rad_per_n_mm = {c.torsion_rad_per_n_mm:.6g}",
        ]
        if link.is_beam and name in PLANE:
            lines.append("moment_transfer = true  # a uniform beam: force and moment bend it together")
    for name, joint in known.joints.items():
        lines += ["", f"[joint.{name}]  # {joint.words}{', A GUESS' if joint.guessed else ''}"]
        lines.append(f"compliance_rad_per_n_mm = {joint.compliance_rad_per_n_mm:.6g}")
        play = play_rad(known, name)
        if play is None:
            lines.append("# gap_rad = 0.0  # the full play was not said: 20 arcmin are 0.00582 rad")
        else:
            lines.append(f"gap_rad = {play:.6g}  # {math.degrees(play) * 60:.3g} arcmin of play")
    for name in known.joints:
        lines += _motor(known, name)
    if known.down:
        lines += ["", "[gravity]  # down as the robot stands, with the coxa joint at zero"]
        lines += [f"direction_rad = {known.down[0]!r}", f"lean_rad = {known.down[1]!r}"]
    lines += [
        "",
        "[uncertainty]  # one sigma of what is trusted above; measure the limb and run brace identify for better "
        "numbers",
        f"length_mm = {ASSUMED['uncertainty.length_mm']!r}",
        f"angle_rad = {ASSUMED['uncertainty.angle_rad']!r}",
        f"compliance_rel = {compliance_rel(known):.3g}",
        f"gain_rel = {ASSUMED['uncertainty.gain_rel']!r}",
    ]
    return "\n".join(lines) + "\n"


def _motor(known: Known, name: str) -> list[str]:
    """The lines of [motor.*]: travel, and what is known of the servo."""
    travel, held = known.travels_rad.get(name), known.joints[name].held
    if travel is None and held is None:
        return []
    lines = ["", f"[motor.{name}]" + (f"  # {held.servo.name}: {held.servo.manual}" if held else "")]
    if travel:
        degrees = " to ".join(f"{math.degrees(end):.4g}" for end in travel)
        lines += [f"angle_min_rad = {travel[0]:.6g}  # travel {degrees} deg", f"angle_max_rad = {travel[1]:.6g}"]
    if held:
        servo, stall_n_mm = held.servo, 1e3 * held.servo.stall_torque_n_m
        lines += [
            f"torque_range_n_mm = {stall_n_mm:g}  # stall torque at {servo.supply_v:g} V",
            f"takeup_torque_n_mm = {stall_n_mm / 2:g}  # half of it",
            f"angle_step_rad = {servo.angle_step_rad:.6g}  # {servo.steps_per_turn} steps a turn",
            f"# friction: {servo.fit.source if servo.fit else 'A GUESS, between those of servos that were measured'}",
            *(f"{key} = {value:g}" for key, value in servo.motor_friction.items()),
        ]
    return lines


def model(known: Known, path: Path) -> LimbModel:
    """The same as the other commands read it."""
    return limb_from_document(toml.parse(text(known), path, "limb model"))


def posture_rad(known: Known) -> tuple[float, float]:
    """A posture to tell K at: the middle of the travel, else a leg half bent."""
    middle = {name: (low + high) / 2 for name, (low, high) in known.travels_rad.items()}
    theta2 = middle.get("tibia", math.pi / 2)
    return middle.get("femur", theta2 / 2), theta2 if abs(theta2) > 0.3 else 0.3


def _escaped(name: str) -> str:
    return "".join(c for c in name if c.isprintable()).replace("\\", "\\\\").replace('"', '\\"')
