"""What has been built, and whether it is as new as what it is made from."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from brace.doctor.finding import MISSING, OK, OLD, Finding, Machine
from brace.flash.boards import BOARDS
from brace.flash.checks import SUMS_NAME, check_listed
from brace.flash.image import read_image
from brace.ground.errors import BraceError

_FIRMWARE = ("firmware", "hal")
_LIBRARY_SOURCES = ("firmware/core", "host_sim")
_SOURCES = (".c", ".h", ".cpp", ".hpp", ".ld", ".cmake", ".txt", ".in")
_BUILD = "./dev setup"


def builds(machine: Machine) -> Iterator[Finding]:
    """Host library and images; of an installed package the library alone."""
    if machine.is_installed:
        yield _installed(machine.native)
        return
    yield _library(machine)
    newest = _newest(machine.project, _FIRMWARE)
    for board in BOARDS:
        yield _image(machine, board, newest)


def _installed(native: Path) -> Finding:
    from brace.native.loader import LIBRARY_NAME

    if (native / LIBRARY_NAME).is_file():
        return Finding("tools", LIBRARY_NAME, OK, "installed with the command")
    return Finding("tools", LIBRARY_NAME, MISSING, f"not in {native}", "install the brace package anew")


def _library(machine: Machine) -> Finding:
    from brace.native.loader import LIBRARY_NAME

    folders = (machine.project / "build" / "host", machine.project / "build" / "host" / "host_sim")
    path = next((folder / LIBRARY_NAME for folder in folders if (folder / LIBRARY_NAME).is_file()), None)
    if path is None:
        return Finding("tools", LIBRARY_NAME, MISSING, "not built", _BUILD)
    return _aged("tools", LIBRARY_NAME, path, _newest(machine.project, _LIBRARY_SOURCES), "built")


def _image(machine: Machine, board: str, newest: tuple[float, str]) -> Finding:
    name = f"brace-{board}"
    path = machine.project / "build" / "m4f" / "images" / f"{name}.elf"
    if not path.is_file():
        return Finding("images", name, MISSING, "not built", _BUILD)
    try:
        image = read_image(path)
        check_listed(image, unlisted=False)
    except BraceError as error:
        return Finding("images", name, MISSING, f"{SUMS_NAME}: {error.what}", _BUILD)
    described = f"{image.info.version} ({image.info.hash})" if image.info else "says nothing of itself"
    return _aged("images", name, path, newest, described)


def _aged(purpose: str, name: str, path: Path, newest: tuple[float, str], described: str) -> Finding:
    changed_s, source = newest
    if changed_s > path.stat().st_mtime:
        return Finding(purpose, name, OLD, f"{described}; {source} is newer", _BUILD)
    return Finding(purpose, name, OK, described)


def _newest(project: Path, folders: tuple[str, ...]) -> tuple[float, str]:
    """When the newest source was changed [s], and which it is."""
    sources = [
        path
        for folder in folders
        for path in (project / folder).rglob("*")
        if path.suffix in _SOURCES and path.is_file()
    ]
    return max(
        ((path.stat().st_mtime, str(path.relative_to(project))) for path in sources), default=(0.0, "")
    )
