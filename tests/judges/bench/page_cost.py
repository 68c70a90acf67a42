"""What `brace monitor --web` costs: processor time of its server, of the system too, over the wall clock. A bus with
four moving limbs at the default rates, reported in real time over TCP; browsers that read all that is sent.

    .venv/bin/python tests/judges/bench/page_cost.py [--readers 1] [--seconds 30]

Prints PASS or MISS for each limit; exit code 1: one is missed. Judged are processor time (user and system) for each
second of the bus, and how many updates came."""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import os
import re
import socket
import subprocess
import sys
import threading
import time
from pathlib import Path

import aiohttp

import four_limbs

PROJECT = Path(__file__).resolve().parents[3]
LIMB = PROJECT / "tools" / "brace" / "data" / "paper-limb.toml"
SETTLE_S = 3.0  # modules are loaded, cards are made
SHARE_MOST = 0.05  # of one core
UPDATES_LEAST = 29.5  # a second: of the 30 one may fall to the next second


class Adapter:
    """An SLCAN adapter on TCP that sends what its bus says, each 5 ms when they have come."""

    def __init__(self) -> None:
        self.server = socket.create_server(("127.0.0.1", 0))
        self.port = self.server.getsockname()[1]
        self.late_s = 0.0
        threading.Thread(target=self._serve, daemon=True).start()

    def _serve(self) -> None:
        client, _ = self.server.accept()
        client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        threading.Thread(target=self._answer, args=(client,), daemon=True).start()
        ticks = four_limbs.lines_by_tick(four_limbs.STIFFNESS_S)
        begun = time.monotonic()
        number = 0
        with contextlib.suppress(OSError):
            while True:
                due = begun + number * four_limbs.STIFFNESS_S
                time.sleep(max(due - time.monotonic(), 0.0))
                self.late_s = max(self.late_s, time.monotonic() - due)
                client.sendall(ticks[number % len(ticks)])
                number += 1

    @staticmethod
    def _answer(client: socket.socket) -> None:
        with contextlib.suppress(OSError):
            while part := client.recv(4096):
                for line in part.split(b"\r")[:-1]:
                    client.sendall(b"V1013\r" if line == b"V" else b"\r")


def cpu_s(process: int) -> float:
    """User and system time that a process has used."""
    fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


async def reader(session: aiohttp.ClientSession, address: str, counts: list[int], number: int) -> None:
    """Counts what comes."""
    async with session.ws_connect(address + "live", max_msg_size=0) as live:
        async for _ in live:
            counts[number] += 1


async def measure(address: str, process: int, readers: int, seconds: float) -> tuple[float, float]:
    """Share of one core, and updates a second of the slowest reader."""
    counts = [0] * readers
    async with aiohttp.ClientSession() as session:
        tasks = [asyncio.create_task(reader(session, address, counts, number)) for number in range(readers)]
        await asyncio.sleep(SETTLE_S)
        before, begun, first = cpu_s(process), time.monotonic(), list(counts)
        await asyncio.sleep(seconds)
        used, wall = cpu_s(process) - before, time.monotonic() - begun
        least = min(count - early for count, early in zip(counts, first, strict=True))
        for task in tasks:
            task.cancel()
        return used / wall, least / wall


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n\n")[0])
    parser.add_argument("--readers", type=int, default=1, help="browsers that read the page at once")
    parser.add_argument("--seconds", type=float, default=30.0)
    asked = parser.parse_args()
    adapter = Adapter()
    command = [sys.executable, "-m", "brace", "monitor", "--bus", f"tcp://127.0.0.1:{adapter.port}", "--web", "0"]
    process = subprocess.Popen([*command, "--model", str(LIMB)], stdout=subprocess.PIPE, text=True)
    try:
        assert process.stdout is not None
        address = re.search(r"http://\S+", process.stdout.readline())
        assert address is not None
        share, rate = asyncio.run(measure(address[0], process.pid, asked.readers, asked.seconds))
    finally:
        process.terminate()
        process.wait()
    print(f"{asked.readers} readers, {four_limbs.NODES} limbs: {100.0 * share:.2f} % of one core, {rate:.1f} updates a "
          f"second; load of the machine {os.getloadavg()[0]:.1f}, frames at most {1e3 * adapter.late_s:.0f} ms late")
    kept = {f"less than {SHARE_MOST:.0%} of one core": share < SHARE_MOST,
            f"at least {UPDATES_LEAST} updates a second": rate >= UPDATES_LEAST}
    for limit, is_kept in kept.items():
        print("PASS" if is_kept else "MISS", limit)
    return 0 if all(kept.values()) else 1


if __name__ == "__main__":
    sys.exit(main())
