"""K in space, of a limb whose coxa joint is fitted."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from brace.wire.codes import FLAG, PLAY
from brace.wire.layout import Value

_ENTRIES = ("xx", "xy", "xz", "yy", "yz", "zz")
_EIGENVALUES = {"lambda_1": "lambda_min", "lambda_2": "lambda_mid", "lambda_3": "lambda_max"}  # wire: brace k
_AXES = ("x", "y", "z")


@dataclass(frozen=True)
class SpaceStiffness:
    """K in the robot's base frame; None: not known."""

    k: tuple[Value, ...]  # N/mm: xx xy xz yy yz zz
    eigenvalues: tuple[Value, ...]  # N/mm, ascending
    flags: tuple[str, ...]
    stiff_axis: tuple[Value, ...] = ()  # unit vector; empty: not reported

    @property
    def is_valid(self) -> bool:
        """K may be used, with its flags."""
        return None not in self.k

    def as_json(self) -> dict[str, object]:
        """Names with units, as brace k uses them."""
        entry: dict[str, object] = {"k_is_valid": self.is_valid}
        entry |= {f"k_{name}_n_per_mm": value for name, value in zip(_ENTRIES, self.k, strict=True)}
        names = _EIGENVALUES.values()
        entry |= {f"{name}_n_per_mm": value for name, value in zip(names, self.eigenvalues, strict=True)}
        if self.stiff_axis:
            entry |= {f"stiff_axis_{name}": value for name, value in zip(_AXES, self.stiff_axis, strict=True)}
        return entry | {"flag_names": list(self.flags)}


@dataclass(frozen=True)
class SpaceAnswer(SpaceStiffness):
    """K in space where the limb need not be."""

    moved_mm: tuple[Value, ...] = ()  # by force and weight: outwards in the limb's plane, to its left, upwards


@dataclass(frozen=True)
class SpaceSnapshot(SpaceStiffness):
    """K in space of one tick."""

    theta0: Value = None  # rad, true angle of the coxa joint
    k_across: Value = None  # N/mm, across the limb's plane
    play_coxa: str = "unknown"

    def as_json(self) -> dict[str, object]:
        """With what the coxa joint does."""
        return super().as_json() | {
            "k_across_n_per_mm": self.k_across,
            "theta0_rad": self.theta0,
            "play_coxa": self.play_coxa,
        }


def space_answer(values: Mapping[str, Value], prefix: str = "", moved: str = "d") -> SpaceAnswer:
    """From the fields of an answer, or from registers, whose names begin with a prefix."""
    return SpaceAnswer(
        tuple(values[f"{prefix}k_{name}"] for name in _ENTRIES),
        tuple(values[f"{prefix}{name}"] for name in _EIGENVALUES),
        FLAG.names_of_bits(int(values[f"{prefix}flags"] or 0)),
        moved_mm=tuple(values[f"{prefix}{moved}{name}"] for name in _AXES),
    )


def space_snapshot(values: Mapping[str, Value], prefix: str = "") -> SpaceSnapshot:
    """From the fields of the frames, or from measured values, whose names begin with a prefix."""
    return SpaceSnapshot(
        tuple(values[f"{prefix}k_{name}"] for name in _ENTRIES),
        tuple(values[f"{prefix}{name}"] for name in _EIGENVALUES),
        FLAG.names_of_bits(int(values[f"{prefix}flags"] or 0)),
        tuple(values[f"{prefix}stiff_axis_{name}"] for name in _AXES),
        values["theta0"],
        values["k_across"],
        PLAY.word_of(int(values["play_coxa"] or 0)),
    )
