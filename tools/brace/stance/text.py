"""The answers of `brace stance` as lines of text."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from brace.stance.answer import FACTOR_MOST, Answer, FirstSlip, OverloadedError
from brace.stance.choose import Choice
from brace.stance.histories import Ranges
from brace.stance.lift import Lifted
from brace.stance.setpoints import SetPoints
from brace.stance.stance_file import Stance
from brace.stance.view import N_MM_PER_N_M, View
from brace.stance.world import NoStanceError


def _two(value: float) -> str:
    """Two decimals; what is rounded to nothing has no sign."""
    return f"{round(float(value), 2) + 0.0:.2f}"


def loaded(answer: Answer) -> str:
    """`brace stance load`."""
    width = max(len(limb.name) for limb in answer.stance.limbs)
    lines = [f"{answer.stance.name}: the ground's force on each foot [N], with 90 % between"]
    for i, limb in enumerate(answer.stance.limbs):
        parts = [
            f"{axis} {_two(answer.force_n[i][j]):>8} "
            f"({_two(answer.force_low_n[i][j])} to {_two(answer.force_high_n[i][j])})"
            for j, axis in enumerate("xyz")
        ]
        held = f"{answer.state[i]}, margin {_two(answer.margin_n[i])} N"
        lines.append(f"  {limb.name:{width}}  {'  '.join(parts)}  {held}")
    lines.append("what the payload changes [N], with 90 % between")
    lines += changes(answer.stance, answer.change_n, answer.change_low_n, answer.change_high_n)
    moved = " ".join(_two(part) for part in answer.displacement_mm)
    turned = " ".join(_two(part * 1000.0) for part in answer.rotation_rad)
    lines.append(f"the payload moves the body by {moved} mm and turns it by {turned} mrad (x, y, z)")
    lines.append(first_slip_words(answer.first_slip))
    return "\n".join([*lines, *(f"note: {flag}" for flag in answer.flags)])


def changes(stance: Stance, change_n: np.ndarray, low_n: np.ndarray, high_n: np.ndarray) -> list[str]:
    """A line a limb; arrays have a row a limb."""
    width = max(len(limb.name) for limb in stance.limbs)
    lines = []
    for limb, change, low, high in zip(stance.limbs, change_n, low_n, high_n, strict=True):
        parts = [f"{axis} {_two(change[j]):>8} ({_two(low[j])} to {_two(high[j])})" for j, axis in enumerate("xyz")]
        lines.append(f"  {limb.name:{width}}  {'  '.join(parts)}")
    return lines


def first_slip_words(slip: FirstSlip) -> str:
    """Which foot moves first, in words."""
    if slip.limb is None or slip.payload_factor is None or slip.low is None or slip.high is None:
        return f"no foot slides or lets go up to {FACTOR_MOST:g} times the payload"
    surely = f", first in {100.0 * slip.surely:.0f} % of what may be" if slip.surely is not None else ""
    high = f"{slip.high:.2f}" if slip.high < FACTOR_MOST else "more"
    return (
        f"first to slide or let go: {slip.limb}, at {slip.payload_factor:.2f} times the payload "
        f"({slip.low:.2f} to {high}{surely})"
    )


def shown(view: View) -> str:
    """`brace stance show`."""
    width = max(len(limb.name) for limb in view.stance.limbs)
    lines = [f"{view.stance.name}: feet [mm], K's eigenvalues [N/mm], the ground's force under the weight [N]"]
    for i, limb in enumerate(view.stance.limbs):
        foot = " ".join(f"{part:7.1f}" for part in view.foot_mm[i])
        stiffness = " ".join(f"{part:7.3f}" for part in np.linalg.eigvalsh(view.k_n_per_mm[i]))
        force = " ".join(f"{part:7.2f}" for part in view.force_n[i])
        lines.append(f"  {limb.name:{width}}  {foot}   {stiffness}   {force}")
    give = np.diag(view.give)
    moved = " ".join(f"{part:.3f}" for part in give[:3])
    turned = " ".join(f"{part * N_MM_PER_N_M * 1000.0:.2f}" for part in give[3:])
    lines.append(
        f"the body gives way by {moved} mm for each newton in x, y, z, and by {turned} mrad for each N m about them"
    )
    return "\n".join(lines)


def lifted(found: Sequence[Lifted]) -> str:
    """`brace stance lift`."""
    lines = []
    for one in found:
        if one.reason:
            lines.append(f"without {one.name}: the body does not stand: {one.reason}")
            continue
        names = [limb.name for limb in one.stance.limbs]
        least = min((m, name) for m, name in zip(one.margin_n, names, strict=True) if name != one.name)
        moved = " ".join(_two(part) for part in one.moved_mm)
        slid = f"; {', '.join(one.slides)} slides" if one.slides else ""
        slid += f"; stands in {100.0 * one.stands_in:.0f} % of what may be" if one.stands_in < 1.0 else ""
        lines.append(
            f"without {one.name}: stands; the body moves by {moved} mm; "
            f"least margin {_two(least[0])} N at {least[1]}{slid}"
        )
    return "\n".join(lines)


def ranged(found: Ranges) -> str:
    """`brace stance range`."""
    width = max(len(limb.name) for limb in found.stance.limbs)
    lines = ["force of the ground on each foot over every history, least to most [N, body's frame]; pressing"]
    for i, limb in enumerate(found.stance.limbs):
        ends = [*zip(found.low_n[i], found.high_n[i], strict=True), (found.pressing_low_n[i], found.pressing_high_n[i])]
        words = "   ".join(f"{_end(low):>7} to {_end(high):>7}" for low, high in ends)
        lines.append(f"  {limb.name:{width}}  {words}")
    if found.payload_factor is not None:
        lines.append(f"no forces bear more than {_two(found.payload_factor)} times the payload")
    return "\n".join(lines)


def _end(value: float) -> str:
    return _two(value) if math.isfinite(value) else "no end"


def set_points(found: SetPoints) -> str:
    """`brace stance set`."""
    width = max(len(limb.name) for limb in found.stance.limbs)
    lines = ["move the tips' set-points [mm, body's frame]; angles to command [rad]; the ground's force then [N]"]
    for i, limb in enumerate(found.stance.limbs):
        way = " ".join(f"{_two(part):>6}" for part in found.way_mm[i])
        theta = " ".join(f"{part:8.5f}" for part in found.theta_rad[i])
        force = " ".join(f"{_two(part):>7}" for part in found.after_n[i])
        margin = f"margin {_two(found.margin_before_n[i])} -> {_two(found.margin_after_n[i])} N"
        lines.append(f"  {limb.name:{width}}  {way}   {theta}   {force}   {margin}")
    moved = " ".join(_two(part) for part in found.displacement_mm)
    lines.append(f"the body is then {moved} mm from where it is without load")
    lines.append("then in stance.toml, beside the new theta_rad, foothold.offset_mm =")
    for i, limb in enumerate(found.stance.limbs):
        lines.append(f"  {limb.name:{width}}  [{', '.join(_two(part) for part in found.offset_mm[i])}]")
    if found.change_low_n is not None and found.change_high_n is not None:
        lines.append("what that changes [N], with 90 % between")
        lines += changes(found.stance, found.change_n, found.change_low_n, found.change_high_n)
    return "\n".join([*lines, *(f"note: {joint} leaves its travel" for joint in found.beyond)])


def chosen(found: Sequence[Choice]) -> str:
    """`brace stance choose`."""
    lines = ["the best first; angles to command [rad]"]
    for one in found:
        theta = " ".join(f"{part:8.5f}" for part in one.theta_rad)
        if one.reason:
            lines.append(f"  {one.foothold:12}  {theta}   no: {one.reason}")
            continue
        first = "no foot moves" if one.slip_limb is None else (
            f"{one.slip_limb} moves first, at {_two(one.payload_factor)} times the payload")  # fmt: skip
        lines.append(
            f"  {one.foothold:12}  {theta}   {first}; least margin {_two(one.margin_n)} N at {one.margin_limb}; "
            f"sag {_two(one.sag_mm)} mm"
        )
    return "\n".join(lines)


def reason(path: str, error: NoStanceError) -> str:
    """Why there is no such stance."""
    of = "payload" if error.is_payload else "weight"
    said = f"{path}: {error.why}; {100.0 * error.share:.1f} % of the {of} is borne"
    return f"{said}; {first_slip_words(error.first_slip)}" if isinstance(error, OverloadedError) else said
