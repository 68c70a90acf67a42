"""Bus URLs as the command line takes them."""

from __future__ import annotations

import re
from dataclasses import dataclass

from brace.ground.errors import UsageError

FORMS = (
    "can0 (SocketCAN), slcan:/dev/ttyACM0[@BAUD], tcp://HOST:PORT (SLCAN over TCP), "
    "modbus:/dev/ttyUSB0[@BAUD][/UNIT], modbus-tcp://HOST:PORT[/UNIT], log:FILE"
)
_INTERFACE = re.compile(r"[A-Za-z][A-Za-z0-9_.-]{0,14}")
_SLCAN = re.compile(r"slcan:(?P<place>[^@]+)(?:@(?P<baud>\d+))?")
_TCP = re.compile(r"tcp://(?P<place>[^/]+?):(?P<port>\d+)/?")
_MODBUS = re.compile(r"modbus:(?P<place>/.+?)(?:@(?P<baud>\d+))?(?:/(?P<unit>\d+))?")
_MODBUS_TCP = re.compile(r"modbus-tcp://(?P<place>[^/]+?)(?::(?P<port>\d+))?(?:/(?P<unit>\d+))?/?")
_PTY_UNIT = re.compile(r"/dev/pts")  # modbus:/dev/pts/3 is a device, not unit 3


@dataclass(frozen=True)
class BusUrl:
    """kind: can, slcan, tcp, modbus, modbus-tcp, log."""

    text: str
    kind: str
    place: str  # interface, device, host, file
    port: int = 0
    baud: int = 115200
    unit: int = 1

    @property
    def is_modbus(self) -> bool:
        """Registers, not frames."""
        return self.kind.startswith("modbus")


def parse(text: str) -> BusUrl:
    """A bus URL; UsageError with the forms there are."""
    if text.startswith("log:") and len(text) > 4:
        return BusUrl(text, "log", text[4:])
    if found := _SLCAN.fullmatch(text):
        return BusUrl(text, "slcan", found["place"], baud=int(found["baud"] or 115200))
    if found := _TCP.fullmatch(text):
        return BusUrl(text, "tcp", _host(found["place"]), port=_port(text, found["port"]))
    if found := _MODBUS_TCP.fullmatch(text):
        port = _port(text, found["port"] or "502")
        return BusUrl(text, "modbus-tcp", _host(found["place"]), port=port, unit=_unit(text, found["unit"]))
    if found := _MODBUS.fullmatch(text):
        place, baud, unit = found["place"], found["baud"], found["unit"]
        if unit and not baud and _PTY_UNIT.fullmatch(place):
            place, unit = f"{place}/{unit}", None
        return BusUrl(text, "modbus", place, baud=int(baud or 115200), unit=_unit(text, unit))
    if _INTERFACE.fullmatch(text) and ":" not in text:
        return BusUrl(text, "can", text)
    raise UsageError(
        f"{text!r} is no bus URL", where="--bus", why=f"the forms are {FORMS}", next_step=_guess(text)
    )


def _host(text: str) -> str:
    return text.strip("[]")


def _port(url: str, text: str) -> int:
    if 1 <= int(text) <= 65535:
        return int(text)
    raise UsageError(
        f"{url}: port {text}",
        where="--bus",
        why="ports are 1 to 65535",
        next_step="the port brace sim prints",
    )


def _unit(url: str, text: str | None) -> int:
    unit = int(text or 1)
    if 1 <= unit <= 247:
        return unit
    raise UsageError(
        f"{url}: unit {unit}",
        where="--bus",
        why="Modbus units are 1 to 247",
        next_step="leave /UNIT out for 1",
    )


def _guess(text: str) -> str:
    if text.startswith("/dev/"):
        return f"--bus slcan:{text} for an SLCAN adapter, --bus modbus:{text} for Modbus RTU"
    if written := re.fullmatch(r"(?:tcp:/?)?([\w.-]+:\d+)", text):
        return f"--bus tcp://{written.group(1)}"
    if text.endswith((".log", ".mcap")):
        return f"--bus log:{text}"
    return "--bus tcp://127.0.0.1:29536 for brace sim as it starts by itself"
