"""Requests through pymodbus, each with its own answer. Modbus RTU does not number requests, and pymodbus takes the
first whole answer that comes: a late one would pass for the next one's, and so on."""

from __future__ import annotations

import contextlib
import os
import time
from collections.abc import Callable
from itertools import cycle
from typing import TYPE_CHECKING

from brace.bus.url import BusUrl
from brace.ground.errors import MissingLibraryError, NoDeviceError

if TYPE_CHECKING:
    from pymodbus.client.base import ModbusBaseSyncClient
    from pymodbus.pdu import ModbusPDU

_ANSWER_S = 0.6
_TRIES = 3
_MARK_TRIES = 8
_OTHERS_CAME = "only late answers to other requests came"
_QUIET_S = 0.05  # a slow unit sends the answers that it still owes
_MARK_REGISTERS = range(1, 32, 2)  # a value has two registers: no other read has an odd number


class ModbusLine:
    """Requests to one unit."""

    def __init__(self, client: ModbusBaseSyncClient, url: BusUrl) -> None:
        """client: of pymodbus, connected."""
        self._client = client
        self._url = url
        self._unit = url.unit
        self._is_numbered = url.kind == "modbus-tcp"  # over TCP requests have numbers; pymodbus looks at them
        self._is_out_of_step = False
        self._marks = cycle(_MARK_REGISTERS)

    def read(self, table: str, address: int, count: int) -> ModbusPDU:
        """Of a table, input or holding."""
        function = self._client.read_input_registers if table == "input" else self._client.read_holding_registers
        return self._tried(
            lambda: function(address, count=count, device_id=self._unit),
            lambda answer: len(answer.registers) == count,
        )

    def write(self, address: int, words: list[int]) -> ModbusPDU:
        """Holding registers."""
        return self._tried(
            lambda: self._client.write_registers(address, words, device_id=self._unit),
            lambda answer: answer.address == address,
        )

    def close(self) -> None:
        """The connection."""
        self._client.close()  # type: ignore[no-untyped-call]  # pymodbus gives it no types

    def _tried(self, request: Callable[[], ModbusPDU], is_answer: Callable[[ModbusPDU], bool]) -> ModbusPDU:
        """The answer, which may be an exception of Modbus. Raises NoDeviceError when none has come."""
        for _ in range(_TRIES - 1):
            with contextlib.suppress(Exception):  # pymodbus' own, and the system's
                return self._once(request, is_answer)
        try:
            return self._once(request, is_answer)
        except Exception as error:
            raise _no_answer(self._url, error) from None

    def _once(self, request: Callable[[], ModbusPDU], is_answer: Callable[[ModbusPDU], bool]) -> ModbusPDU:
        try:
            self._fall_into_step()
            answer = request()
            if not answer.isError() and not is_answer(answer):
                raise TimeoutError(_OTHERS_CAME)
        except Exception:
            self._is_out_of_step = not self._is_numbered
            raise
        return answer

    def _fall_into_step(self) -> None:
        """After an answer that did not come, drops the late answers: asks for a number of registers that no other
        request has, until an answer has this number."""
        for _ in range(_MARK_TRIES if self._is_out_of_step else 0):
            count = next(self._marks)
            answer = self._client.read_input_registers(0, count=count, device_id=self._unit)
            if not answer.isError() and len(answer.registers) == count:
                self._is_out_of_step = False
                return
            time.sleep(_QUIET_S)  # pymodbus drops what has come when it sends
        if self._is_out_of_step:
            raise TimeoutError(_OTHERS_CAME)


def connected(url: BusUrl) -> ModbusLine:
    """A line that is there; raises NoDeviceError where it is not, MissingLibraryError without pymodbus."""
    try:
        from pymodbus.client import ModbusSerialClient, ModbusTcpClient
    except ImportError as error:
        raise MissingLibraryError(
            "pymodbus is not installed",
            why=str(error),
            next_step="pip install pymodbus pyserial, or ./dev setup",
        ) from None
    import logging

    logging.getLogger("pymodbus").setLevel(logging.CRITICAL)  # the errors raised here say the same, more plainly
    if url.kind == "modbus-tcp":
        from brace.bus.lines import TcpLine

        TcpLine(url).close()  # raises an error that says why the port cannot be opened
        client: ModbusBaseSyncClient = ModbusTcpClient(url.place, port=url.port, timeout=_ANSWER_S, retries=0)
    else:
        from brace.bus.lines import SerialLine

        SerialLine(url).close()
        client = ModbusSerialClient(
            url.place, baudrate=url.baud, parity=_parity_of(url.place), timeout=_ANSWER_S, retries=0
        )
    if not client.connect():
        raise NoDeviceError(
            "no connection", where=url.text, why="it was there a moment ago", next_step="try again"
        )
    return ModbusLine(client, url)


def _parity_of(place: str) -> str:
    """Even, as Modbus RTU and so the controller has it; a pseudo-terminal has none and refuses any."""
    return "N" if os.path.realpath(place).startswith("/dev/pts/") else "E"


def _no_answer(url: BusUrl, error: Exception) -> NoDeviceError:
    if url.kind == "modbus-tcp":
        cause = "another unit, or no Modbus at that port"
        way = "modbus-tcp://HOST:PORT/UNIT; brace sim prints its own; an SLCAN port is tcp://HOST:PORT"
    else:
        cause = "another unit, another baud rate, or nobody"
        way = (
            "modbus:DEVICE@BAUD/UNIT: controller.modbus_baud and controller.modbus_address of the controller"
        )
    return NoDeviceError(
        f"unit {url.unit} does not answer",
        where=url.text,
        why=f"no answer within {_ANSWER_S * _TRIES:.1f} s: {cause} ({type(error).__name__})",
        next_step=way,
    )
