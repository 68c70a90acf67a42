"""real_tools.py INTERFACE [sim | slcand TTY] [TOOL ...]: run where the kernel has CAN. Brings a controller onto the
interface (the simulated one, or whoever speaks SLCAN on TTY), then candump, cansend, python-can with cantools and the C
client talk to it, or only the tools that are named. Prints what each saw as one JSON object; the tests judge it."""

from __future__ import annotations

import contextlib
import json
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import can
import cantools
from wire_by_hand import ANSWER, DBC, LIMB, NODE, PROJECT, REQUEST, k_request

QUIET = Path("/dev/shm/quiet-limb.toml")  # the guest's own: its disk is read-only

ASKED_RAD = (0.7, 1.1)  # not where the limb stands
ANSWERS = 4
CLIENT = PROJECT / "build" / "host" / "tools" / "client"


@contextlib.contextmanager
def process(*command: object, **options: Any) -> Iterator[subprocess.Popen[str]]:
    """One that is ended with the test."""
    running = subprocess.Popen([str(word) for word in command], text=True, **options)
    try:
        yield running
    finally:
        running.send_signal(signal.SIGTERM)
        try:
            running.communicate(timeout=30)
        except subprocess.TimeoutExpired:
            running.kill()
            running.communicate()


@contextlib.contextmanager
def simulated(interface: str) -> Iterator[None]:
    """`brace sim` whose force sensor is free of noise: K counts the force that it reads."""
    options = ("--model", LIMB, "--plant", QUIET, "--json", "--can", interface, "--modbus", "none")
    QUIET.write_text(LIMB.read_text() + "\n[sensor]\nnoise_n = 0.0\n")
    with process(sys.executable, "-m", "brace", "sim", *options, stdout=subprocess.PIPE) as sim:
        assert sim.stdout is not None
        assert json.loads(sim.stdout.readline())["limbs"][0]["can"] == interface
        yield


@contextlib.contextmanager
def adapted(interface: str, tty: str) -> Iterator[None]:
    """slcand makes an interface of a serial line."""
    with process("slcand", "-F", "-o", "-c", "-s8", tty, interface, stdout=subprocess.DEVNULL):
        end = time.monotonic() + 40.0
        while not Path(f"/sys/class/net/{interface}").exists():
            assert time.monotonic() < end, f"slcand made no {interface}"
            time.sleep(0.05)
        subprocess.run(["ip", "link", "set", interface, "up"], check=True)
        yield


def lines_of(*command: object, timeout: float = 60.0) -> list[str]:
    run = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=timeout, check=False)
    return (run.stdout + run.stderr).splitlines()


def with_candump(interface: str) -> list[str]:
    """What goes by in a while."""
    return lines_of("timeout", 30, "candump", "-L", "-n", 250, interface)


def with_cansend(interface: str) -> list[str]:
    """A request written by hand; the answer as candump prints it."""
    request = k_request(0xA5, *ASKED_RAD).hex()
    only = f"{interface},{ANSWER + NODE:x}:7ff"
    with subprocess.Popen(
        ["candump", "-L", "-n", str(ANSWERS), "-T", "8000", only], stdout=subprocess.PIPE, text=True
    ) as dump:
        time.sleep(1.0)
        subprocess.run(["cansend", interface, f"{REQUEST + NODE:x}#{request}"], check=True)
        out, _ = dump.communicate(timeout=60)
    return out.splitlines()


def with_python_can(interface: str) -> dict[str, Any]:
    """Messages by name, decoded with the DBC; a request and its answer encoded and decoded with it too."""
    database: Any = cantools.database.load_file(DBC)
    first: dict[str, Any] = {}
    answer: dict[str, Any] = {}
    with can.Bus(interface="socketcan", channel=interface) as bus:
        theta1, theta2 = ASKED_RAD
        fields = {"code": 3, "token": 90, "k_at_posture_theta1": theta1, "k_at_posture_theta2": theta2}
        request = database.get_message_by_name("request")
        bus.send(can.Message(arbitration_id=request.frame_id, data=request.encode(fields), is_extended_id=False))
        end = time.monotonic() + 10.0
        while time.monotonic() < end and (len(first.keys() - {"emergency"}) < 6 or len(answer) < 8):
            frame = bus.recv(0.2)
            if frame is None or frame.arbitration_id == request.frame_id:
                continue
            if frame.arbitration_id & 0x7F != NODE:
                continue  # the DBC is node 1's
            message = database.get_message_by_frame_id(frame.arbitration_id)
            signals = message.decode(bytes(frame.data), decode_choices=False)
            if message.name == "answer":
                answer |= {name: value for name, value in signals.items() if name != "number"}
            else:
                first.setdefault(message.name, signals)
    return {"messages": first, "answer": answer}


def with_c_client(interface: str) -> dict[str, Any] | None:
    """The C library's example, which prints K with units; None: it is not built."""
    found = sorted(CLIENT.rglob("print_k"))
    if not found:
        return None
    run = subprocess.run(
        [found[0], interface, str(NODE)], capture_output=True, text=True, timeout=60, check=False
    )
    return {"code": run.returncode, "out": run.stdout, "err": run.stderr}


TOOLS = {
    "candump": with_candump,
    "cansend": with_cansend,
    "python_can": with_python_can,
    "c_client": with_c_client,
}


def main() -> None:
    interface, kind, *rest = sys.argv[1:]
    tools = rest if kind == "sim" else rest[1:]
    with simulated(interface) if kind == "sim" else adapted(interface, rest[0]):
        time.sleep(1.0)
        print(json.dumps({name: TOOLS[name](interface) for name in tools or TOOLS}, default=float))


if __name__ == "__main__":
    main()
