"""Probes, serial ports, CAN interfaces, and the kernel's modules for them."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

from brace.doctor.finding import MISSING, NOTE, OK, Finding, Machine
from brace.flash.usb import probes

_CAN_LINK_TYPE = "280"  # ARPHRD_CAN
_MODULES = ("can", "can_raw", "vcan", "slcan")


def hardware(machine: Machine) -> Iterator[Finding]:
    """What is plugged in, and may be used."""
    found = probes(machine.sys / "bus" / "usb" / "devices")
    for probe in found:
        yield Finding("flash", "probe", OK, f"{probe.name} ({probe.kind}) {probe.serial}".rstrip())
    if not found:
        yield Finding(
            "flash", "probe", NOTE, "no debug probe and no boot loader on USB", "plug one in to flash a board"
        )
    yield from _serial_ports(machine)
    yield from _can_interfaces(machine)
    yield from _modules(machine)


def _serial_ports(machine: Machine) -> Iterator[Finding]:
    ports = sorted(path for kind in ("ttyACM*", "ttyUSB*") for path in machine.dev.glob(kind))
    for port in ports:
        if os.access(port, os.R_OK | os.W_OK):
            yield Finding("wire", "serial port", OK, str(port))
        else:
            yield Finding("wire", "serial port", MISSING, f"{port}: not yours to use",
                          'sudo usermod -aG dialout "$USER", then log in again')  # fmt: skip
    if not ports:
        yield Finding("wire", "serial port", NOTE, "none on USB (/dev/ttyACM*, /dev/ttyUSB*)")


def _can_interfaces(machine: Machine) -> Iterator[Finding]:
    found = [
        path
        for path in sorted((machine.sys / "class" / "net").glob("*"))
        if _text(path / "type") == _CAN_LINK_TYPE
    ]
    for path in found:
        state = _text(path / "operstate")
        up = state in ("up", "unknown")  # vcan says unknown
        yield Finding("wire", "CAN interface", OK if up else NOTE, f"{path.name}: {state or 'unknown'}",
                      "" if up else f"sudo ip link set {path.name} up type can bitrate 1000000")  # fmt: skip
    if not found:
        yield Finding("wire", "CAN interface", NOTE, "none", "SLCAN over a serial port or tcp needs none")


def _modules(machine: Machine) -> Iterator[Finding]:
    shipped = _text(machine.modules / "modules.dep") + "\n" + _text(machine.modules / "modules.builtin")
    for name in _MODULES:
        if (machine.sys / "module" / name).exists():
            yield Finding("wire", f"kernel module {name}", OK, "loaded")
        elif any(f"/{spelt}.ko" in shipped for spelt in (name, name.replace("_", "-"))):
            yield Finding("wire", f"kernel module {name}", NOTE, "there, not loaded", f"sudo modprobe {name}")
        else:
            yield Finding("wire", f"kernel module {name}", NOTE, "this kernel does not have it",
                          "SocketCAN needs it; SLCAN and Modbus do not")  # fmt: skip


def _text(path: Path) -> str:
    try:
        return path.read_text(errors="replace").strip()
    except OSError:
        return ""
