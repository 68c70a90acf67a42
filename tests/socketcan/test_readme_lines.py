"""The lines that the README's first page prints for the wire, run as they are printed."""

from __future__ import annotations

import contextlib
import re
import select
import shutil
import subprocess
import time
from collections.abc import Iterator

import pytest
from terminal import screen_of
from wire_by_hand import PROJECT, expected

STANDS_RAD = (1.0, 1.4)  # brace sim's default
PLACES = {"can": r"can tcp://127\.0\.0\.1:(\d+)", "modbus": r"modbus_tcp modbus-tcp://127\.0\.0\.1:(\d+)"}
NUMBER = r"(\d+\.\d+) N/mm"
PRINTED = {"can": "29536", "modbus": "1502"}


def line_with(word: str) -> str:
    """The one line of code of the README that has a word."""
    found = [line.strip() for line in (PROJECT / "README.md").read_text().splitlines() if re.match(r" {4}\S", line)]
    found = [line for line in found if word in line]
    assert len(found) == 1, f"{word}: {found}"
    return found[0]


@pytest.fixture(scope="module")
def ports() -> Iterator[dict[str, str]]:
    """`brace sim` as printed. Its ports, which are the printed ones unless another program has them for a while."""
    if not (PROJECT / ".venv" / "bin" / "brace").exists():
        pytest.skip("no .venv: ./dev setup makes it")
    with contextlib.ExitStack() as stack:
        end = time.monotonic() + 20.0
        while True:
            sim = subprocess.Popen(["bash", "-c", f"exec {line_with('brace sim ')}"], cwd=PROJECT, text=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE)  # fmt: skip
            stack.enter_context(sim)
            stack.callback(sim.kill)
            assert sim.stdout is not None and select.select([sim.stdout], [], [], 60.0)[0], "brace sim says nothing"
            first = sim.stdout.readline()
            found = {name: match[1] for name, pattern in PLACES.items() if (match := re.search(pattern, first))}
            assert set(found) == set(PLACES), first
            if found == PRINTED or time.monotonic() > end:
                break
            sim.kill()
            time.sleep(1.0)
        yield found


def as_printed(word: str, port: tuple[str, str]) -> list[str]:
    """The line, for a shell; with the port that was free, when the printed one is another program's."""
    printed, actual = port
    line = line_with(word)
    assert printed in line
    return ["/bin/bash", "-c", f"cd '{PROJECT}' && exec {line.replace(printed, actual)}"]


def test_cantools_monitor_as_printed(ports: dict[str, str]) -> None:
    true = expected(*STANDS_RAD)
    text = screen_of(
        as_printed("cantools monitor", (PRINTED["can"], ports["can"])), [rf"\b{name}: {NUMBER}" for name in ("k_xx", "k_zz")]
    )
    for name, value in (("k_xx", true.xx), ("k_zz", true.zz)):
        shown = re.search(rf"\b{name}: {NUMBER}", text)
        assert shown and float(shown[1]) == pytest.approx(value, abs=0.01)


def test_mbpoll_as_printed(ports: dict[str, str]) -> None:
    if shutil.which("mbpoll") is None:
        pytest.skip("mbpoll is missing (Debian package mbpoll)")
    command = as_printed("mbpoll", (PRINTED["modbus"], ports["modbus"]))
    run = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert run.returncode == 0, run.stdout + run.stderr
    values = [float(value) for value in re.findall(r"^\[\d+\]:\s+(-?\d+\.?\d*(?:e-?\d+)?)\s*$", run.stdout, re.M)]
    true = expected(*STANDS_RAD)
    assert values == pytest.approx([true.xx, true.xz, true.zz, true.low, true.high], abs=0.02), run.stdout
