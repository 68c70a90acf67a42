"""The engine's rest under a tip force, and K by differences of such rests.

Rest is where the engine's own sum of generalised forces (`qfrc_smooth`: springs, weights and tip force) is zero; it is
found by Newton's method, whose derivative comes from differences of that sum. `settle_by_motion` lets the engine move
there instead, to show that both are the same place."""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np

from engine_chain import Array
from engine_limb import EngineLimb

_AT_REST = 1e-11  # last Newton step, rad or mm
_SMALL = 1e-2  # Newton step, rad or mm, after which the derivative stays good enough
_RUNAWAY = 1e3
_STEPS = 20


@dataclass(frozen=True)
class Rest:
    """The limb at rest."""

    q: Array  # rad or mm, one a spring
    tip_mm: Array  # displacement from the place at no deflection
    derivative: Array  # of the generalised forces by q
    stable: bool  # a minimum of the energy


class Engine:
    """One limb under weights, ready to be pushed."""

    def __init__(self, limb: EngineLimb, gravity: Array) -> None:
        self._limb = limb
        self.data = mujoco.MjData(limb.model)
        for body, weight_n in limb.weights:
            self.data.xfrc_applied[body, :3] = weight_n * gravity
        self._start = self.tip_mm(np.zeros(limb.model.nq))

    def tip_mm(self, q: Array) -> Array:
        """The tip's place."""
        self.data.qpos[:] = q
        mujoco.mj_kinematics(self._limb.model, self.data)
        return np.array(self.data.xpos[self._limb.tip_body])

    def _forces(self, q: Array) -> Array:
        """Sum of generalised forces at rest."""
        self.data.qpos[:] = q
        self.data.qvel[:] = 0.0
        mujoco.mj_forward(self._limb.model, self.data)
        return np.array(self.data.qfrc_smooth)

    def _derivative(self, q: Array) -> Array:
        """By one-sided differences: Newton's steps need no more, and K does not come from it."""
        step = 1e-6
        here = self._forces(q)
        columns = []
        for i in range(len(q)):
            moved = q.copy()
            moved[i] += step
            columns.append((self._forces(moved) - here) / step)
        return np.array(columns).T

    def _newton(self, q: Array, derivative: Array | None) -> tuple[Array, Array] | None:
        """Rest from a state nearby, and the last derivative used. With a given derivative, which must be that of a rest
        nearby, no other is worked out. None: the state was not near."""
        size = np.inf
        for _ in range(_STEPS):
            if derivative is None or _SMALL < size < np.inf:
                derivative = self._derivative(q)
            change = np.linalg.solve(derivative, self._forces(q))
            q = q - change
            size = float(np.abs(change).max())
            if not size < _RUNAWAY:
                return None
            if size < _AT_REST:
                return q, derivative
        return None

    def push(self, force_n: Array, near: Rest | None = None) -> Rest:
        """Rest under a force on the tip: from a rest nearby if there is one, else at once or in quarters."""
        for parts in (1, 4) if near is None else (1,):
            reached: tuple[Array, Array | None] | None = (np.zeros(self._limb.model.nq), None)
            if near is not None:
                reached = (near.q, near.derivative)
            for part in range(1, parts + 1):
                self.data.xfrc_applied[self._limb.tip_body, :3] = force_n * part / parts
                reached = None if reached is None else self._newton(*reached)
            if reached is not None:
                q, derivative = reached
                assert derivative is not None
                stiffness = -0.5 * (derivative + derivative.T)
                stable = bool(np.linalg.eigvalsh(stiffness)[0] > 0.0)
                return Rest(q, self.tip_mm(q) - self._start, derivative, stable)
        raise ArithmeticError("the engine's limb did not come to rest")

    def k_n_per_mm(self, rest: Rest, force_n: Array, axes: tuple[int, ...]) -> Array:
        """K over these axes, by central differences of rests: not made symmetric."""
        step_n = 0.002  # what is left of K's second derivative is some 1e-7, and of rounding as much
        columns = []
        for axis in axes:
            more = np.zeros(3)
            more[axis] = step_n
            above, below = (self.push(force_n + way * more, rest).tip_mm for way in (1.0, -1.0))
            columns.append((above - below)[list(axes)] / (2.0 * step_n))
        return np.asarray(np.linalg.inv(np.array(columns).T))

    def settle_by_motion(self, force_n: Array, damping: float, steps: int) -> Array:
        """Displacement of the tip after the engine moved the limb, damped, under the force."""
        model = self._limb.model
        mujoco.mj_resetData(model, self.data)
        self.data.xfrc_applied[self._limb.tip_body, :3] = force_n
        model.dof_damping[:] = damping * model.jnt_stiffness
        for _ in range(steps):
            mujoco.mj_step(model, self.data)
        return self.tip_mm(np.array(self.data.qpos)) - self._start
