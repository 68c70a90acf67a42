"""The engine's rest under a tip force, and K by differences of such rests.

Rest is where the engine's generalised forces of springs, weights and tip force sum up to zero. It is found by Newton's
method, whose derivative comes from differences of that sum. `settle_by_motion` lets the engine move there instead, to
show that both are the same place."""

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
_NO_MOMENT = np.zeros(3)


@dataclass(frozen=True)
class Rest:
    """The limb at rest."""

    q: Array  # rad or mm, one a spring
    tip_mm: Array  # displacement from the place at no deflection
    inverse: Array  # of the generalised forces' derivative by q

    @property
    def stable(self) -> bool:
        """Whether this is a minimum of the energy: all of minus the inverse's eigenvalues are positive."""
        return bool(np.linalg.eigvalsh(-0.5 * (self.inverse + self.inverse.T))[0] > 0.0)


class Engine:
    """One limb under weights, ready to be pushed."""

    def __init__(self, limb: EngineLimb, gravity: Array) -> None:
        self._limb = limb
        self.data = mujoco.MjData(limb.model)
        for body, weight_n in limb.weights:
            self.data.xfrc_applied[body, :3] = weight_n * gravity
        self._loaded = [body for body, _ in limb.weights] + [limb.tip_body]
        self._start = self.tip_mm(np.zeros(limb.model.nq))

    def tip_mm(self, q: Array) -> Array:
        """The tip's place."""
        self.data.qpos[:] = q
        mujoco.mj_kinematics(self._limb.model, self.data)
        return np.array(self.data.xpos[self._limb.tip_body])

    def _forces(self, q: Array) -> Array:
        """Sum of generalised forces of springs, weights and tip force, without motion."""
        model, data = self._limb.model, self.data
        data.qpos[:] = q
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_passive(model, data)
        forces = np.array(data.qfrc_spring)
        for body in self._loaded:
            mujoco.mj_applyFT(model, data, data.xfrc_applied[body, :3], _NO_MOMENT, data.xipos[body], body, forces)
        return forces

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

    def _newton(self, q: Array, inverse: Array | None) -> tuple[Array, Array] | None:
        """Rest from a state nearby, and the inverse of the last derivative used. With a given inverse, which must be
        that of a rest nearby, no other is worked out. None: the state was not near."""
        size = 0.0
        for _ in range(_STEPS):
            if inverse is None or size > _SMALL:
                inverse = np.asarray(np.linalg.inv(self._derivative(q)), dtype=np.float64)
            change = inverse @ self._forces(q)
            q = q - change
            size = float(np.abs(change).max())
            if not size < _RUNAWAY:
                return None
            if size < _AT_REST:
                return q, inverse
        return None

    def push(self, force_n: Array, near: Rest | None = None) -> Rest:
        """Rest under a force on the tip: from a rest nearby if there is one, else at once or in quarters."""
        for parts in (1, 4) if near is None else (1,):
            q, inverse = (np.zeros(self._limb.model.nq), None) if near is None else (near.q, near.inverse)
            for part in range(1, parts + 1):
                self.data.xfrc_applied[self._limb.tip_body, :3] = force_n * part / parts
                found = self._newton(q, inverse)
                if found is None:
                    break
                q, inverse = found
            else:
                assert inverse is not None
                return Rest(q, self.tip_mm(q) - self._start, inverse)
        raise ArithmeticError("the engine's limb did not come to rest")

    def k_n_per_mm(self, rest: Rest, force_n: Array, axes: tuple[int, ...]) -> Array:
        """K over these axes, by central differences of rests over two steps, so that C's own change with the load, which
        the inverse of a slender C magnifies a thousandfold, cancels. Not made symmetric."""
        step_n = 0.002
        columns = []
        for axis in axes:
            more = np.zeros(3)
            more[axis] = step_n
            moved = [self.push(force_n + way * more, rest).tip_mm[list(axes)] for way in (1.0, -1.0, 2.0, -2.0)]
            columns.append((8.0 * (moved[0] - moved[1]) - (moved[2] - moved[3])) / (12.0 * step_n))
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
