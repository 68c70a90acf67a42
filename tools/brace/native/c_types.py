"""The C types and functions that headers declare, as cffi has them. Reading the headers takes longer than most
commands, so the result is kept beside Python's compiled files. Headers are read again when one of them has changed."""

from __future__ import annotations

import contextlib
import hashlib
import importlib
import importlib.util
import marshal
import os
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from types import CodeType

from brace.native import cdef
from brace.native.c_data import CData

_DIGEST_BYTES = hashlib.sha256().digest_size


def c_types(roots: Sequence[Path], folders: Sequence[Path]) -> CData:
    """An FFI of the headers `roots` and of all that they include from `folders`."""
    backend = importlib.import_module("_cffi_backend")  # here, so that a command that computes nothing starts at once
    kept = Path(importlib.util.cache_from_source(__file__)).with_name(f"{roots[0].stem}.{sys.implementation.cache_tag}")
    digest = _digest(roots, folders, backend.__version__)
    if code := _read(kept, digest):
        names: dict[str, CData] = {}
        exec(code, names)
        return names["ffi"]
    from cffi import FFI  # which reads C in Python: that is what takes long

    ffi = FFI()
    ffi.cdef(cdef.declarations(roots, folders))
    if not sys.dont_write_bytecode:
        with contextlib.suppress(OSError):  # a folder that nobody may write keeps nothing
            _keep(kept, digest + marshal.dumps(_program(ffi)))
    return ffi


def _digest(roots: Sequence[Path], folders: Sequence[Path], version: str) -> bytes:
    """Of everything that decides what comes of the headers: their names and texts, and the programs that read them."""
    found = hashlib.sha256(importlib.util.MAGIC_NUMBER + version.encode())
    headers = (path for folder in folders for path in sorted(folder.rglob("*.h")))
    for path in (Path(__file__), Path(cdef.__file__), *headers):
        content = path.read_bytes()
        found.update(f"\n{path.name} {len(content)}\n".encode() + content)
    found.update(" ".join(root.name for root in roots).encode())
    return found.digest()


def _read(kept: Path, digest: bytes) -> CodeType | None:
    """What was kept of the same headers; None where nothing was, or the file is damaged."""
    try:
        content = kept.read_bytes()
        code = marshal.loads(content[_DIGEST_BYTES:]) if content.startswith(digest) else None
    except (OSError, EOFError, ValueError, TypeError):
        return None
    return code if isinstance(code, CodeType) else None


def _program(ffi: CData) -> CodeType:
    """What makes the same FFI again."""
    ffi.set_source("brace_c_types", None, compiler_verbose=0)
    with tempfile.TemporaryDirectory(prefix="brace-") as folder:
        program = Path(folder) / "c_types.py"
        ffi.emit_python_code(str(program))
        return compile(program.read_text(), "<C types>", "exec")


def _keep(kept: Path, content: bytes) -> None:
    """Whole or not at all: others may read it meanwhile."""
    kept.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(prefix=f".{kept.name}.", dir=kept.parent)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
        os.replace(name, kept)
    except OSError:
        os.unlink(name)
        raise
