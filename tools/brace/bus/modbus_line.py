"""A pymodbus client whose answers are to its last request. Modbus RTU does not number requests, and pymodbus takes the
first whole answer that comes: a late one would pass for the next one's, and so on."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable
from itertools import cycle
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pymodbus.client.base import ModbusBaseSyncClient
    from pymodbus.pdu import ModbusPDU

ANSWER_S = 0.6
TRIES = 3
_MARK_TRIES = 8
_OTHERS_CAME = "only late answers to other requests came"
_QUIET_S = 0.05  # in which answers come that a slow unit still owes
_MARK_REGISTERS = range(1, 32, 2)  # a value has two registers, so that no other read has so many


class ModbusLine:
    """Requests to one unit."""

    def __init__(self, client: ModbusBaseSyncClient, unit: int, is_numbered: bool) -> None:
        """is_numbered: requests have numbers, as over TCP, and pymodbus looks at them."""
        self._client = client
        self._unit = unit
        self._is_numbered = is_numbered
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
        """The answer. Raises what the last try raises when none has come."""
        for _ in range(TRIES - 1):
            with contextlib.suppress(Exception):  # pymodbus' own, and the system's
                return self._once(request, is_answer)
        return self._once(request, is_answer)

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
        """After an answer that did not come: asks for so many registers as no other request does until that comes."""
        for _ in range(_MARK_TRIES if self._is_out_of_step else 0):
            count = next(self._marks)
            answer = self._client.read_input_registers(0, count=count, device_id=self._unit)
            if not answer.isError() and len(answer.registers) == count:
                self._is_out_of_step = False
                return
            time.sleep(_QUIET_S)  # pymodbus drops what has come when it sends
        if self._is_out_of_step:
            raise TimeoutError(_OTHERS_CAME)
