"""A controller over CAN."""

from __future__ import annotations

import math
import struct
import time
from collections.abc import Iterable
from contextlib import AbstractContextManager
from typing import TYPE_CHECKING

from brace.bus.controller import (
    NO_FORCE,
    Advance,
    Force,
    Identity,
    SpaceForce,
    StiffnessAnswer,
    Stored,
    check_dictionary,
)
from brace.bus.drift import TAKE_UPS, Drift, drift_of, take_up_of
from brace.bus.entries import index_of
from brace.bus.interval import INTERVAL_ENTRIES, Interval, interval_of
from brace.bus.load import ACROSS_ENTRIES, LOAD_ENTRIES, Load, load_of
from brace.bus.session import Session
from brace.bus.sigma import SIGMA_ENTRIES, SPACE_ENTRIES, Sigma, sigma_of
from brace.bus.snapshot import Snapshot
from brace.bus.space import SpaceAnswer, space_answer
from brace.ground.errors import DeviceFaultError, NoDeviceError, NotVerifiedError
from brace.wire.codes import FAULT, FLAG, MODE, PARAMETER_ORIGIN
from brace.wire.layout import Value

if TYPE_CHECKING:
    from brace.params import Block

KEY = 0xC0DE
COMMIT_S = 2.5  # the store erases, writes and reads back
LIVE_S = 0.6  # twelve periods of the slower frames
_SIZE_WORD = 0xFFFF
_MODES = {code.name.lower(): code.number for code in MODE.codes}


class CanController:
    """One node. The dictionary is compared before anything else is asked."""

    def __init__(self, session: Session) -> None:
        self.session = session
        self.node = session.node
        self.url = session.bus.url
        self._identity = self._identify()

    def _identify(self) -> Identity:
        answer = {name: int(value or 0) for name, value in self.session.ask("identify").items()}
        version = f"{answer['major']}.{answer['minor']}.{answer['patch']}"
        check_dictionary(answer["dictionary_hash"], self.session.where, version)
        self.session.joiner.hear_faults(self.node, tuple(n.lower() for n in FAULT.names_of_bits(answer["faults"])))
        origin = PARAMETER_ORIGIN.word_of(int(answer["origin"] or 0))
        return Identity(self.node, version, answer["dictionary_hash"], answer["parameter_crc"], origin)

    def identify(self) -> Identity:
        """Asked anew."""
        self._identity = self._identify()
        return self._identity

    def live(self) -> Snapshot:
        """The next snapshot that comes with all that this node sends of it; K alone where eigenvalues and posture are
        not sent."""
        until = time.monotonic() + LIVE_S
        alone: Snapshot | None = None
        while (left := until - time.monotonic()) > 0:
            frame = self.session.receive(left)
            newest = self.session.newest.get(self.node)
            if frame is None or frame.node != self.node or newest is None:
                continue
            if self.session.joiner.is_complete(newest):
                del self.session.newest[self.node]
                return newest._replace(faults=self.session.joiner.faults_of(self.node))
            alone = newest
        if alone is not None:
            return alone._replace(faults=self.session.joiner.faults_of(self.node))
        raise NoDeviceError(
            "no K comes",
            where=self.session.where,
            why="the controller answers, and sends no process data",
            next_step="set controller.stiffness_hz and posture_hz (brace params push), or ask: --theta1 --theta2",
        )

    def k_at_posture(self, theta1_rad: float, theta2_rad: float, force_n: Force | None = None) -> StiffnessAnswer:
        """True angles."""
        return self._ask_k("at_posture", {"theta1": theta1_rad, "theta2": theta2_rad}, force_n)

    def _ask_k(self, where: str, place: dict[str, Value], force_n: Force | None) -> StiffnessAnswer:
        if force_n is None:
            return _stiffness(self.session.ask(f"k_{where}", place))
        force: dict[str, Value] = {"fx": force_n[0], "fz": force_n[1]}
        return _stiffness(self.session.ask_under_force(force, f"k_under_load_{where}", place))

    def load(self) -> Load:
        """Entry by entry, so of several snapshots."""
        return load_of(self._entries((*LOAD_ENTRIES, *ACROSS_ENTRIES)))

    def interval(self) -> Interval:
        """Entry by entry, as the load."""
        return interval_of(self._entries(INTERVAL_ENTRIES))

    def sigma(self) -> Sigma:
        """Entry by entry, as the load."""
        names = (*SIGMA_ENTRIES, *SPACE_ENTRIES)
        return sigma_of(self._entries([f"sigma_{name}" for name in names]), "sigma_")

    def _entries(self, names: Iterable[str]) -> dict[str, Value]:
        words = {name: struct.pack("<I", self.read_entry(name)) for name in names}
        return {name: float(struct.unpack("<f", word)[0]) for name, word in words.items()}

    def set_gravity(self, direction_rad: float, lean_rad: float) -> tuple[Value, Value]:
        """Volatile."""
        asked = {"direction": direction_rad, "lean": lean_rad}
        given = {name: None if math.isnan(value) else value for name, value in asked.items()}
        answer = self.session.ask("set_gravity", given)
        return answer["direction"], answer["lean"]

    def k_in_space_at_posture(
        self, theta0_rad: float, theta1_rad: float, theta2_rad: float, force_n: SpaceForce = NO_FORCE
    ) -> SpaceAnswer:
        """Refused where the limb has no coxa joint. No force is sent too: else another client's might count."""
        asked: dict[str, Value] = {"theta0": theta0_rad, "theta1": theta1_rad, "theta2": theta2_rad}
        force: dict[str, Value] = dict(zip(("fx", "fy", "fz"), force_n, strict=True))
        return space_answer(self.session.ask_under_force(force, "k_in_space_at_posture", asked))

    def drift(self) -> Drift:
        """What the check of model against measurement knows."""
        return drift_of(self.session.ask("drift"))

    def take_ups(self) -> dict[str, str]:
        """How each joint's last take-up went."""
        return {joint: take_up_of(self.read_entry(f"take_up_{joint}")) for joint in TAKE_UPS}

    def engaged_k(self) -> tuple[Value, Value, Value] | None:
        """No frame carries it."""
        return None

    def k_at_tip(self, x_mm: float, z_mm: float, knee_up: bool, force_n: Force | None = None) -> StiffnessAnswer:
        """From the femur axis."""
        return self._ask_k(f"at_tip_knee_{'up' if knee_up else 'down'}", {"x": x_mm, "z": z_mm}, force_n)

    def sag_for_load(self, fx_n: float, fz_n: float) -> dict[str, Value]:
        """Displacement of the tip [mm] under a force on it, with the K of now."""
        answer = self.session.ask("sag_for_load", {"fx": fx_n, "fz": fz_n})
        return {"dx_mm": answer["dx"], "dz_mm": answer["dz"]}

    def contact_force(self, dx_mm: float, dz_mm: float) -> dict[str, Value]:
        """Force [N] that holds the tip at a displacement, and what any displacement of its size meets."""
        answer = self.session.ask("contact_force", {"dx": dx_mm, "dz": dz_mm})
        return {"fx_n": answer["fx"], "fz_n": answer["fz"], "low_n": answer["low"], "high_n": answer["high"]}

    def read_entry(self, name: str) -> int:
        """32 bits."""
        index = index_of(name)
        answer = self.session.ask("read_entry", {"index": index})
        if answer["index"] != index:
            raise NoDeviceError(
                "an answer to another question", where=self.session.where, why="index", next_step="try again"
            )
        return int(answer["value"] or 0)

    def clear(self, faults: int) -> int:
        """The answer has what is there now."""
        return int(self.session.ask("clear", {"faults": faults})["faults"] or 0)

    def take_up(self, joint: str, flank: int) -> None:
        """It has begun when this returns."""
        self.session.ask("take_up", {"joint": TAKE_UPS.index(joint), "flank": flank})

    def let_go(self) -> None:
        """It has begun when this returns."""
        self.session.ask("let_go", {})

    def living(self) -> AbstractContextManager[None]:
        """Signs of life while frames are waited for."""
        return self.session.living()

    def stay(self, seconds: float) -> None:
        """Listens meanwhile."""
        self.session.listen(seconds)

    # --------------------------------------------------------------------------------------- parameters

    def enter_configuration(self) -> None:
        """From MONITOR or FAULT."""
        self._set_mode("configuration")

    def leave_configuration(self) -> None:
        """Back to MONITOR, by way of START."""
        self._set_mode("monitor")

    def _set_mode(self, mode: str) -> None:
        answer = self.session.ask("set_mode", {"mode": _MODES[mode], "key": KEY})
        now = MODE.word_of(int(answer["mode"] or 0))
        if (now == "configuration") != (mode == "configuration"):
            raise DeviceFaultError(
                f"the controller is in {now}, not in {mode}",
                where=self.session.where,
                why="it did not follow",
                next_step="brace query shows mode and faults",
            )

    def upload(self, block: Block, advance: Advance) -> None:
        """Word by word, each echoed."""
        content = block.content
        (crc,) = struct.unpack("<I", content[-4:])
        words = struct.unpack(f"<{len(content) // 4}I", content)
        expected = self.session.ask("upload_begin", {"bytes": len(content), "crc": crc})["words"]
        if expected != len(words):
            raise NotVerifiedError(
                f"the controller expects {expected} words, we have {len(words)}",
                where=self.session.where,
                why="nothing was changed: the set before is in force",
                next_step="brace query --entry dictionary_hash; flash the firmware of this version",
            )
        for number, word in enumerate(words):
            echo = self.session.ask("upload_word", {"word": number, "data": word})
            if echo["word"] != number or echo["data"] != word:
                raise NotVerifiedError(
                    f"word {number} came back as {int(echo['data'] or 0):08x}, not {word:08x}",
                    where=self.session.where,
                    why="nothing was changed: the set before is in force",
                    next_step="check the bus (brace monitor), and push again",
                )
            advance(number + 1)

    def commit(self, block: Block) -> Stored:
        """Answered when it is stored, read back and in force."""
        (crc,) = struct.unpack("<I", block.content[-4:])
        return _stored(self.session.ask("commit", {"crc": crc}, COMMIT_S))

    def rollback(self) -> Stored:
        """The set before."""
        return _stored(self.session.ask("rollback", timeout_s=COMMIT_S))

    def download(self, advance: Advance) -> Block:
        """The block in force, checked as any file."""
        from brace.params.block import unpack

        size = int(self.session.ask("download_word", {"word": _SIZE_WORD})["data"] or 0) & 0xFFFF
        words = []
        for number in range(size // 4):
            answer = self.session.ask("download_word", {"word": number})
            words.append(int(answer["data"] or 0))
            advance(number + 1)
        return unpack(struct.pack(f"<{len(words)}I", *words), self.session.where)

    def close(self) -> None:
        """The bus too."""
        self.session.bus.close()


def _stiffness(answer: dict[str, Value]) -> StiffnessAnswer:
    names = ("k_xx", "k_xz", "k_zz", "lambda_min", "lambda_max", "stiff_axis")
    values = {name: answer[name] for name in names}
    moved = {"moved_x": answer.get("dx"), "moved_z": answer.get("dz"), "buckling_factor": answer.get("buckling_factor")}
    return StiffnessAnswer(**values, **moved, flags=FLAG.names_of_bits(int(answer["flags"] or 0)))


def _stored(answer: dict[str, Value]) -> Stored:
    return Stored(int(answer["sequence"] or 0), int(answer["crc"] or 0))
