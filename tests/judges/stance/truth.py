"""What a body on its limbs does: Coulomb's law with history; Siconos solves a step, the law's residual checks it.

A foot is the tip of an elastic limb: its place is the body's rigid motion, the limb's deflection under the ground's
force, and what is hidden (zeros, play, the foothold's offset). The ground's forces f balance weight and payload. Law:
gap >= 0; f_n >= -grip; |f_t| <= friction (f_n + grip), slip against f_t. A foot that lets its grip go is gone for
good; one that only presses may come back. Feet are put down without load at their commanded places, then weight and
hidden offsets grow together in steps, then the payload grows. A step is implicit: forces at its end, slip over it.

Siconos wants the law in the feet's own compliance. A free body has none, so its motion is solved by the proximal
point method: soft springs hold the body at the place of the iteration before, until they bear nothing. The answer has
no regularisation.
"""

from __future__ import annotations

import json
import shutil
import subprocess
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeAlias

import numpy as np
from limbs import Array, Limbs, levers, loaded, small
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

HERE = Path(__file__).parent
BALANCE_N = 1e-7  # forces, moments by LEVER_MM, and the law's residual of a solved step
LEVER_MM = 100.0
SLIP_MM = 1e-5  # a solved step leaves some 1e-8 mm N/mm of slip in a foot that sticks
ITERATIONS = 250
STEPS = 4  # in which set-points move
FAR_MM = 80.0  # a body that went so far has fallen


class NoStance(ArithmeticError):
    """No equilibrium was found: the body falls, or a limb gives way."""


class Siconos:
    """The solver, in Debian's Python beside this one. OSError where it is not installed."""

    def __init__(self) -> None:
        python = shutil.which("python3", path="/usr/bin") or "python3"
        self._process = subprocess.Popen([python, str(HERE / "siconos_laws.py")], stdin=subprocess.PIPE,
                                         stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, bufsize=1)
        if self._process.stdout.readline() != "ready\n":  # type: ignore[union-attr]
            self._process.wait()
            raise OSError("missing: Siconos (apt-get install python3-siconos)")

    def __call__(self, w: Array, q: Array, friction: Array, guess: Array) -> Array:
        ask = {"w": w.tolist(), "q": q.tolist(), "friction": friction.tolist(), "r": guess.tolist()}
        self._process.stdin.write(json.dumps(ask) + "\n")  # type: ignore[union-attr]
        return np.array(json.loads(self._process.stdout.readline()))  # type: ignore[union-attr]

    def seconds(self, w: Array, q: Array, friction: Array, guess: Array, repeats: int) -> float | None:
        """How long one such problem takes the solver itself; None: it finds no solution."""
        ask = {"w": w.tolist(), "q": q.tolist(), "friction": friction.tolist(), "r": guess.tolist(), "repeats": [repeats]}
        self._process.stdin.write(json.dumps(ask) + "\n")  # type: ignore[union-attr]
        found: float | None = json.loads(self._process.stdout.readline())  # type: ignore[union-attr]
        return found

    def close(self) -> None:
        self._process.communicate()


# A step's forces from W, q, friction and a first guess, all in the feet's frames.
Solver: TypeAlias = Callable[[Array, Array, Array, Array], Array]


@dataclass(frozen=True)
class World:
    """n limbs under one body; lengths in mm, forces in N, all in the frame of the commanded body.

    `limbs` are as they are, `commanded_mm` (n, 3) the tips that the commands mean. Offsets are those of the footholds.
    """

    limbs: Limbs
    zero_rad: Array  # (n, 3)
    mount_mm: Array  # (n, 3)
    turn: Array  # (n, 3, 3): a limb's frame to the body's
    commanded_mm: Array
    offset_mm: Array
    normal: Array
    friction: Array  # (n,)
    grip_n: Array  # (n,)
    weight_n: Array  # (3,)
    com_mm: Array
    payload_n: Array
    payload_at_mm: Array
    finite: bool = True  # False: small displacements


@dataclass(frozen=True)
class State:
    """One solved step. Forces are the ground's on the feet, in the world's frame."""

    moved_mm: Array  # (3,) of the body
    turned: Array  # (3, 3), or the rotation vector's matrix where displacements are small
    force_n: Array  # (n, 3)
    away_mm: Array  # (n, 3): tip less foothold
    gone: NDArray[np.bool_]  # (n,)
    slipped: NDArray[np.bool_]  # (n,): slid or opened in this step
    coordinates: Array  # (n, 9) of the limbs
    residual_n: float = 0.0


def begin(world: World) -> State:
    n = len(world.friction)
    nothing = np.zeros((n, 3))
    return State(np.zeros(3), np.eye(3) if world.finite else np.zeros((3, 3)), nothing, nothing, np.zeros(n, bool),
                 np.zeros(n, bool), np.zeros((n, 9)))


def crossing(a: Array) -> Array:
    """(..., 3, 3) matrices of a x."""
    x, y, z = np.moveaxis(a, -1, 0)
    return np.moveaxis(np.array([[0 * x, -z, y], [z, 0 * x, -x], [-y, x, 0 * x]]), [0, 1], [-2, -1])


def frames(normal: Array) -> Array:
    """(n, 3, 3): columns normal and two directions along the ground."""
    helper = np.where(np.abs(normal[:, :1]) < 0.9, [[1.0, 0.0, 0.0]], [[0.0, 1.0, 0.0]])
    one = np.cross(normal, helper)
    one /= np.linalg.norm(one, axis=1)[:, None]
    return np.stack([normal, one, np.cross(normal, one)], axis=2)


def margins(world: World, force_n: Array) -> Array:
    """(n,) [N]: how much more sideways force each foot would hold; negative beyond its cone."""
    pressing = np.einsum("nc,nc->n", world.normal, force_n)
    sideways = np.linalg.norm(force_n - pressing[:, None] * world.normal, axis=1)
    margin: Array = world.friction * (pressing + world.grip_n) - sideways
    return margin


def by_joints(world: World, state: State) -> Array:
    """(n, 3, 3): how yaw, femur and knee move the tips in the world's frame, a row a joint. A force's loads of the
    joints, in the sense of their angles, follow."""
    limbs = replace(world.limbs, theta_rad=world.limbs.theta_rad + world.zero_rad)
    turn = state.turned @ world.turn if world.finite else world.turn
    by: Array = np.einsum("nab,nib->nia", turn, levers(limbs, state.coordinates))
    return by


def _places(world: World, limbs: Limbs, state: State, secant: bool) -> tuple[Array, Array, Array, Array, Array]:
    """Tips (n, 3), C (n, 3, 3), the body's levers (n, 3, 6), coordinates, and the turn for points of the body."""
    if world.finite:
        turn = state.turned @ world.turn
        tip, own, coordinates = loaded(limbs, np.einsum("nab,na->nb", turn, state.force_n), state.coordinates, secant)
        about = np.einsum("nab,nb->na", turn, tip) + world.mount_mm @ state.turned.T
        place = state.moved_mm + about
    else:
        turn, coordinates = world.turn, state.coordinates
        tip, own = small(limbs, np.einsum("nab,na->nb", turn, state.force_n), secant)
        about = world.commanded_mm
        place = (np.einsum("nab,nb->na", turn, tip) + world.mount_mm + state.moved_mm
                 + about @ state.turned.T)
    compliance = np.einsum("nab,nbc,ndc->nad", turn, own, turn)
    levers = np.concatenate([np.broadcast_to(np.eye(3), compliance.shape), -crossing(about)], axis=2)
    return place, compliance, levers, coordinates, state.turned if world.finite else np.eye(3)


def law_residual_n(pressing: Array, apart: Array, friction: Array, stiffness: Array) -> float:
    """How far forces and displacements (n, 3), normal first, are from Coulomb's law [N]: De Saxce's natural map."""
    slip = np.linalg.norm(apart[:, 1:], axis=1)
    z = pressing - stiffness[:, None] * (apart + np.outer(friction * slip, [1, 0, 0]))
    side = np.linalg.norm(z[:, 1:], axis=1)
    along = (z[:, 0] + friction * side) / (1 + friction**2)
    direction = z[:, 1:] / np.maximum(side, 1e-300)[:, None]
    on_cone = np.concatenate([along[:, None], (friction * along)[:, None] * direction], axis=1)
    inside, below = side <= friction * z[:, 0], friction * side <= -z[:, 0]
    projected = np.where(inside[:, None], z, np.where(below[:, None], 0, on_cone))
    return float(np.abs(pressing - projected).max(initial=0))


def step(world: World, solver: Solver, before: State, progress: float, factor: float) -> State:
    """The state when weight and offsets have come to `progress` (0 to 1), the payload to `factor`; or NoStance."""
    limbs = replace(world.limbs, theta_rad=world.limbs.theta_rad + progress * world.zero_rad)
    foothold = world.commanded_mm + progress * world.offset_mm
    loads = [(progress * world.weight_n, world.com_mm), (factor * world.payload_n, world.payload_at_mm)]
    along = frames(world.normal)
    scale = np.array([1, 1, 1, LEVER_MM, LEVER_MM, LEVER_MM])
    state = held_at = before
    n = len(world.friction)
    held = np.where(before.gone, 0.0, world.grip_n)
    lift = held[:, None] * world.normal
    smallest, since, secant = np.inf, 0, False
    for iteration in range(ITERATIONS):
        try:
            place, compliance, levers, coordinates, turned = _places(world, limbs, state, secant)
        except ArithmeticError as error:
            if iteration >= ITERATIONS - 1 or not iteration:
                raise NoStance(str(error)) from error
            force, secant = (state.force_n + held_at.force_n) / 2, True
            state = replace(held_at, force_n=force)
            continue
        held_at = state
        wrench = sum(np.concatenate([force, np.cross(turned @ at, force)]) for force, at in loads)
        balance = wrench + np.einsum("nab,na->b", levers, state.force_n)
        away = place - foothold
        apart = np.einsum("nab,na->nb", along, away)
        apart[:, 1:] -= np.einsum("nab,na->nb", along, before.away_mm)[:, 1:]
        pressing = np.einsum("nab,na->nb", along, state.force_n + lift)
        on = ~before.gone
        stiffness = 1 / np.linalg.eigvalsh(compliance)[:, -1]
        residual = max(np.abs(balance / scale).max(),
                       law_residual_n(pressing[on], apart[on], world.friction[on], stiffness[on]))
        if residual < BALANCE_N and iteration:
            slipped = on & (np.linalg.norm(apart[:, 1:], axis=1) > SLIP_MM) | on & (apart[:, 0] > SLIP_MM)
            lets_go = on & (world.grip_n > 0) & (apart[:, 0] > SLIP_MM)
            solved = replace(state, away_mm=away, slipped=slipped, coordinates=coordinates, residual_n=residual)
            if not lets_go.any():
                return solved
            again = replace(before, gone=before.gone | lets_go, force_n=np.where(lets_go[:, None], 0, before.force_n))
            after = step(world, solver, again, progress, factor)
            return replace(after, slipped=after.slipped | slipped)
        if np.linalg.norm(state.moved_mm) > FAR_MM:
            raise NoStance("the body falls")
        # Forces f and the body's motion d against soft springs: s d = balance + levers' (f - state.force).
        stiff = np.einsum("nab,nac,ncd->bd", levers[on], np.linalg.inv(compliance[on]), levers[on])
        soft = np.diag(stiff) * (0.03 if iteration < 30 else 0.3)
        wide = np.einsum("nab,nac->bnc", levers[on], along[on]).reshape(6, -1)
        m = on.sum()
        w = wide.T @ (wide / soft[:, None])
        for k, own in enumerate(np.einsum("nab,nac,ncd->nbd", along[on], compliance[on], along[on])):
            w[3 * k:3 * k + 3, 3 * k:3 * k + 3] += own
        q = (apart[on].ravel() + wide.T @ (balance / soft)) - w @ pressing[on].ravel()
        r = solver(w, q, world.friction[on], pressing[on].ravel())
        change = r - pressing[on].ravel()
        body = (balance + wide @ change) / soft
        force = np.zeros((n, 3))
        force[on] = np.einsum("nab,nb->na", along[on], r.reshape(m, 3)) - lift[on]
        if world.finite:
            turn = Rotation.from_rotvec(body[3:]).as_matrix() @ state.turned
        else:
            turn = state.turned + crossing(body[3:])
        state = replace(state, moved_mm=state.moved_mm + body[:3], turned=turn, force_n=force, coordinates=coordinates)
        if residual < smallest * 0.9:
            smallest, since = residual, iteration
        if iteration - since >= (30 if secant else 6):  # Newton's steps go round between open and closed plays
            secant, since, smallest = not secant, iteration, np.inf
    raise NoStance(f"no equilibrium within {BALANCE_N} N (best {smallest:.1e} N)")


def _advance(world: World, solver: Solver, state: State, start: Array, end: Array, halvings: int = 5) -> State:
    """From (progress, factor) `start` to `end` in one step, or in halves where the iteration loses its way."""
    try:
        return step(world, solver, state, *end)
    except NoStance:
        if not halvings:
            raise
    middle = (start + end) / 2
    state = _advance(world, solver, state, start, middle, halvings - 1)
    return _advance(world, solver, state, middle, end, halvings - 1)


def stand(world: World, solver: Solver, steps: int = 8) -> State:
    """The feet down, then the weight in steps: the state before the payload."""
    state = begin(world)
    for k in range(steps):
        state = _advance(world, solver, state, np.array([k / steps, 0.0]), np.array([(k + 1) / steps, 0.0]))
    return state


@dataclass(frozen=True)
class Slip:
    foot: int
    factor: float
    spare_n: float  # the next foot's margin then
    before: State  # the last step in which all held
    after: State


def first_slip(world: World, solver: Solver, state: State, most: float, precision: float = 2e-4) -> Slip | None:
    """The payload grows from nothing until a foot slides or opens; None if all hold up to the factor `most`.

    NoStance of a step is a slip, too: the foot is then the one with the smallest margin before.
    """
    low, size, high, after = 0.0, most / 16, np.inf, state
    least = precision * most / 100
    while high - low > max(least, precision * low):
        factor = (low + high) / 2 if np.isfinite(high) else min(most, low + size)
        try:
            next_state = step(world, solver, state, 1.0, factor)
        except NoStance:
            if np.isinf(high) and size > least:  # the step may be too long for the iteration
                size /= 4
                continue
            next_state = None
        if next_state is not None and not next_state.slipped.any():
            low, state, size = factor, next_state, size * 1.5
            if low >= most:
                return None
        else:
            high, after = factor, next_state or after
    margin = np.where(state.gone, np.inf, margins(world, state.force_n))
    slid = np.flatnonzero(after.slipped)
    foot = int(slid[np.argmin(margin[slid])]) if len(slid) else int(np.argmin(margin))
    return Slip(foot, high, float(np.delete(margin, foot).min()), state, after)


def payload(world: World, solver: Solver, state: State, low: float, high: float, steps: int) -> State:
    """The payload from the factor `low` to `high`, in steps, from a state at `low`."""
    factors = np.linspace(low, high, steps + 1)
    for start, end in zip(factors, factors[1:]):
        state = _advance(world, solver, state, np.array([1.0, start]), np.array([1.0, end]))
    return state


def execute(world: World, solver: Solver, state: State, theta_rad: Array, factor: float) -> tuple[World, State]:
    """Set-points move to `theta_rad` (n, 3) in steps, at the payload's factor: the world, and the state, whose
    `slipped` is that of any step."""
    start, slipped = world.limbs.theta_rad, np.zeros(len(world.friction), bool)
    for k in range(1, STEPS + 1):
        theta = start + (theta_rad - start) * k / STEPS
        state = step(replace(world, limbs=replace(world.limbs, theta_rad=theta)), solver, state, 1.0, factor)
        slipped |= state.slipped
    return replace(world, limbs=replace(world.limbs, theta_rad=theta_rad)), replace(state, slipped=slipped)


def lift(world: World, solver: Solver, state: State, foot: int, steps: int = 4) -> State:
    """A foot is taken off the ground, without payload: what it bears fades in steps, and it is gone. `slipped` is that
    of any step."""
    place = world.commanded_mm[foot] + world.offset_mm[foot] + state.away_mm[foot]
    at = state.turned.T @ (place - state.moved_mm) if world.finite else world.commanded_mm[foot]
    fading = replace(world, payload_n=state.force_n[foot], payload_at_mm=at)
    gone, force, slipped = state.gone.copy(), state.force_n.copy(), np.zeros(len(world.friction), bool)
    gone[foot], force[foot] = True, 0.0
    state = replace(state, gone=gone, force_n=force)
    for k in range(steps):
        start, end = (np.array([1.0, 1 - one / steps]) for one in (k, k + 1))
        state = _advance(fading, solver, state, start, end, halvings=1)
        slipped |= state.slipped
    return replace(state, slipped=slipped)
