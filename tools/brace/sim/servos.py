"""Simulated Dynamixel servos on a pseudo-terminal: `python -m brace.sim.servos --ids 11 12 13` says which one."""

from __future__ import annotations

import argparse
import math
import os
import select
import threading
import time
import tty
from collections.abc import Sequence

from brace.ground.errors import UsageError
from brace.model.servos import servos
from brace.native import servos_library
from brace.native.c_data import CData

MODELS = {name: servo.number for name, servo in servos().items()}
_MOST_BYTES = 1024
_WAIT_S = 0.001
_MIDDLE_RAD = math.pi


class ServoLine:
    """Servos that answer on a pseudo-terminal. Each turns to its goal at once. Close it, or use it in a `with`."""

    def __init__(self, ids: Sequence[int], model: int = MODELS["MX-106"], baud: int = 3_000_000, seed: int = 0) -> None:
        self._native = servos_library()
        self._servos = self._native.lib.brace_servos_create(baud, seed)
        for identity in ids:
            if self._native.lib.brace_servos_add(self._servos, identity, model) < 0:
                raise UsageError(f"id {identity} twice, or beyond 252", why="each servo on a line has its own")
        self.ids = list(ids)
        self._master, self._slave = os.openpty()
        tty.setraw(self._slave)
        self.place = os.ttyname(self._slave)
        self._lock = threading.Lock()
        self._end = threading.Event()
        for index in range(len(ids)):
            self.shaft(index, _MIDDLE_RAD)
        self._thread = threading.Thread(target=self._serve, daemon=True)
        self._thread.start()

    def __enter__(self) -> ServoLine:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Ends the servos. Twice is once."""
        if not self._end.is_set():
            self._end.set()
            self._thread.join()
            os.close(self._master)
            os.close(self._slave)
            self._native.lib.brace_servos_destroy(self._servos)

    # ------------------------------------------------------------------------------------------ what happens to them

    def peek(self, index: int, address: int, count: int) -> int:
        """A register, by the servo's place among the ids."""
        with self._lock:
            return int(self._native.lib.brace_servos_peek(self._servos, index, address, count))

    def poke(self, index: int, address: int, count: int, value: int) -> None:
        """Sets a register, whatever its access."""
        with self._lock:
            self._native.lib.brace_servos_poke(self._servos, index, address, count, value)

    def shaft(self, index: int, turned_rad: float, current_a: float = 0.0, temp_degc: float = 25.0) -> None:
        """Turns a servo's shaft."""
        with self._lock:
            self._native.lib.brace_servos_shaft(self._servos, index, turned_rad, 0.0, current_a, temp_degc)

    def plug(self, index: int, is_in: bool) -> None:
        """Pulls a servo's cable, or puts it in again."""
        with self._lock:
            self._native.lib.brace_servos_plug(self._servos, index, is_in)

    def fail(self, index: int, hardware_error: int) -> None:
        """A hardware error as register 70 has it."""
        with self._lock:
            self._native.lib.brace_servos_break(self._servos, index, hardware_error)

    def damage(self, share: float) -> None:
        """Damages so many of the packets, on both ways."""
        with self._lock:
            self._native.lib.brace_servos_damage(self._servos, share)

    # ------------------------------------------------------------------------------------------------- the line

    def _serve(self) -> None:
        lib, ffi = self._native.lib, self._native.ffi
        spoken: CData = ffi.new("uint8_t[]", _MOST_BYTES)
        goal_rad, current_a = ffi.new("double *"), ffi.new("double *")
        while not self._end.is_set():
            ready, _, _ = select.select([self._master], [], [], _WAIT_S)
            heard = os.read(self._master, _MOST_BYTES) if ready else b""
            now_ns = time.monotonic_ns()
            with self._lock:
                if heard:
                    lib.brace_servos_hear(self._servos, now_ns, heard, len(heard))
                for index in range(len(self.ids)):
                    if lib.brace_servos_goal(self._servos, index, goal_rad, current_a):
                        lib.brace_servos_shaft(self._servos, index, goal_rad[0], 0.0, 0.0, 25.0)
                # A pseudo-terminal has no bit rate: what will have come within a millisecond comes at once.
                count = lib.brace_servos_give(self._servos, now_ns + 1_000_000, spoken, _MOST_BYTES)
            if count:
                os.write(self._master, bytes(spoken[0:count]))


def main(arguments: Sequence[str] | None = None) -> int:
    """Says where the servos are, and runs until Ctrl-C."""
    parser = argparse.ArgumentParser(prog="python -m brace.sim.servos", description=__doc__)
    parser.add_argument("--ids", type=int, nargs="+", default=[11, 12, 13], help="default 11 12 13")
    parser.add_argument("--model", choices=sorted(MODELS), default="MX-106", help="default MX-106")
    given = parser.parse_args(arguments)
    with ServoLine(given.ids, MODELS[given.model]) as line:
        print(line.place, flush=True)
        try:
            threading.Event().wait()
        except KeyboardInterrupt:
            pass
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
