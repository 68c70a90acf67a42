"""tools/stance through cffi: a stance's springs, its state, and what a load does to it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from brace.native import Library, library
from brace.native.c_data import CData
from brace.stance.limb_law import Spring

OK, E_LOOSE, E_NO_REST = 0, -2, -3
STICKS, SLIDES, OPEN, LET_GO = range(4)
SLIDE_STEPS = 8
Force = tuple[np.ndarray, np.ndarray]  # [N] and where it acts [mm], in the body's frame


@dataclass(frozen=True)
class Contact:
    """How the ground holds a foot."""

    normal: np.ndarray
    friction_ratio: float
    grip_n: float


@dataclass(frozen=True)
class Slip:
    """The first foot that moves when a further load grows; limb -1: none up to the bound."""

    factor: float
    limb: int
    contact: int


class State:
    """A body under a load; arrays have a row a limb."""

    def __init__(self, native: Library, count: int, data: CData) -> None:
        self._native, self.count, self.data = native, count, data

    def copy(self) -> State:
        """The same, to go on from twice."""
        return State(self._native, self.count, self._native.ffi.new("brace_stance_state_t *", self.data[0]))

    def _feet(self, member: str) -> np.ndarray:
        return np.array([list(getattr(self.data.foot[limb], member)) for limb in range(self.count)])

    @property
    def force_n(self) -> np.ndarray:
        """The ground's forces on the feet."""
        return self._feet("force_n")

    @property
    def place_mm(self) -> np.ndarray:
        """Where the feet are, from their tips' places without load."""
        return self._feet("place_mm")

    @property
    def contact(self) -> list[int]:
        """STICKS, SLIDES, OPEN or LET_GO of each foot."""
        return [int(self.data.foot[limb].contact) for limb in range(self.count)]

    @property
    def displacement_mm(self) -> np.ndarray:
        """Of the body's origin."""
        return np.array(list(self.data.displacement_mm))

    @property
    def rotation_rad(self) -> np.ndarray:
        """Of the body, as a rotation vector."""
        return np.array(list(self.data.rotation_rad))

    def move(self, way_mm: np.ndarray) -> None:
        """Moves the feet from their tips' places without load, a row a limb; the next settle shows what follows."""
        for limb, place in enumerate(self.place_mm + way_mm):
            self.data.foot[limb].place_mm = place.tolist()

    def lift(self, limb: int) -> None:
        """Takes a foot off the ground; the next settle shows what follows."""
        self._native.lib.brace_stance_lift(self.data, limb)


class Statics:
    """A body on springs. `feet_mm`: the tips' places without load, a row a limb."""

    def __init__(self, feet_mm: np.ndarray, contacts: Sequence[Contact]) -> None:
        self._native = library()
        self._stance = self._native.ffi.new("brace_stance_t *")
        self._stance.limb_count = self.count = len(contacts)
        for limb, (foot, contact) in enumerate(zip(feet_mm, contacts, strict=True)):
            one = self._stance.limb[limb]
            one.foot_mm, one.normal = foot.tolist(), contact.normal.tolist()
            one.friction_ratio, one.grip_n = contact.friction_ratio, contact.grip_n

    def set_springs(self, springs: Sequence[Spring], forces_n: np.ndarray) -> None:
        """The limbs' law near these forces, a row a limb."""
        for limb, (spring, force) in enumerate(zip(springs, forces_n, strict=True)):
            one = self._stance.limb[limb]
            one.k_n_per_mm, one.moved_mm = spring.k_n_per_mm.ravel().tolist(), spring.moved_mm.tolist()
            one.force_n = force.tolist()

    def place(self, offset_mm: np.ndarray) -> State:
        """The feet on their footholds, a row a limb, before any load."""
        data = self._native.ffi.new("brace_stance_state_t *")
        offsets = self._native.ffi.new("double[]", np.ravel(offset_mm).tolist())
        self._check(self._native.lib.brace_stance_place(self._stance, offsets, data))
        return State(self._native, self.count, data)

    def settle(self, state: State, forces: Sequence[Force], slide_steps: int = SLIDE_STEPS) -> tuple[int, float]:
        """Moves the state to a load: status and the share of the way that was gone."""
        share = self._native.ffi.new("double *")
        status = self._native.lib.brace_stance_settle(self._stance, self._load(forces), slide_steps, state.data, share)
        if status not in (OK, E_LOOSE, E_NO_REST):
            self._check(status)
        return int(status), float(share[0])

    def first_slip(self, state: State, further: Sequence[Force], most: float) -> Slip:
        """The first foot that moves when this load is added, up to `most` times."""
        found = self._native.ffi.new("brace_stance_slip_t *")
        self._check(
            self._native.lib.brace_stance_first_slip(self._stance, self._load(further), most, state.data, found)
        )
        return Slip(float(found.factor), int(found.limb), int(found.contact))

    def linear(self, state: State, forces: Sequence[Force]) -> tuple[np.ndarray, np.ndarray]:
        """All feet's forces [N] under a load at the state's places (3 n), and how they change with the places
        (3 n x 3 n, N/mm)."""
        size = 3 * self.count
        stiffness, at_rest = np.zeros((size, size)), np.zeros(size)
        buffer = self._native.ffi.from_buffer
        self._check(
            self._native.lib.brace_stance_linear(
                self._stance, self._load(forces), state.data, buffer("double[]", stiffness), buffer("double[]", at_rest)
            )
        )
        return at_rest, stiffness

    def margin_n(self, limb: int, force_n: np.ndarray) -> float:
        """How much more a foot's tangential force may be."""
        one = self._native.ffi.addressof(self._stance.limb[limb])
        return float(self._native.lib.brace_stance_margin_n(one, force_n.tolist()))

    def _load(self, forces: Sequence[Force]) -> CData:
        load = self._native.ffi.new("brace_stance_load_t *")
        for force, at in forces:
            self._native.lib.brace_stance_load_add(load, force.tolist(), at.tolist())
        return load

    def _check(self, status: int) -> None:
        if status != OK:
            raise LooseError(self._native.ffi.string(self._native.lib.brace_stance_status_text(status)).decode())


class LooseError(Exception):
    """The limbs do not hold the body, or a number is refused; the text says which."""
