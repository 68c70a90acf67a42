"""The driver on an emulated STM32F405, over its USART6: its image reads simulated servos on a pseudo-terminal."""

from __future__ import annotations

import math
import re
import sys
import time
from pathlib import Path

import pytest
from brace.sim.servos import ServoLine

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "emulated"))

from board import PATIENCE_S, Board, image  # noqa: E402

COUNT_RAD = 2 * math.pi / 4096
NULLS = ("-serial", "null") * 4  # between the console and USART6


def angles(board: Board) -> tuple[float, float] | None:
    """theta1 and theta2 as the console's `k` reports them; None: not yet."""
    board.ask("k")
    found = re.search(r"theta1_rad (\S+) theta2_rad (\S+)", board.until(r"^k: ")[-1])
    return (float(found[1]), float(found[2])) if found else None


def test_the_board_reads_its_servos() -> None:
    with ServoLine((12, 13)) as line:
        line.shaft(0, math.pi + 1.0)
        line.shaft(1, math.pi + 1.4)
        options = (*NULLS, "-chardev", f"serial,id=servos,path={line.place}", "-serial", "chardev:servos")
        with Board("netduinoplus2", image("brace-netduinoplus2-servos"), *options) as board:
            board.banner()
            end = time.monotonic() + PATIENCE_S
            while (reported := angles(board)) is None:
                assert time.monotonic() < end
                time.sleep(0.1)  # the console's words take the board's time, which its servos need
            assert reported == pytest.approx((1.0, 1.4), abs=COUNT_RAD + 1e-3)
            assert [line.peek(place, 64, 1) for place in (0, 1)] == [1, 1]  # they were commanded to hold
