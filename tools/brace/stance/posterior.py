"""What the feet may bear before a payload, once their forces were measured: draws of the posterior.

Unknown are the feet's places v, a Gaussian of footholds and zeros, and in each drawn world the limbs' springs. Where a
joint has play a force follows from a place only by search, and many places have the same force. The reverse is a
formula: a force f on a foot puts the tip at D(f), plays included, and the body's pose u moves all feet by G u. So
forces are drawn that balance the weight, f = f0 + N a with G'N = 0; the density of a is

    N(measured - f; R)  N(D(f) + G u - v; P), u integrated out  |det N' C(f) N|

R is the sensors' covariance, P the places'. C, D's slope, is large within a play: the determinant counts how many
places lead to a force (change of variables). A foot's force lies in its friction cone.

One Markov chain a world, of preconditioned Crank-Nicolson steps (Cotter, Roberts, Stuart and White, Statistical Science
28, 2013) from the Gaussian that is the posterior if a play is a Gaussian, too.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from statistics import NormalDist

import numpy as np

from brace.stance.limb_law import GivesWayError, cross
from brace.stance.world import Measured, World

_STEPS = 400  # 100 give the same quantiles, within those of 100 draws
_STEP_SIZES = (1.0, 0.6, 0.3, 0.1)  # of the Gaussian's sigma; small ones where plays make the density steep
_EDGE_SHARE = 0.1  # of a reading's sigma: how sharply a cone ends
_HOLD_LEAST = 3  # feet
_OF_WORLD_AND_LIMB = (
    "compliance", "moved_mm", "tip_mm", "turns", "half_rad", "closing_n_mm", "weight_n_mm", "friction"
)  # fmt: skip
_BALANCING = 2  # rounds: a foot's place, and so its lever, depends on its force


def likely_forces(
    worlds: Sequence[World], middle: World, measured: Measured, chance: np.random.Generator
) -> tuple[list[World], np.ndarray]:
    """One draw for each world: the ground's forces on its feet [N], world x limb x 3; exactly 0 for a foot that has let
    go. Worlds in which a limb gives way under the measured forces are left out. middle: the believed world, whose
    places and their covariance count.

    Cost: 0.5 s on one x86 core for 100 worlds of six limbs."""
    limbs, those = _limbs_of(worlds, middle, measured)
    if not those:
        return [], np.empty((0, *measured.force_n.shape))
    has_let_go = chance.random((len(those), len(middle.laws))) < _let_go_probability(limbs, measured)
    has_let_go[(~has_let_go).sum(axis=1) < _HOLD_LEAST] = False
    forces = np.zeros(has_let_go.shape + (3,))
    for gone in np.unique(has_let_go, axis=0):
        rows, bear = np.flatnonzero((has_let_go == gone).all(axis=1)), np.flatnonzero(~gone)
        forces[np.ix_(rows, bear)] = _Chains(limbs.take(rows, bear)).run(chance)
    return those, forces


def _limbs_of(worlds: Sequence[World], middle: World, measured: Measured) -> tuple[_Limbs, list[World]]:
    springs, those = [], []
    for world in worlds:
        try:
            springs.append([law.without_play(force) for law, force in zip(world.laws, measured.force_n, strict=True)])
            those.append(world)
        except GivesWayError:
            continue
    laws = [world.laws for world in those]
    return _Limbs(
        np.linalg.inv(np.array([[k for k, _ in row] for row in springs]).reshape(len(those), -1, 3, 3)),
        np.array([[moved for _, moved in row] for row in springs]),
        np.array([[law.tip_mm for law in row] for row in laws]),
        np.array([[law.turns_in_body() for law in row] for row in laws]),
        np.array([[law.half_rad for law in row] for row in laws]),
        np.array([[law.closing_n_mm for law in row] for row in laws]),
        np.array([[law.weight_n_mm for law in row] for row in laws]),
        np.array([[contact.friction_ratio for contact in world.contacts] for world in those]),
        np.array([sum((_wrench(*one) for one in world.weight), np.zeros(6)) for world in those]),
        measured.force_n,
        np.array(measured.covariance_n2),
        middle.offset_mm,
        np.array(middle.place_covariance),
        np.array([law.play_covariance_mm2() for law in middle.laws]),
        np.array([contact.normal for contact in middle.contacts]),
        np.array([contact.grip_n for contact in middle.contacts]),
    ), those


@dataclass(frozen=True)
class _Limbs:
    """Limbs under the measured forces. Of each world, then of each limb: compliance and displacement without play, tips
    without load, how the joints turn them, play, loads that close it, the weight's loads, friction; of each world the
    weight. The rest is of each limb."""

    compliance: np.ndarray
    moved_mm: np.ndarray
    tip_mm: np.ndarray
    turns: np.ndarray
    half_rad: np.ndarray
    closing_n_mm: np.ndarray
    weight_n_mm: np.ndarray
    friction: np.ndarray
    wrench: np.ndarray
    measured_n: np.ndarray
    noise_n2: np.ndarray
    offset_mm: np.ndarray
    place_mm2: np.ndarray
    play_mm2: np.ndarray
    normal: np.ndarray
    grip_n: np.ndarray

    def take(self, rows: np.ndarray, limbs: np.ndarray) -> _Limbs:
        """Some worlds, and in them some limbs."""
        both, one = np.ix_(rows, limbs), {"wrench": self.wrench[rows]}
        one |= {name: getattr(self, name)[both] for name in _OF_WORLD_AND_LIMB}
        rest = [field.name for field in fields(self) if field.name not in one]
        return replace(self, **one, **{name: getattr(self, name)[limbs] for name in rest})

    @property
    def balance(self) -> np.ndarray:
        """6 x 3 n: force and moment of the feet's forces."""
        return np.concatenate([_wrench_of(at) for at in (self.tip_mm + self.moved_mm).mean(axis=0)], axis=1)


def _let_go_probability(limbs: _Limbs, measured: Measured) -> np.ndarray:
    """That a foot with a grip was pulled off as the weight came, and that is why it bears nothing that sensors see."""
    balance, compliance = limbs.balance, _block(limbs.compliance.mean(axis=0))
    stiffness = _free_of_pose(compliance, balance)  # of the feet's places, the body free
    start = measured.force_n.ravel()
    start = start - np.linalg.pinv(balance) @ (limbs.wrench.mean(axis=0) + balance @ start)
    left = (
        limbs.moved_mm.mean(axis=0).ravel() + compliance @ (start - measured.force_n.ravel()) - limbs.offset_mm.ravel()
    )
    if_held = (start - stiffness @ left).reshape(-1, 3)
    covariance = stiffness @ _block(limbs.place_mm2 + limbs.play_mm2) @ stiffness
    found = np.zeros(len(if_held))
    for limb in np.flatnonzero(limbs.grip_n > 0.0):
        block = slice(3 * limb, 3 * limb + 3)
        of_force, noise, normal = covariance[block, block], limbs.noise_n2[limb], limbs.normal[limb]
        spread_n = max(float(np.sqrt(normal @ of_force @ normal)), 1e-9)
        before = NormalDist().cdf((-limbs.grip_n[limb] - float(normal @ if_held[limb])) / spread_n)
        gone = before * _density(measured.force_n[limb], noise)
        holds = (1.0 - before) * _density(measured.force_n[limb] - if_held[limb], of_force + noise)
        found[limb] = gone / (gone + holds) if gone > 0.0 else 0.0
    return found


def _density(off: np.ndarray, covariance: np.ndarray) -> float:
    """Of a Gaussian, up to a constant."""
    return float(np.exp(-0.5 * off @ np.linalg.solve(covariance, off)) / np.sqrt(np.linalg.det(covariance)))


class _Chains:
    """Arrays have a row a world, then a limb."""

    def __init__(self, limbs: _Limbs) -> None:
        self._limbs = limbs
        balance, measured = limbs.balance, limbs.measured_n.ravel()
        self._unbalance = np.linalg.pinv(balance)
        self._ways = np.linalg.svd(balance)[2][6:].T  # in which forces balance
        self._closed = _free_of_pose(_block(limbs.place_mm2), balance)
        self._noise = np.linalg.inv(_block(limbs.noise_n2))
        self._edge_n = _EDGE_SHARE * float(np.sqrt(np.trace(limbs.noise_n2, axis1=1, axis2=2).mean() / 3.0))
        # The Gaussian from which steps are drawn: its middle, and steps of one sigma.
        compliance = _block(limbs.compliance.mean(axis=0))
        by_force = compliance.T @ _free_of_pose(_block(limbs.place_mm2 + limbs.play_mm2), balance)
        precision = self._ways.T @ (self._noise + by_force @ compliance) @ self._ways
        self._steps = self._ways @ np.linalg.inv(np.linalg.cholesky(precision)).T
        away = -(limbs.wrench + balance @ measured) @ self._unbalance.T
        left = limbs.moved_mm.reshape(away.shape) + away @ compliance.T - limbs.offset_mm.ravel()
        pull = -(away @ self._noise + left @ by_force.T) @ self._ways
        self._start_n = measured + away + np.linalg.solve(precision, pull.T).T @ self._ways.T

    def run(self, chance: np.random.Generator) -> np.ndarray:
        """The chains' ends."""
        shape = (len(self._limbs.wrench), self._steps.shape[1])
        at = chance.standard_normal(shape)
        weight, force = self._log_weight(at)
        for _ in range(_STEPS):
            size = chance.choice(_STEP_SIZES, (shape[0], 1))
            offered = np.sqrt(1.0 - size**2) * at + size * chance.standard_normal(shape)
            new_weight, new_force = self._log_weight(offered)
            takes = np.log(chance.random(shape[0])) < new_weight - weight
            at[takes], weight[takes], force[takes] = offered[takes], new_weight[takes], new_force[takes]
        return force

    def _log_weight(self, at: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Of the posterior beside the Gaussian, up to a constant; and the forces. at: in the Gaussian's sigmas."""
        limbs = self._limbs
        force = (self._start_n + at @ self._steps.T).reshape(len(at), -1, 3)
        for _ in range(_BALANCING):
            place, _ = self._placed(force)
            left = np.concatenate([force.sum(axis=1), cross(limbs.tip_mm + place, force).sum(axis=1)], axis=1)
            force = force - ((left + limbs.wrench) @ self._unbalance.T).reshape(force.shape)
        place, is_open = self._placed(force)
        off_n = (force - limbs.measured_n).reshape(len(at), -1)
        off_mm = place.reshape(off_n.shape) - limbs.offset_mm.ravel()
        yields = np.where(is_open, limbs.half_rad / limbs.closing_n_mm, 0.0)[..., None] * limbs.turns
        compliance = limbs.compliance + np.swapaxes(limbs.turns, 2, 3) @ yields
        ways = self._ways.reshape(*force.shape[1:], -1)
        along = (compliance @ ways).reshape(len(at), -1, ways.shape[2])
        volume = np.linalg.slogdet(self._ways.T @ along)[1]
        pressing = np.sum(limbs.normal * force, axis=2)
        sideways = np.linalg.norm(force - pressing[..., None] * limbs.normal, axis=2)
        beyond = np.maximum(sideways - limbs.friction * (pressing + limbs.grip_n), 0.0) / self._edge_n
        square = np.sum(off_n * (off_n @ self._noise) + off_mm * (off_mm @ self._closed), axis=1)
        square += np.sum(beyond**2, axis=1) - np.sum(at**2, axis=1)
        return volume - 0.5 * square, force

    def _placed(self, force: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Where forces put the tips, from their places without load, the body held; which plays are open."""
        limbs = self._limbs
        torque = (limbs.turns @ force[..., None])[..., 0] + limbs.weight_n_mm
        side = np.clip(torque / limbs.closing_n_mm, -1.0, 1.0)
        by_load = (limbs.compliance @ (force - limbs.measured_n)[..., None])[..., 0]
        by_play = ((side * limbs.half_rad)[..., None, :] @ limbs.turns)[..., 0, :]
        return limbs.moved_mm + by_load + by_play, np.abs(side) < 1.0


def _wrench(force_n: np.ndarray, at_mm: np.ndarray) -> np.ndarray:
    return np.concatenate([force_n, cross(at_mm, force_n)])


def _wrench_of(at_mm: np.ndarray) -> np.ndarray:
    """6 x 3: force and moment of a force at a place."""
    x, y, z = at_mm
    return np.concatenate([np.eye(3), [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]]])


def _block(matrices: Sequence[np.ndarray] | np.ndarray) -> np.ndarray:
    """3 x 3 matrices on the diagonal of a larger one."""
    count = len(matrices)
    whole = np.zeros((3 * count, 3 * count))
    for index, matrix in enumerate(matrices):
        whole[3 * index : 3 * index + 3, 3 * index : 3 * index + 3] = matrix
    return whole


def _free_of_pose(covariance: np.ndarray, balance: np.ndarray) -> np.ndarray:
    """The precision of places of which nothing is known but how they lie to each other. balance: a pose moves the feet
    by its transpose."""
    precision = np.linalg.inv(covariance)
    by_pose = precision @ balance.T
    return np.asarray(precision - by_pose @ np.linalg.solve(balance @ by_pose, by_pose.T))
