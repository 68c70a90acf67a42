"""Finding and loading libbrace_host.so and the headers that describe it."""

from __future__ import annotations

import os
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from brace.ground.errors import MissingLibraryError
from brace.native.c_data import CData
from brace.native.c_types import c_types

_PACKAGE = Path(__file__).resolve().parents[1]  # tools/brace
_PROJECT = _PACKAGE.parents[1]
_INSTALLED = _PACKAGE / "_native"
LIBRARY_NAME = "libbrace_host.so"

FIRMWARE_HEADERS = (
    "kinematics.h",
    "chain.h",
    "planar.h",
    "planar_fixed.h",
    "planar_batch.h",
    "chain_batch.h",
    "spatial.h",
    "gap_stiffness.h",
    "loaded.h",
    "loaded_fixed.h",
    "backlash.h",
    "play.h",
    "loaded_batch.h",
    "loaded_space.h",
    "kinematics_batch.h",
    "uncertainty.h",
    "uncertainty_causes.h",
    "slope.h",
    "contact.h",
    "load_band.h",
    "parameters.h",
    "play_parameters.h",
    "status_text.h",
    "stance.h",
)
HOST_HEADER = "brace_host.h"
NODE_HEADERS = ("brace_node.h", "brace_robot.h", "brace/status_text.h")  # controllers and limbs in one process
SERVOS_HEADER = "brace_servos.h"
_HEADER_FOLDERS = (
    "firmware/core/include",
    "firmware/interface/include",
    "firmware/interface/generated",
    "firmware/store/include",
    "firmware/app/include",
    "hal/include",
    "host_sim/api",
    "tools/stance/include",
)


@dataclass(frozen=True)
class Library:
    """`ffi` makes and reads C data, `lib` has the functions."""

    ffi: CData
    lib: CData
    path: Path


@cache
def library() -> Library:
    """The library, loaded once. Looked for at $BRACE_LIBRARY, beside the package, in the project's build."""
    return _load(*_headers())


@cache
def node_library() -> Library:
    """The same library by brace_node.h: the firmware's application over simulated limbs. Its C types are its own."""
    return _load(*_node_headers())


@cache
def servos_library() -> Library:
    """The same library by brace_servos.h: simulated servos on a serial line."""
    _, folders = _headers()
    return _load([root for folder in folders if (root := folder / SERVOS_HEADER).is_file()], folders)


def _load(headers: list[Path], folders: list[Path]) -> Library:
    path = _find_library()
    _refuse_stale(path, headers, folders)
    ffi = c_types(headers, folders)
    try:
        loaded = ffi.dlopen(str(path))
    except OSError as error:
        raise MissingLibraryError(
            "the library cannot be loaded",
            where=str(path),
            why=str(error),
            next_step="./dev setup builds it anew",
        ) from None
    lacking = [name for name in dir(loaded) if not hasattr(loaded, name)]
    if lacking:
        raise MissingLibraryError(
            f"the library lacks {lacking[0]}" + (f" and {len(lacking) - 1} more" if lacking[1:] else ""),
            where=str(path),
            why="it is older than the headers that describe it",
            next_step="./dev setup builds it anew",
        )
    return Library(ffi, loaded, path)


def _find_library() -> Path:
    named = os.environ.get("BRACE_LIBRARY")
    if named:
        if Path(named).is_file():
            return Path(named)
        raise MissingLibraryError(
            "no library there",
            where=f"BRACE_LIBRARY={named}",
            why="the variable names a file that does not exist",
            next_step="unset BRACE_LIBRARY, or point it at " + LIBRARY_NAME,
        )
    for folder in (_INSTALLED, _PROJECT / "build" / "host", _PROJECT / "build" / "host" / "host_sim"):
        if (folder / LIBRARY_NAME).is_file():
            return folder / LIBRARY_NAME
    raise MissingLibraryError(
        f"{LIBRARY_NAME} is not built",
        where=str(_PROJECT / "build" / "host"),
        why="brace computes with the firmware's own C, compiled for this machine",
        next_step="./dev setup, or set BRACE_LIBRARY to the file",
    )


def _headers() -> tuple[list[Path], list[Path]]:
    """The headers that describe the library, and the folders they include from."""
    if (_INSTALLED / "include").is_dir():
        folders = [_INSTALLED / "include"]
    else:
        folders = [_PROJECT / folder for folder in _HEADER_FOLDERS]
    roots = [folder / "brace" / name for name in FIRMWARE_HEADERS for folder in folders]
    roots += [folder / HOST_HEADER for folder in folders]
    return [root for root in roots if root.is_file()], folders


def _node_headers() -> tuple[list[Path], list[Path]]:
    """The same for the controller in this process; a world of its own, which other commands need not read."""
    _, folders = _headers()
    return [root for name in NODE_HEADERS for folder in folders if (root := folder / name).is_file()], folders


def _refuse_stale(library_path: Path, headers: list[Path], folders: list[Path]) -> None:
    """A library built from other headers would read and write structs of another shape."""
    built = library_path.stat().st_mtime
    newer = [header for header in headers if header.stat().st_mtime > built]
    if newer and _INSTALLED not in folders[0].parents:
        raise MissingLibraryError(
            f"the library is older than {newer[0].name}",
            where=str(library_path),
            why="its structs may have another shape than the header says",
            next_step="./dev setup builds it anew",
        )
