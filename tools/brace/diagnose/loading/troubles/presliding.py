"""Friction that is strained before it slides: what it adds to the readings of a loading record.

Generalised Maxwell slip without its part that depends on speed (Al-Bender, Lampaert, Swevers 2005): springs side by
side that each slide from their own strain on. As a function of the way that a joint would go without friction it is a
sum of stop operators (Prandtl, Ishlinskii), also where the joint's spring and the limb yield beside it, because the
inverse of such a sum is one. LuGre's and Dahl's bristles come near it. The sizes are linear, so that columns beside the
readings hold them.

A joint that rings after each step of the rig shakes a part of its friction off. What is left turns with the first step
back, however short that is, because the joint passes its place at every step; and how much is left differs from posture
to posture, because the held tip stiffens the joint by another amount. No law of joints at rest has either."""

from __future__ import annotations

import numpy as np

from brace.dataset.check_runs import run_starts
from brace.diagnose.loading.fit import Fit
from brace.identify.noise import FORCES
from brace.identify.record import Record, levers
from brace.native.plant_batch import number_index

JOINTS = ("femur", "tibia")
STRAINS = tuple(0.6 * 1.7**-step for step in range(9))  # of a joint's largest way: where elements begin to slide
TURNED = 0.1  # of a joint's largest way: what a size of 1 holds of friction that turns with each step
STILL = 1e-3  # of a joint's largest way: a shorter step turns nothing
SHARP = 2  # of the elements, the last ones: what dry friction is made of, beside what turns with each step
LEAST_WAY_RAD = 1e-9


def sliding_rad(record: Record, way_rad: np.ndarray) -> np.ndarray:
    """By how much each element holds a joint back on its way, rows x STRAINS [rad], for each size of 1; not beyond its
    strain."""
    most = max(float(np.abs(way_rad).max()), LEAST_WAY_RAD) * np.array(STRAINS)
    held = np.zeros((way_rad.size, most.size))
    element = np.zeros(most.size)
    for row, (step, begins) in enumerate(zip(*_steps(record, way_rad))):
        element = np.clip((0.0 if begins else element) + step, -most, most)
        held[row] = element
    return held


def turned_rad(record: Record, way_rad: np.ndarray) -> np.ndarray:
    """By how much friction that turns with each step holds a joint back on its way, rows [rad], for a size of 1."""
    most = max(float(np.abs(way_rad).max()), LEAST_WAY_RAD)
    held, at = np.zeros(way_rad.size), 0.0
    for row, (step, begins) in enumerate(zip(*_steps(record, way_rad))):
        if abs(step) > STILL * most:
            at = float(np.sign(step))
        elif begins:
            at = 0.0
        held[row] = TURNED * most * at
    return held


def _steps(record: Record, way_rad: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """How far the joint went since the row before, and where a run begins: there it rested at 0 before."""
    begins = np.zeros(way_rad.size, dtype=bool)
    begins[run_starts(record.dataset["run"])[:-1]] = True
    return np.where(begins, way_rad, np.diff(way_rad, prepend=0.0)), begins


def presliding_columns(record: Record, fitted: Fit, joint: str, stiffness: np.ndarray) -> np.ndarray:
    """Channels x rows x STRAINS. `stiffness`: K at each row's posture, forces x rows x displacements [N/mm]."""
    return _pushed(record, fitted, joint, stiffness, sliding_rad(record, _way_rad(record, fitted, joint)))


def turned_columns(record: Record, fitted: Fit, joint: str, stiffness: np.ndarray) -> np.ndarray:
    """The same of friction that turns with each step, channels x rows x 1."""
    return _pushed(record, fitted, joint, stiffness, turned_rad(record, _way_rad(record, fitted, joint))[:, None])


def by_place(record: Record, columns: np.ndarray) -> np.ndarray:
    """Columns of one size (channels x rows) once for each posture and axis, channels x rows x places."""
    places = np.stack([record.dataset["config"], record.dataset["axis"]])
    here = np.unique(places, axis=1, return_inverse=True)[1].ravel()
    return np.asarray(columns[:, :, None] * (here[:, None] == np.arange(here.max() + 1)))


def _pushed(record: Record, fitted: Fit, joint: str, stiffness: np.ndarray, held: np.ndarray) -> np.ndarray:
    """What the readings show of a joint that is held back by `held` (rows x sizes, rad)."""
    arms = _arms_mm(record, fitted)
    forces = np.einsum("frd,dr,rs->frs", stiffness, arms[joint], held)
    out = np.zeros((len(record.channels), *held.shape))
    out[: len(FORCES)] = forces
    played = record.player.play_numbers(fitted.model[None])[0]
    for place, name in enumerate(record.channels[len(FORCES) :], start=len(FORCES)):
        if name.startswith("base"):
            axis = "xz".index(name.removeprefix("base_")[0])
            out[place] = _number(fitted, f"base.{name.removeprefix('base_')[0]}_mm_per_n") * forces[axis]
            continue
        other = JOINTS[("enc1_rad", "enc2_rad").index(name)]
        yields = _number(fitted, f"joint.{other}.compliance_rad_per_n_mm")
        turned = yields * np.einsum("fr,frs->rs", arms[other], forces)
        way = _way_rad(record, fitted, other)
        reads = 1.0 if float(played[place] @ way) >= 0.0 else -1.0  # an encoder may count the other way round
        out[place] = reads * (turned - held if other == joint else turned)
    if record.zeroed:
        starts = run_starts(record.dataset["run"])
        for place in record.zeroed:
            out[place] -= np.repeat(out[place][starts[:-1]], np.diff(starts), axis=0)
    return out


def friction_n_mm(record: Record, fitted: Fit, joint: str) -> np.ndarray:
    """The torque that each element, and behind them what turns with each step, holds against on the mean of the joint's
    ways, for a size of 1: the work that it takes over the way. An element that never slides takes none."""
    way = _way_rad(record, fitted, joint)
    steps, _ = _steps(record, way)
    held = np.column_stack([sliding_rad(record, way), turned_rad(record, way)])
    work = held.T @ steps / max(float(np.abs(steps).sum()), LEAST_WAY_RAD)
    return np.asarray(work / _number(fitted, f"joint.{joint}.compliance_rad_per_n_mm"))


def can_rub(record: Record, fitted: Fit, joint: str) -> bool:
    """Whether friction can be sought there: a joint that yields, and has no friction in the model yet."""
    keys = {key for variant in fitted.space.variants for key in variant.keys}
    plain = f"joint.{joint}.coulomb_n_mm"
    return (
        plain not in keys
        and _number(fitted, plain) == 0.0
        and _number(fitted, f"joint.{joint}.compliance_rad_per_n_mm") > 0.0
        and float(np.abs(_way_rad(record, fitted, joint)).max()) > LEAST_WAY_RAD
    )


def _way_rad(record: Record, fitted: Fit, joint: str) -> np.ndarray:
    """How far the joint would yield without friction."""
    forces = record.player.play_numbers(fitted.model[None])[0, : len(FORCES)]
    torque = np.sum(_arms_mm(record, fitted)[joint] * forces, axis=0)
    return np.asarray(_number(fitted, f"joint.{joint}.compliance_rad_per_n_mm") * torque)


def _arms_mm(record: Record, fitted: Fit) -> dict[str, np.ndarray]:
    femur_mm, tibia_mm = (_number(fitted, f"geometry.{link}_mm") for link in JOINTS)
    return levers(femur_mm, tibia_mm, record.dataset["theta1_rad"], record.dataset["theta2_rad"])


def _number(fitted: Fit, key: str) -> float:
    return float(fitted.model[number_index()[key]])
