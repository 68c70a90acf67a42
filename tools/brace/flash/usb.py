"""Debug probes and boot loaders on USB, as the kernel lists them: an answer at once, also of none."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

USB_DEVICES = Path("/sys/bus/usb/devices")
DFU = "dfu"
_ST, _SEGGER = "0483", "1366"
_STLINK = {"3744", "3748", "374a", "374b", "374d", "374e", "374f", "3752", "3753", "3754", "3755", "3757"}
_DFU_PRODUCT = "df11"


@dataclass(frozen=True)
class Probe:
    """`kind`: OpenOCD's name of the interface (stlink, jlink, cmsis-dap), or dfu: the chip's own boot loader."""

    kind: str
    name: str
    serial: str


def probes(devices: Path | None = None) -> list[Probe]:
    """What is plugged in."""
    found = []
    for device in sorted((devices or USB_DEVICES).glob("*")):
        vendor, product, name = (_text(device / key) for key in ("idVendor", "idProduct", "product"))
        if vendor == _ST and product in _STLINK:
            kind = "stlink"
        elif vendor == _ST and product == _DFU_PRODUCT:
            kind = DFU
        elif vendor == _SEGGER:
            kind = "jlink"
        elif "CMSIS-DAP" in name:
            kind = "cmsis-dap"
        else:
            continue
        found.append(Probe(kind, name or f"{vendor}:{product}", _text(device / "serial")))
    return found


def _text(path: Path) -> str:
    try:
        return path.read_text(errors="replace").strip()
    except OSError:
        return ""
