"""Where a foot should stand and how hard it should press: postures by what is asked of K, contact and payload.

K is the firmware's own under the foot's force and the limb's weight, every gap closed. A position-controlled foot gets
its force f by a set-point that lies off it by the limb's yield under f; an error e of position there (of foothold,
set-point, a gap that opens) changes f by K e. So a foot that is to bear such errors without sliding has to press against
its surface, the harder the stiffer it is."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from brace.model import LimbModel
from brace.model.travel import KNEE_MOST_RAD, has_travel, within_travel
from brace.stiffness.at_rest import PlanarLimb, planar_limb
from brace.stiffness.names import PLANAR_C, PLANAR_K, PLANAR_REST
from brace.stiffness.under_load import LoadedLimb

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


ROUNDS = 8  # at most; each leaves about a fifth of the error, the tip's yield over the reach
SETTLED_MM = 1e-3


def plan(model: LimbModel, wish: Wish, places: int) -> Plan:
    """About `places` places of the tip, with each knee that is asked for."""
    limb = planar_limb(model)
    reach = model.number("geometry.femur_mm") + model.number("geometry.tibia_mm")
    spots = _places(wish, reach, places)
    spots, knee = np.repeat(spots, len(wish.knees), 0), np.tile(np.array(wish.knees, dtype=str), len(spots))
    true = limb.postures(spots, knee)
    kept = np.isfinite(true[:, 0])
    columns, stands = _standing(limb, LoadedLimb(model), wish, spots[kept], knee[kept], true[kept])
    knee = knee[kept][stands]
    offsets = [model.number(f"joint.{joint}.zero_offset_rad") for joint in ("femur", "tibia")]
    for name, offset in zip(("theta1", "theta2"), offsets):
        columns[f"{name}_rad"] = columns[f"{name}_true_rad"] - offset
    travelled = _within_travel(model, columns)
    columns, knee = {name: column[travelled] for name, column in columns.items()}, knee[travelled]
    if not len(knee):
        return Plan(columns, knee)
    if wish.k_n_per_mm is not None:
        off = [columns[name] - wanted for name, wanted in zip(PLANAR_K, wish.k_n_per_mm)]
        columns["off_n_per_mm"] = np.sqrt(off[0] ** 2 + 2 * off[1] ** 2 + off[2] ** 2)
    return Plan(columns, knee, _demands(columns, wish))


def _standing(
    limb: PlanarLimb, loaded: LoadedLimb, wish: Wish, place: np.ndarray, knee: np.ndarray, true: np.ndarray
) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """The limb as it stands: its tip at the place under the foot's force and its weight. The set-point and the force
    depend on K and on the yield there, and these on them, so they are found in rounds. Second: of which rows it stands.

    true: the angles that put the unloaded tip there, one row each."""
    stands = np.ones(len(place), bool)
    set_point, angles = place.copy(), true.copy()
    columns = _contact(_of_no_k(len(place)), wish)
    for _ in range(ROUNDS):
        force = columns["force_x_n"], columns["force_z_n"]
        found = loaded.stiffness(angles[:, 0], angles[:, 1], *force)
        moved = np.stack([found["tip_dx_mm"], found["tip_dz_mm"]], 1)
        stands &= np.isfinite(found["k_xx_n_per_mm"])
        columns = {name: found[name].astype(float) for name in (*PLANAR_K, *PLANAR_C, *PLANAR_REST)}
        columns["buckling_factor"] = found["buckling_factor"].astype(float)
        columns |= {"theta1_true_rad": angles[:, 0], "theta2_true_rad": angles[:, 1]}
        columns |= {"set_x_mm": set_point[:, 0], "set_z_mm": set_point[:, 1]} | _contact(columns, wish)
        before, set_point = set_point, place - np.where(stands[:, None], moved, 0.0)
        if not np.any(np.abs(set_point - before)[stands] > SETTLED_MM):
            break
        reached = limb.postures(set_point, knee)
        stands &= np.isfinite(reached[:, 0])
        angles = np.where(stands[:, None], reached, angles)
    columns |= {"x_mm": place[:, 0], "z_mm": place[:, 1]}
    columns["sag_mm"] = _sag_mm(loaded, wish, columns)
    return {name: column[stands] for name, column in columns.items()}, stands


def _of_no_k(count: int) -> dict[str, np.ndarray]:
    """Before the first round: the payload alone presses."""
    return {name: np.zeros(count) for name in (*PLANAR_K, *PLANAR_C)}


def _sag_mm(loaded: LoadedLimb, wish: Wish, columns: Mapping[str, np.ndarray]) -> np.ndarray:
    """How far the payload moves the tip of the limb as it is commanded, without the force against the surface."""
    angles = columns["theta1_true_rad"], columns["theta2_true_rad"]
    none = np.zeros(len(angles[0]))
    with_it, without = (loaded.stiffness(*angles, none, none + load) for load in (wish.payload_n, 0.0))
    dx_mm, dz_mm = (with_it[name].astype(float) - without[name] for name in ("tip_dx_mm", "tip_dz_mm"))
    return np.asarray(np.hypot(dx_mm, dz_mm))


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


def _within_travel(model: LimbModel, columns: Mapping[str, np.ndarray]) -> np.ndarray:
    """Of which postures both joints can be commanded there, and the knee does not fold through itself."""
    within = within_travel(model, {name: columns[name] for name in ("theta1_rad", "theta2_rad")})
    if not has_travel(model, "tibia"):
        within &= np.abs(columns["theta2_rad"]) <= KNEE_MOST_RAD
    return within


def _contact(columns: Mapping[str, np.ndarray], wish: Wish) -> dict[str, np.ndarray]:
    """The force against the surface that the foothold needs beside the payload, and what it bears.

    The friction cone's edges are g . f = 0, g = mu n + t and mu n - t. An error e changes g . f at most by |K g||e|."""
    count = len(columns["k_xx_n_per_mm"])
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
        with np.errstate(divide="ignore", invalid="ignore"):  # no K before the first round
            bears = np.maximum(np.minimum(spare[0] / per_mm[0], spare[1] / per_mm[1]), 0.0)
    force = load[:, None] + normal[:, None] * press
    return {"press_n": press, "bears_mm": bears, "force_x_n": force[0], "force_z_n": force[1]}


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
