"""K in space as a person reads it."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from brace.bus.space import SpaceSnapshot, SpaceStiffness
    from brace.wire.layout import Value

_ROWS = ((0, 1, 2), (1, 3, 4), (2, 4, 5))  # of xx xy xz yy yz zz


def space_lines(stiffness: SpaceStiffness) -> list[str]:
    """K, eigenvalues, stiff axis and flags."""
    if not stiffness.is_valid:
        return ["K in space not valid", *_flags(stiffness)]
    rows = "; ".join(" ".join(_number(stiffness.k[place]) for place in row) for row in _ROWS)
    lines = [f"K in space = [{rows}] N/mm"]
    if None not in stiffness.eigenvalues:
        values = [_number(value) for value in stiffness.eigenvalues]
        lines.append(f"eigenvalues {values[0]}, {values[1]} and {values[2]} N/mm")
    if stiffness.stiff_axis and None not in stiffness.stiff_axis:
        lines.append(f"stiff axis ({', '.join(_number(value) for value in stiffness.stiff_axis)})")
    return lines + _flags(stiffness)


def coxa_lines(space: SpaceSnapshot) -> list[str]:
    """What the coxa joint does."""
    theta0 = "not known" if space.theta0 is None else f"{space.theta0:.5f} rad"
    across = "not known" if space.k_across is None else f"{space.k_across:.4f} N/mm"
    return [f"theta0 {theta0}; K across the limb's plane {across}; play coxa {space.play_coxa}"]


def space_words(space: SpaceSnapshot) -> list[str]:
    """The same in few words, for a line that has more to report: the six entries row by row."""
    if not space.is_valid:
        return ["K in space not valid"]
    return [f"K in space {' '.join(_number(value) for value in space.k)} N/mm", *space.flags]


def _flags(stiffness: SpaceStiffness) -> list[str]:
    return [f"flags in space {' '.join(stiffness.flags)}"] if stiffness.flags else []


def _number(value: Value) -> str:
    return "not known" if value is None else f"{value:.4f}"
