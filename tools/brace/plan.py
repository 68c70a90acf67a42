"""Where a foot should stand and how hard it should press: postures by what is asked of K, contact and payload.

K is the firmware's own, every gap closed. A position-controlled foot gets its force f by a set-point that lies off it
by the limb's yield, d = C f; an error e of position there (of foothold, set-point, a gap that opens) changes f by K e.
So a foot that is to bear such errors without sliding has to press against its surface, the harder the stiffer it is."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from brace.model import LimbModel
from brace.stiffness import PLANAR_C, PLANAR_K, PLANAR_REST, PlanarLimb, PostureError, planar_limb

KNEES = ("up", "down")
PREFERENCES = {  # what is best, and the column that says so; -1: more is better
    "firm": ("the largest lambda_min", "lambda_min_n_per_mm", -1),
    "soft": ("the smallest lambda_max", "lambda_max_n_per_mm", 1),
    "steady": ("the least sag under the payload", "sag_mm", 1),
    "light": ("the least force against the surface", "press_n", 1),
    "k": ("the K nearest to the one wanted", "off_n_per_mm", 1),
}


@dataclass(frozen=True)
class Wish:
    """What is asked for; what is None is not asked. Angles [rad] from +x."""

    x_mm: tuple[float, float] | None = None
    z_mm: tuple[float, float] | None = None
    knees: tuple[str, ...] = KNEES
    payload_n: float = 0.0  # weight on the foot
    normal_rad: float = math.pi / 2  # out of the surface, towards the limb
    friction_ratio: float | None = None  # above 0
    bears_mm: float = 0.0  # error of position, in any direction, that must not let the foot slide
    lambda_min_n_per_mm: float | None = None  # at least
    lambda_max_n_per_mm: float | None = None  # at most
    sag_most_mm: float | None = None
    press_most_n: float | None = None
    k_n_per_mm: tuple[float, float, float] | None = None  # xx, xz, zz


@dataclass(frozen=True)
class Demand:
    """One demand in words: which postures satisfy it, and the best that any of them does."""

    words: str
    satisfied: np.ndarray
    best: float


@dataclass(frozen=True)
class Plan:
    """Postures by column, one entry each, and what was asked of them."""

    columns: Mapping[str, np.ndarray]
    knee: np.ndarray
    demands: tuple[Demand, ...] = ()

    @property
    def count(self) -> int:
        """Number of postures looked at."""
        return len(self.knee)

    @property
    def kept(self) -> np.ndarray:
        """Those that satisfy every demand."""
        kept = np.ones(self.count, bool)
        for demand in self.demands:
            kept &= demand.satisfied
        return kept

    def best(self, prefer: str, most: int, apart_mm: float) -> list[int]:
        """Indices of the best postures that satisfy all, best first, their tips so far apart or their knees different.
        Of equals, that which bears more."""
        _, column, sign = PREFERENCES[prefer]
        order = np.lexsort((-np.nan_to_num(self.columns["bears_mm"]), sign * self.columns[column]))
        x, z = self.columns["x_mm"], self.columns["z_mm"]
        kept, chosen = self.kept, list[int]()
        for index in order[kept[order]].tolist():
            if len(chosen) == most:
                break
            if all(
                self.knee[index] != self.knee[other]
                or math.hypot(x[index] - x[other], z[index] - z[other]) >= apart_mm
                for other in chosen
            ):
                chosen.append(index)
        return chosen


def plan(model: LimbModel, wish: Wish, places: int) -> Plan:
    """About `places` places of the tip, with each knee that is asked for."""
    limb = planar_limb(model)
    reach = model.number("geometry.femur_mm") + model.number("geometry.tibia_mm")
    columns, knee = _postures(limb, model, _places(wish, reach, places), wish.knees)
    if not len(knee):
        return Plan(columns, knee)
    k = limb.stiffness(columns["theta1_true_rad"], columns["theta2_true_rad"])
    columns |= {name: k[name].astype(float) for name in (*PLANAR_K, *PLANAR_C, *PLANAR_REST)}
    columns |= _contact(columns, wish)
    if wish.k_n_per_mm is not None:
        off = [columns[name] - wanted for name, wanted in zip(PLANAR_K, wish.k_n_per_mm)]
        columns["off_n_per_mm"] = np.sqrt(off[0] ** 2 + 2 * off[1] ** 2 + off[2] ** 2)
    return Plan(columns, knee, _demands(columns, wish))


def _places(wish: Wish, reach_mm: float, places: int) -> np.ndarray:
    """Places of the tip [mm], one a row, evenly spread over what is allowed."""
    spans = [wish.x_mm or (0.0, reach_mm), wish.z_mm or (-reach_mm, reach_mm)]
    sizes = [high - low for low, high in spans]
    if min(sizes) > 0.0:
        step = math.sqrt(sizes[0] * sizes[1] / places)
        counts = [max(2, round(size / step)) for size in sizes]
    else:
        counts = [places if size > 0.0 else 1 for size in sizes]
    axes = [np.linspace(*span, count) for span, count in zip(spans, counts)]
    return np.stack([axis.ravel() for axis in np.meshgrid(*axes, indexing="ij")], 1)


def _postures(
    limb: PlanarLimb, model: LimbModel, places: np.ndarray, knees: tuple[str, ...]
) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """Postures that reach the places and lie within the joints' travel."""
    offsets = [model.number(f"joint.{joint}.zero_offset_rad") for joint in ("femur", "tibia")]
    travel = [
        tuple(model.number(f"motor.{joint}.angle_{end}_rad") for end in ("min", "max"))
        for joint in ("femur", "tibia")
    ]
    rows, knee = [], []
    for x, z in places.tolist():
        for bend in knees:
            try:
                true = limb.posture(math.hypot(x, z), math.atan2(z, x), bend)
            except PostureError:
                continue
            commanded = [angle - offset for angle, offset in zip(true, offsets)]
            if all(low <= angle <= high for angle, (low, high) in zip(commanded, travel)):
                rows.append((x, z, *commanded, *true))
                knee.append(bend)
    names = ("x_mm", "z_mm", "theta1_rad", "theta2_rad", "theta1_true_rad", "theta2_true_rad")
    table = np.array(rows, float).reshape(-1, len(names))
    return {name: table[:, index] for index, name in enumerate(names)}, np.array(knee, dtype=str)


def _contact(columns: Mapping[str, np.ndarray], wish: Wish) -> dict[str, np.ndarray]:
    """Sag under the payload; the force against the surface that the foothold needs beside it; where to set the tip.

    The friction cone's edges are g . f = 0, g = mu n + t and mu n - t. An error e changes g . f at most by |K g||e|."""
    count = len(columns["x_mm"])
    load = np.array([0.0, wish.payload_n])
    normal = np.round([math.cos(wish.normal_rad), math.sin(wish.normal_rad)], 12)  # a floor's has no x at all
    tangent = np.array([-normal[1], normal[0]])
    press, bears = np.zeros(count), np.full(count, np.nan)
    if wish.friction_ratio is not None:
        edges = [wish.friction_ratio * normal + side * tangent for side in (1.0, -1.0)]
        per_mm = [np.hypot(*_times(columns, PLANAR_K, edge)) for edge in edges]
        for edge, change in zip(edges, per_mm):
            press = np.maximum(press, (wish.bears_mm * change - edge @ load) / wish.friction_ratio)
        spare = [edge @ load + wish.friction_ratio * press for edge in edges]
        bears = np.maximum(np.minimum(spare[0] / per_mm[0], spare[1] / per_mm[1]), 0.0)
    force = load[:, None] + normal[:, None] * press
    yields = _times(columns, PLANAR_C, force)
    return {
        "sag_mm": np.hypot(*_times(columns, PLANAR_C, load)),
        "press_n": press,
        "bears_mm": bears,
        "force_x_n": force[0],
        "force_z_n": force[1],
        "set_x_mm": columns["x_mm"] - yields[0],
        "set_z_mm": columns["z_mm"] - yields[1],
    }


def _times(columns: Mapping[str, np.ndarray], entries: tuple[str, ...], vector: np.ndarray) -> np.ndarray:
    """K or C, by its entries xx, xz, zz, times a vector (or one vector a posture); rows x and z."""
    xx, xz, zz = (columns[name] for name in entries)
    return np.stack([xx * vector[0] + xz * vector[1], xz * vector[0] + zz * vector[1]])


def _demands(columns: Mapping[str, np.ndarray], wish: Wish) -> tuple[Demand, ...]:
    asked = (
        ("lambda_min at least", "N/mm", "lambda_min_n_per_mm", wish.lambda_min_n_per_mm, -1),
        ("lambda_max at most", "N/mm", "lambda_max_n_per_mm", wish.lambda_max_n_per_mm, 1),
        ("sag at most", "mm", "sag_mm", wish.sag_most_mm, 1),
        ("pressing with at most", "N", "press_n", wish.press_most_n, 1),
    )
    return tuple(
        Demand(
            f"{words} {bound:g} {unit}",
            sign * columns[column] <= sign * bound,
            float(sign * (sign * columns[column]).min()),
        )
        for words, unit, column, bound, sign in asked
        if bound is not None
    )
