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


def guesses(known: Known) -> list[str]:
    """What nobody said, one sentence each."""
    told = list(known.notes)
    told += [
        f"joint.{name}: {joint.words} is a guess; a joint test measures it (docs/joint-tests.md)"
        for name, joint in known.joints.items()
        if joint.guessed
    ]
    for name, link in known.links.items():
        if link.is_beam:
            told.append(
                f"link.{name}: {link.words}, computed as a beam, +- {100 * link.sigma_rel:.0f} %; glue and screws make "
                "it softer, and are not counted"
            )
    unsaid = [name for name in known.joints if known.plays_rad.get(name) is None]
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
        play = known.plays_rad.get(name)
        if play is None:
            lines.append("# gap_rad = 0.0  # the full play was not said: 20 arcmin are 0.00582 rad")
        else:
            lines.append(f"gap_rad = {play:.6g}  # {math.degrees(play) * 60:.3g} arcmin of play")
    for name, (low, high) in known.travels_rad.items():
        lines += ["", f"[motor.{name}]  # travel {math.degrees(low):.4g} to {math.degrees(high):.4g} deg"]
        lines += [f"angle_min_rad = {low:.6g}", f"angle_max_rad = {high:.6g}"]
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
