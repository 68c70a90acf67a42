"""Programs, headers and Python packages."""

from __future__ import annotations

import re
import shutil
import sys
from collections.abc import Iterator
from importlib import metadata
from pathlib import Path

from brace.doctor.finding import MISSING, NOTE, OK, OLD, Finding, Machine, first_line

#: purpose, program, Debian package, how it prints its version
_PROGRAMS = (
    ("build", "gcc", "gcc", "--version"),
    ("build", "g++", "g++", "--version"),
    ("build", "cmake", "cmake", "--version"),
    ("build", "ninja", "ninja-build", "--version"),
    ("images", "arm-none-eabi-gcc", "gcc-arm-none-eabi", "--version"),
    ("images", "qemu-system-arm", "qemu-system-arm", "--version"),
)
#: one of them is enough
_PROGRAMMERS = (("openocd", "openocd", "--version"), ("st-flash", "stlink-tools", "--version"),
                ("dfu-util", "dfu-util", "--version"))  # fmt: skip
#: comfortable, not needed
_WIRE = (
    ("candump", "can-utils", ""),
    ("slcand", "can-utils", ""),
    ("mbpoll", "mbpoll", "-V"),
    ("socat", "socat", "-V"),
)
_REQUIREMENT = re.compile(r"([A-Za-z0-9_.-]+)\s*>=\s*([\d.]+)")
_FOR_OLDER_PYTHON = re.compile(r"python_version *< *[\"']3\.(\d+)")


def _install(package: str) -> str:
    return f"sudo apt-get install {package}"


def _version_of(program: str, option: str) -> str:
    return (first_line([program, option]) if option else "") or "there"


def programs(machine: Machine) -> Iterator[Finding]:
    """Compilers, emulator, programmers, the wire's own tools."""
    for purpose, program, package, option in _PROGRAMS:
        if shutil.which(program):
            yield Finding(purpose, program, OK, _version_of(program, option))
        else:
            yield Finding(purpose, program, MISSING, "not installed", _install(package))
    yield _header("build", "Eigen", Path("/usr/include/eigen3/Eigen/Core"), "libeigen3-dev")
    yield _newlib()
    there = [(name, option) for name, _package, option in _PROGRAMMERS if shutil.which(name)]
    for name, option in there:
        yield Finding("flash", name, OK, _version_of(name, option))
    if not there:
        names = ", ".join(name for name, _package, _option in _PROGRAMMERS)
        yield Finding("flash", "programmer", MISSING, f"none of {names} is installed", _install("openocd"))
    for name, package, option in _WIRE:
        if shutil.which(name):
            yield Finding("wire", name, OK, _version_of(name, option))
        else:
            yield Finding("wire", name, NOTE, "not installed", _install(package))


def _header(purpose: str, name: str, path: Path, package: str) -> Finding:
    if path.is_file():
        return Finding(purpose, name, OK, str(path.parent))
    return Finding(purpose, name, MISSING, f"no {path}", _install(package))


def _newlib() -> Finding:
    package = "libnewlib-arm-none-eabi"
    if not shutil.which("arm-none-eabi-gcc"):
        return Finding("images", "newlib", MISSING, "no compiler to ask", _install(package))
    found = first_line(["arm-none-eabi-gcc", "-print-file-name=nano.specs"])
    if Path(found).is_absolute() and Path(found).is_file():
        return Finding("images", "newlib", OK, found)
    return Finding("images", "newlib", MISSING, "the compiler finds no nano.specs", _install(package))


def python_packages(machine: Machine) -> Iterator[Finding]:
    """Python itself, and what pyproject.toml asks for."""
    version = ".".join(map(str, sys.version_info[:3]))
    good = sys.version_info >= (3, 10)
    yield Finding("tools", "Python", OK if good else OLD, version, "" if good else "Python 3.10 or newer")
    for requirement in metadata.requires("brace") or []:
        asked = _REQUIREMENT.match(requirement)
        older = _FOR_OLDER_PYTHON.search(requirement)
        if asked is None or "extra ==" in requirement or (older and sys.version_info >= (3, int(older[1]))):
            continue
        name, least = asked.groups()
        try:
            found = metadata.version(name)
        except metadata.PackageNotFoundError:
            yield Finding("tools", name, MISSING, "not installed", "./dev setup")
            continue
        newer = _numbers(found) >= _numbers(least)
        yield Finding(
            "tools", name, OK if newer else OLD, found, "" if newer else f"{least} or newer: ./dev setup"
        )


def _numbers(version: str) -> tuple[int, ...]:
    return tuple(int(part) for part in re.findall(r"\d+", version)[:3])
