"""What a controller can be asked, whatever the wire."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from brace.bus.drift import Drift
from brace.bus.interval import Interval
from brace.bus.load import Load
from brace.bus.sigma import Sigma
from brace.bus.snapshot import Snapshot
from brace.bus.space import SpaceAnswer
from brace.ground.errors import VersionMismatchError
from brace.wire.frames import DICTIONARY_HASH
from brace.wire.layout import Value

if TYPE_CHECKING:
    from brace.params import Block

Advance = Callable[[int], None]


@dataclass(frozen=True)
class Identity:
    """Who speaks."""

    node: int
    version: str
    dictionary_hash: int
    parameter_crc: int
    origin: str  # default, slot_a, slot_b


@dataclass(frozen=True)
class StiffnessAnswer:
    """K where the limb need not be; None: not known."""

    k_xx: Value  # N/mm
    k_xz: Value
    k_zz: Value
    lambda_min: Value
    lambda_max: Value
    stiff_axis: Value  # rad
    flags: tuple[str, ...]
    moved_x: Value = None  # mm, by the force that was asked for and the weight
    moved_z: Value = None
    buckling_factor: Value = None  # infinite: none


Force = tuple[float, float]  # of the ground on the tip, x and z [N]
SpaceForce = tuple[float, float, float]  # the same: outwards in the limb's plane, across it to the left, upwards
NO_FORCE = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Stored:
    """A set that is in force now."""

    sequence: int
    crc: int  # of its values


class Controller(Protocol):
    """One controller. Every call ends in time, NoDeviceError when no answer came."""

    url: str
    node: int

    def identify(self) -> Identity: ...

    def live(self) -> Snapshot:
        """The newest snapshot, with eigenvalues and posture, and with K in space where there is one."""

    def k_at_posture(self, theta1_rad: float, theta2_rad: float, force_n: Force | None = None) -> StiffnessAnswer:
        """Under the weight, and under a force where one is given. Angles are those before the load turns the joints."""

    def k_in_space_at_posture(
        self, theta0_rad: float, theta1_rad: float, theta2_rad: float, force_n: SpaceForce = NO_FORCE
    ) -> SpaceAnswer:
        """Under the weight and a force. Angles are those before the load turns the joints."""

    def drift(self) -> Drift: ...

    def take_ups(self) -> dict[str, str]:
        """How the last take-up of each joint went, by the joint's name."""

    def k_at_tip(self, x_mm: float, z_mm: float, knee_up: bool, force_n: Force | None = None) -> StiffnessAnswer:
        """The same with the tip at a place before the load moves it."""

    def engaged_k(self) -> tuple[Value, Value, Value] | None:
        """K xx, xz, zz with every gap closed; None: this wire does not send it at once."""

    def load(self) -> Load:
        """What the K of now counts."""

    def interval(self) -> Interval:
        """Where the force on the tip and the loads of the joints lie with 90 %."""

    def sigma(self) -> Sigma:
        """How sure the controller is of the K of now."""

    def set_gravity(self, direction_rad: float, lean_rad: float) -> tuple[Value, Value]:
        """Where down is, until the controller's next start; NaN for both: as the parameters say. returns what holds."""

    def sag_for_load(self, fx_n: float, fz_n: float) -> dict[str, Value]: ...

    def contact_force(self, dx_mm: float, dz_mm: float) -> dict[str, Value]: ...

    def read_entry(self, name: str) -> int:
        """32 bits of a measured value or a parameter."""

    def clear(self, faults: int) -> int:
        """Takes back faults that stay until cleared; both as the dictionary's bits. returns those there now."""

    def take_up(self, joint: str, flank: int) -> None:
        """Begins to take up backlash, until its side `flank`, +1 or -1, is loaded; take_ups reports how it goes."""

    def let_go(self) -> None:
        """Begins to let go of every joint that was taken up."""

    def living(self) -> AbstractContextManager[None]:
        """While the limb moves: gives signs of life, also within `stay`. Without them it stands."""

    def stay(self, seconds: float) -> None:
        """Waits."""

    def enter_configuration(self) -> None: ...

    def leave_configuration(self) -> None: ...

    def upload(self, block: Block, advance: Advance) -> None:
        """Hands a set over; nothing is in force yet."""

    def commit(self, block: Block) -> Stored: ...

    def rollback(self) -> Stored: ...

    def download(self, advance: Advance) -> Block:
        """The set in force."""

    def close(self) -> None: ...


def check_dictionary(found: int, where: str, version: str = "") -> None:
    """Both ends speak of the same values, or not at all."""
    if found != DICTIONARY_HASH:
        raise VersionMismatchError(
            f"the controller's dictionary is {found:08x}, ours {DICTIONARY_HASH:08x}",
            where=where,
            why=f"firmware{' ' + version if version else ''} and this brace were built from different "
            f"lists of values: the "
            "same bits would mean something else",
            next_step="flash the firmware of this version (brace flash), or use the brace that came with that firmware",
        )
