"""brace's own bus commands on the emulated STM32F405 image: its SLCAN port and its Modbus RTU port."""

from __future__ import annotations

import contextlib
import json
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from processes import SLOWER, emulated
from wire_by_hand import LIMB, paper_k

STANDS_RAD, ASKED_RAD = (1.0, 1.4), (0.5, 1.2)
MATRIX = ("k_xx_n_per_mm", "k_xz_n_per_mm", "k_zz_n_per_mm")


@contextlib.contextmanager
def board(folder: Path) -> Iterator[dict[str, str]]:
    """An emulated board; the URL of each of its ports. The emulator looks for a new client once a second, and a request
    of that second is lost: the Modbus port, which says nothing unasked, is held open between the commands."""
    with emulated(folder, clock=SLOWER) as places:
        held = os.open(places["modbus"], os.O_RDWR | os.O_NOCTTY)
        try:
            yield {"slcan": f"slcan:{places['slcan']}", "modbus": f"modbus:{places['modbus']}@115200/1"}
        finally:
            os.close(held)


@pytest.fixture(scope="module")
def urls(tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[str, str]]:
    """One board for the tests that store nothing."""
    with board(tmp_path_factory.mktemp("board")) as found:
        yield found


@pytest.fixture()
def urls_of_fresh_board(tmp_path: Path) -> Iterator[dict[str, str]]:
    """A board that has stored nothing yet: it stores once in ten seconds of its own clock."""
    with board(tmp_path) as found:
        yield found


def brace(*arguments: object) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "brace", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=180, check=False)


def assert_k(entry: dict[str, float], theta1: float, theta2: float) -> None:
    true = paper_k(theta1, theta2)
    for name, value in zip(MATRIX, (true[0, 0], true[0, 1], true[1, 1])):
        assert abs(entry[name] - value) < 0.003  # the wire's step, and the encoders' at the posture it stands in


# First: an emulated board works as long as it is there, and the one of the other test stays until the end.
@pytest.mark.parametrize("wire", ["slcan", "modbus"])
def test_the_board_takes_parameters_and_gives_them_back(
    urls_of_fresh_board: dict[str, str], wire: str, tmp_path: Path
) -> None:
    url = urls_of_fresh_board[wire]
    other = tmp_path / "other.toml"
    other.write_text(LIMB.read_text().replace("tibia_mm = 313.5", f"tibia_mm = {310 + len(wire)}.5"))
    pushed = brace("params", "push", other, "--bus", url, "--json")
    assert pushed.returncode == 0, pushed.stderr
    assert brace("params", "diff", other, "--bus", url, "--check").returncode == 0
    back = brace("params", "rollback", "--bus", url, "--json")
    assert back.returncode == 0, back.stderr
    assert json.loads(back.stdout)["parameter_crc_before"] == json.loads(pushed.stdout)["parameter_crc"]
    assert brace("params", "diff", LIMB, "--bus", url, "--check").returncode == 0


@pytest.mark.parametrize("wire", ["slcan", "modbus"])
def test_the_board_is_queried(urls: dict[str, str], wire: str) -> None:
    live = brace("query", "--bus", urls[wire], "--json")
    assert live.returncode == 0, live.stderr
    assert_k(json.loads(live.stdout), *STANDS_RAD)
    asked = brace("query", "--bus", urls[wire], "--theta1", ASKED_RAD[0], "--theta2", ASKED_RAD[1], "--json")
    assert asked.returncode == 0, asked.stderr
    assert_k(json.loads(asked.stdout), *ASKED_RAD)
