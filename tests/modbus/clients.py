"""Three independent Modbus clients behind one face: libmodbus (C), mbpoll, pymodbus. Registers are whole numbers of 16
bits; what a client cannot say it does not offer."""

from __future__ import annotations

import functools
import re
import select
import shutil
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import pytest

BAUD = 115200  # without parity: a pty has none, and says so
ANSWER_S = 10.0  # the longest that mbpoll allows; an emulated board on a busy machine takes one
PATIENCE_S = 60.0
HERE = Path(__file__).resolve().parent


class Refused(Exception):
    """The server's exception."""

    def __init__(self, code: int) -> None:
        super().__init__(f"exception {code}")
        self.code = code


@dataclass(frozen=True)
class Place:
    """Where a server is: a device, or a host and port."""

    name: str
    device: str = ""
    host: str = ""
    port: int = 0
    unit: int = 1


class Client(Protocol):
    """What every client can."""

    def read(self, table: str, address: int, count: int) -> list[int]:
        """Registers of the input or holding table."""

    def write(self, address: int, values: list[int]) -> None:
        """Function 16."""

    def close(self) -> None:
        """Ends it."""


@functools.cache
def _libmodbus_program() -> Path:
    if shutil.which("pkg-config") is None or shutil.which("gcc") is None:
        pytest.skip("pkg-config or gcc is missing")
    found = subprocess.run(["pkg-config", "--cflags", "--libs", "libmodbus"], capture_output=True, text=True,
                           check=False)
    if found.returncode != 0:
        pytest.skip("libmodbus is missing (Debian package libmodbus-dev)")
    program = Path(tempfile.mkdtemp(prefix="brace-libmodbus-")) / "client"
    source = HERE / "libmodbus_client.c"
    subprocess.run(["gcc", "-std=c11", "-Wall", "-Wextra", source, "-o", program, *found.stdout.split()], check=True)
    return program


class Libmodbus:
    """Debian's libmodbus through a small C program."""

    def __init__(self, place: Place) -> None:
        where = ["rtu", place.device, str(BAUD)] if place.device else ["tcp", place.host, str(place.port)]
        self._process = subprocess.Popen(
            [_libmodbus_program(), *where, str(place.unit)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )

    def _ask(self, *words: object) -> list[int]:
        assert self._process.stdin is not None and self._process.stdout is not None
        self._process.stdin.write(" ".join(map(str, words)) + "\n")
        self._process.stdin.flush()
        assert select.select([self._process.stdout], [], [], PATIENCE_S)[0], "libmodbus says nothing"
        kind, *rest = self._process.stdout.readline().split()
        if kind == "exception":
            raise Refused(int(rest[0]))
        assert kind == "ok", f"{words}: {kind} {rest}"
        return [int(word) for word in rest]

    def read(self, table: str, address: int, count: int) -> list[int]:
        return self._ask("r4" if table == "input" else "r3", address, count)

    def write(self, address: int, values: list[int]) -> None:
        self._ask("w", address, *values)

    def write_one(self, address: int, value: int) -> None:
        """Function 06."""
        self._ask("w6", address, value)

    def server_id(self) -> bytes:
        """Function 17."""
        return bytes(self._ask("id"))

    def close(self) -> None:
        self._process.kill()
        self._process.communicate()


class Mbpoll:
    """Debian's mbpoll, a process per request."""

    WORDS = {"Illegal function": 1, "Illegal data address": 2, "Illegal data value": 3,
             "Slave device or server failure": 4,
             "Slave device or server is busy": 6}  # fmt: skip

    def __init__(self, place: Place) -> None:
        if shutil.which("mbpoll") is None:
            pytest.skip("mbpoll is missing (Debian package mbpoll)")
        self._place = place

    def _run(self, options: list[str], values: list[int]) -> str:
        place = self._place
        where = ["-m", "rtu", "-b", str(BAUD), "-P", "none"] if place.device else ["-m", "tcp", "-p", str(place.port)]
        command = ["mbpoll", *where, "-a", str(place.unit), "-0", "-1", "-o", f"{ANSWER_S:.0f}", *options,
                   place.device or place.host]
        run = subprocess.run([*command, *map(str, values)], capture_output=True, text=True, timeout=PATIENCE_S,
                             check=False)
        said = run.stdout + run.stderr
        for words, code in self.WORDS.items():
            if words in said:
                raise Refused(code)
        assert run.returncode == 0 and "failed" not in said, said
        return said

    def read(self, table: str, address: int, count: int) -> list[int]:
        kind = "3:hex" if table == "input" else "4:hex"
        said = self._run(["-t", kind, "-r", str(address), "-c", str(count)], [])
        found = re.findall(r"^\[(\d+)\]:\s+0x([0-9A-F]{4})$", said, re.M)
        assert [int(place) for place, _ in found] == list(range(address, address + count)), said
        return [int(value, 16) for _, value in found]

    def write(self, address: int, values: list[int]) -> None:
        self._run(["-t", "4", "-r", str(address)], values)

    def close(self) -> None:
        pass


class Pymodbus:
    """pymodbus, without its retries."""

    def __init__(self, place: Place) -> None:
        client = pytest.importorskip("pymodbus.client")
        common: dict[str, Any] = {"timeout": ANSWER_S, "retries": 0}
        self._unit = place.unit
        self._client = (
            client.ModbusSerialClient(place.device, baudrate=BAUD, **common)
            if place.device
            else client.ModbusTcpClient(place.host, port=place.port, **common)
        )
        assert self._client.connect()

    @staticmethod
    def _answer(answer: Any) -> Any:
        if answer.isError():
            raise Refused(answer.exception_code)
        return answer

    def read(self, table: str, address: int, count: int) -> list[int]:
        ask = self._client.read_input_registers if table == "input" else self._client.read_holding_registers
        return list(self._answer(ask(address, count=count, device_id=self._unit)).registers)

    def write(self, address: int, values: list[int]) -> None:
        self._answer(self._client.write_registers(address, values, device_id=self._unit))

    def server_id(self) -> bytes:
        """Function 17, as far as it keeps the answer's bytes."""
        answer = self._answer(self._client.report_device_id(device_id=self._unit))
        return bytes(answer.identifier)

    def device_id(self) -> dict[int, bytes]:
        """Function 43, kind 14."""
        answer = self._client.read_device_information(read_code=1, object_id=0, device_id=self._unit)
        return dict(self._answer(answer).information)

    def close(self) -> None:
        self._client.close()


CLIENTS: dict[str, type[Any]] = {"libmodbus": Libmodbus, "mbpoll": Mbpoll, "pymodbus": Pymodbus}
