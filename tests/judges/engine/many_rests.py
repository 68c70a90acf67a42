"""Rests of one limb at many postures at once, its tip held by a rig or pushed by a force.

The engine says where every spring's axis, the tip and the weights are (mj_kinematics); the springs' torques, the
friction and the rig are written here. A rest is where both sum up to zero; Newton's method finds it for all rows.
Angles are counted counter-clockwise, from x towards z; only the plane's axes x and z are kept."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

import mujoco
import numpy as np
import numpy.typing as npt
from engine_chain import Array
from engine_limb import EngineLimb

Flags = npt.NDArray[np.bool_]
Rows = npt.NDArray[np.intp]

_AT_REST = 1e-7  # last Newton step, rad or mm: what it leaves is of its square
_STEPS = 80
_PLAIN_STEPS = 12  # then ever shorter ones: torques with kinks can make full steps go round in circles
_RUNAWAY = 1e4
_PLANE = slice(0, 3, 2)
_JUST_MORE = 1e-9  # of the friction's torque, and of a deflection [rad]


class NoRest(ArithmeticError):
    """Newton's method found none."""


class JointLaw(Protocol):
    """Torque of a joint's drive."""

    def torque(self, deflection_rad: Array) -> tuple[Array, Array]:
        """Torque [N mm] of one deflection a row (one column a joint: femur, tibia), and its slope."""

    def rows(self, which: Rows) -> JointLaw:
        """The same for some of the rows."""


@dataclass(frozen=True)
class Cable:
    """A wire from a point on the robot to the limb's point `cable`, taut beyond its length."""

    from_mm: Array
    length_mm: float
    n_per_mm: float


@dataclass(frozen=True)
class Held:
    """What holds the tip in each row: its place (count x 2), or where `free`, a force. The rig yields by `yields`."""

    place_mm: Array
    force_n: Array
    free: bool = False
    rig_mm_per_n: float = 0.0

    def rows(self, which: Rows) -> Held:
        """The same for some of the rows."""
        return Held(self.place_mm[which], self.force_n[which], self.free, self.rig_mm_per_n)


@dataclass(frozen=True)
class Friction:
    """Joints that stand at `before_rad` until more than `coulomb_n_mm` pushes them (count x 2 both)."""

    before_rad: Array
    coulomb_n_mm: Array


@dataclass
class Rests:
    """Deflections of all springs (count x springs) and forces of the rig on the tip (count x 2). C only of a tip that
    is free to follow a force; there a joint in its play counts as if its spring carried."""

    q: Array
    force_n: Array
    c_mm_per_n: Array = field(default_factory=lambda: np.zeros((0, 2, 2)))

    @property
    def k_n_per_mm(self) -> Array:
        """K at rest, of the limb pushed by a force."""
        return np.asarray(np.linalg.inv(self.c_mm_per_n))


@dataclass(frozen=True)
class _Shape:
    tip: Array  # count x 2
    anchor: Array  # count x springs x 2
    axis: Array  # count x springs x 2; of slides
    points: Array  # count x weights x 2
    cable: Array  # count x 2


class ManyRests:
    """One limb, built at the posture (0, 0)."""

    def __init__(self, limb: EngineLimb, cable: Cable | None = None) -> None:
        model = limb.model
        self._model, self._data, self._tip_body = model, mujoco.MjData(model), limb.tip_body
        self.stiffness = np.array(model.jnt_stiffness)
        self.springs = int(model.nq)
        self.joints = [int(model.joint(name).qposadr[0]) for name in ("femur", "tibia")]
        self._hinge = np.array(model.jnt_type) == mujoco.mjtJoint.mjJNT_HINGE
        self._weights_n = np.array([weight for _, weight in limb.weights])
        self._weight_bodies = [body for body, _ in limb.weights]
        self._carried = np.array([self._carries(body) for body in self._weight_bodies], dtype=float).reshape(
            len(self._weight_bodies), self.springs
        )
        self._cable = cable
        self._cable_body = int(model.body("cable").id) if cable else 0
        self._cable_carried = self._carries(self._cable_body).astype(float) if cable else np.zeros(self.springs)
        order = np.arange(self.springs)
        self._later = np.maximum.outer(order, order)
        both = np.logical_and.outer(self._hinge, self._hinge)
        self._both_hinges = both.astype(float)
        # a slide that a hinge before it turns
        self._turned = (np.logical_and.outer(self._hinge, ~self._hinge) & np.less.outer(order, order)).astype(float)
        self._order = order

    def _carries(self, body: int) -> Flags:
        """For each spring, whether it carries a body."""
        found = np.zeros(self.springs, dtype=bool)
        while body > 0:
            if self._model.body_jntnum[body]:
                found[self._model.body_jntadr[body]] = True
            body = int(self._model.body_parentid[body])
        return found

    # --- geometry, by the engine -----------------------------------------------------------------------------

    def _shape(self, theta: Array, q: Array) -> _Shape:
        model, data = self._model, self._data
        at = q.copy()
        at[:, self.joints[0]] += theta[:, 0]
        at[:, self.joints[1]] -= theta[:, 1]
        anchor, axis = np.empty((2, len(q), self.springs, 2))
        place = np.empty((len(q), model.nbody, 2))
        angles, anchors, axes, places = data.qpos, *(
            one[:, _PLANE] for one in (data.xanchor, data.xaxis, data.xpos)
        )  # views: the engine writes into them
        for row in range(len(q)):
            angles[:] = at[row]
            mujoco.mj_kinematics(model, data)
            anchor[row], axis[row], place[row] = anchors, axes, places
        return _Shape(
            place[:, self._tip_body], anchor, axis, place[:, self._weight_bodies], place[:, self._cable_body]
        )

    def tip_mm(self, theta: Array, q: Array | None = None) -> Array:
        """The tip's place, at no deflection where none is given."""
        return self._shape(theta, np.zeros((len(theta), self.springs)) if q is None else q).tip

    def _lever(self, shape: _Shape, place: Array) -> Array:
        """How each spring moves a place that it carries: count x 2 x springs."""
        away = place[:, None, :] - shape.anchor
        turned = np.stack([-away[:, :, 1], away[:, :, 0]], axis=1)
        return np.where(self._hinge, turned, np.moveaxis(shape.axis, 2, 1))

    # --- forces ----------------------------------------------------------------------------------------------

    def _pushes(self, shape: _Shape, force: Array) -> tuple[Array, Array, Array]:
        """Generalised forces of tip force, weights and cable, their derivative G, and the tip's levers."""
        lever = self._lever(shape, shape.tip)
        pushed = np.einsum("rds,rd->rs", lever, force)
        turning = -np.einsum("rsd,rd->rs", shape.tip[:, None, :] - shape.anchor, force)
        carried = np.broadcast_to(force[:, None, :], (len(force), self.springs, 2)).copy()
        if len(self._weights_n):
            load = self._weights_n[:, None] * self._carried  # weights x springs
            below = load.sum(axis=0)
            moment = np.einsum("ws,rwd->rsd", load, shape.points) - below[None, :, None] * shape.anchor
            pushed -= np.where(self._hinge, moment[:, :, 0], below * shape.axis[:, :, 1])
            turning += moment[:, :, 1]
            carried[:, :, 1] -= below
        steep = 0.0
        if self._cable is not None:
            span = shape.cable - self._cable.from_mm
            length = np.linalg.norm(span, axis=1)
            way = span / length[:, None]
            pull = self._cable.n_per_mm * np.maximum(0.0, length - self._cable.length_mm)
            reach = self._lever(shape, shape.cable) * self._cable_carried
            along = np.einsum("rds,rd->rs", reach, way)
            pushed -= pull[:, None] * along
            steep = (pull > 0.0)[:, None, None] * self._cable.n_per_mm * along[:, :, None] * along[:, None, :]
        ahead = np.stack([-shape.axis[:, :, 1], shape.axis[:, :, 0]], axis=2)
        sliding = np.einsum("rsd,rsd->rs", ahead, carried)
        g = turning[:, self._later] * self._both_hinges
        mixed = sliding[:, None, :] * self._turned
        return pushed, g + mixed + np.swapaxes(mixed, 1, 2) - steep, lever

    # --- rest ------------------------------------------------------------------------------------------------

    def rest(
        self, theta: Array, law: JointLaw, softer: Array, held: Held, start: Rests | None = None,
        friction: Friction | None = None,
    ) -> Rests:  # fmt: skip
        """Rests of rows: angles (count x 2), what each spring's compliance is multiplied with (count x springs)."""
        near = start or Rests(np.zeros((len(theta), self.springs)), np.zeros((len(theta), 2)))
        if friction is None:
            none = np.zeros((len(theta), 2))
            return self._newton(theta, law, softer, held, near, none.astype(bool), none, none)
        slides = np.zeros((len(theta), 2))  # -1, 0, 1 a joint: which way it goes
        found = Rests(near.q.copy(), near.force_n.copy())
        asked = np.arange(len(theta))
        for _ in range(16):
            now, drag = slides[asked], slides[asked] * friction.coulomb_n_mm[asked]
            before = friction.before_rad[asked]
            part = self._newton(
                theta[asked], law.rows(asked), softer[asked], held.rows(asked),
                Rests(found.q[asked], found.force_n[asked]), now == 0.0, before, drag,
            )  # fmt: skip
            found.q[asked], found.force_n[asked] = part.q, part.force_n
            pushed, _, _ = self._pushes(self._shape(theta[asked], part.q), part.force_n)
            torque, _ = law.rows(asked).torque(part.q[:, self.joints])
            excess = pushed[:, self.joints] - torque
            moved = part.q[:, self.joints] - before
            limit = friction.coulomb_n_mm[asked] * (1.0 + _JUST_MORE)
            fresh = np.where(now == 0.0, np.where(np.abs(excess) > limit, np.sign(excess), 0.0),
                             np.where(now * moved < -_JUST_MORE, 0.0, now))  # fmt: skip
            changed = np.any(fresh != now, axis=1)
            slides[asked] = fresh
            asked = asked[changed]
            if not len(asked):
                return found
        raise NoRest("the joints neither stick nor slide")

    def _newton(
        self, theta: Array, law: JointLaw, softer: Array, held: Held, near: Rests, stuck: Flags, before: Array,
        drag: Array,
    ) -> Rests:  # fmt: skip
        n, joints = self.springs, self.joints
        q, force = near.q.copy(), np.where(held.free, held.force_n, near.force_n)
        c = np.zeros((len(q), 2, 2))
        asked = np.arange(len(q))
        for step in range(_STEPS):
            shape = self._shape(theta[asked], q[asked])
            pushed, g, lever = self._pushes(shape, force[asked])
            k = self.stiffness / softer[asked]
            torque = k * q[asked]
            springs = k[:, joints]
            torque[:, joints], k[:, joints] = law.rows(asked).torque(q[asked][:, joints])
            if held.free:  # nothing holds a limb in its play but its weight: as if the spring went on there
                k[:, joints] = np.where(k[:, joints] > 0.0, k[:, joints], springs)
            torque[:, joints] += drag[asked]
            left = torque - pushed
            h = -g
            h[:, self._order, self._order] += k
            for number, joint in enumerate(joints):
                rows = stuck[asked, number]
                left[rows, joint] = q[asked][rows, joint] - before[asked][rows, number]
                h[rows, joint, :] = 0.0
                h[rows, joint, joint] = 1.0
            if held.free:
                both = np.linalg.solve(h, np.concatenate([left[:, :, None], np.swapaxes(lever, 1, 2)], axis=2))
                move, push = -both[:, :, 0], np.zeros((len(asked), 2))
                c[asked] = np.einsum("rds,rse->rde", lever, both[:, :, 1:])
            else:
                whole = np.zeros((len(asked), n + 2, n + 2))
                whole[:, :n, :n] = h
                whole[:, :n, n:] = -np.swapaxes(lever, 1, 2)
                for number, joint in enumerate(joints):
                    whole[stuck[asked, number], joint, n:] = 0.0
                whole[:, n:, :n] = lever
                whole[:, [n, n + 1], [n, n + 1]] = held.rig_mm_per_n
                off = shape.tip + held.rig_mm_per_n * force[asked] - held.place_mm[asked]
                solved = np.linalg.solve(whole, -np.concatenate([left, off], axis=1)[:, :, None])[:, :, 0]
                move, push = solved[:, :n], solved[:, n:]
            shorter = 1.0 if step < _PLAIN_STEPS else (0.7, 0.4, 0.9)[step % 3]
            q[asked] += shorter * move
            force[asked] += shorter * push
            size = np.abs(move).max(axis=1)
            if not np.all(size < _RUNAWAY):
                raise NoRest("Newton's method runs away")
            asked = asked[size > _AT_REST]
            if not len(asked):
                return Rests(q, force, c)
        raise NoRest(f"{len(asked)} of {len(q)} rows found no rest")
