"""The small preprocessor that turns our headers into declarations, and the structs that come of it."""

from __future__ import annotations

import importlib
import sys
from pathlib import Path
from typing import Any

import pytest
from cffi import FFI

from brace.native import library, node_library
from brace.native.c_types import c_types
from brace.native.cdef import declarations
from brace.native.loader import _headers, _node_headers

BACKEND: Any = importlib.import_module("_cffi_backend")


def test_headers_become_declarations(tmp_path: Path) -> None:
    (tmp_path / "inner.h").write_text(
        "#ifndef I_H\n#define I_H\n#define COUNT 3u /* how many */\n#define TWICE (2 * COUNT)\n"
        "#define HALF 0.5f\n#define MAX(a, b) ((a) > (b) ? (a) : (b))\nenum { BIT = 1u << 2 };\n#endif\n"
    )
    (tmp_path / "outer.h").write_text(
        '#include <stdint.h>\n#include "inner.h"\n#include "inner.h"\n#ifdef __cplusplus\n'
        'extern "C" {\n#endif\n// a comment { with a brace\n'
        "typedef struct { float a[COUNT]; int32_t b[TWICE]; } thing_t;\n"
        "static inline int twice(int x)\n{\n    if (x) { return 2 * x; }\n    return 0;\n}\n"
        '_Static_assert(sizeof(thing_t) == 36, "size");\n'
        "int use(const thing_t *thing);\n#ifdef __cplusplus\n}\n#endif\n"
    )
    text = declarations([tmp_path / "outer.h"], [tmp_path])
    ffi = FFI()
    ffi.cdef(text)
    assert ffi.sizeof("thing_t") == 36
    assert "twice" not in text and "use" in text


def test_every_declared_function_is_in_the_library() -> None:
    native = library()
    names = [name for name in dir(native.lib) if name.startswith("brace_")]
    assert len(names) > 30
    for name in names:
        assert getattr(native.lib, name) is not None


def test_every_plant_key_has_its_place() -> None:
    """Each key of limb.toml that the plant knows is written where the plant reads it, and no two at one place."""
    from brace.model import LIMB_KEYS
    from brace.model.keys import CONTROLLER_KEYS
    from brace.native.limb import plant_layout

    positions, keys = plant_layout(library())
    elsewhere = ("uncertainty.", "format", "name")
    expected = [key.name for key in LIMB_KEYS if not key.name.startswith(elsewhere) and key.name not in CONTROLLER_KEYS]
    assert keys == expected
    assert len(set(positions)) == len(keys)


@pytest.fixture
def keeping(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Where Python keeps what it compiles: nothing is there yet."""
    library(), node_library()  # which keep theirs elsewhere
    kept = tmp_path / "kept"
    monkeypatch.setattr(sys, "pycache_prefix", str(kept))
    monkeypatch.setattr(sys, "dont_write_bytecode", False)
    return kept


def layout(ffi: Any, kind: Any, depth: int = 0) -> Any:
    """Everything of a type but its name: two ways to read a header call a struct by its tag or by its typedef."""
    if kind.kind == "struct":
        try:
            ffi.sizeof(kind)  # first: cffi aborts when asked for the members of a struct whose name alone it knows
        except (ValueError, BACKEND.FFI.error):
            return "struct"
        members = [(name, field.offset, layout(ffi, field.type, depth)) for name, field in kind.fields]
        return ffi.sizeof(kind), members
    if kind.kind in ("pointer", "array"):
        return kind.kind, getattr(kind, "length", None), layout(ffi, kind.item, depth + 1) if depth < 3 else None
    if kind.kind == "function":
        return [layout(ffi, argument, depth) for argument in kind.args], layout(ffi, kind.result, depth)
    return kind.kind if kind.kind in ("struct", "enum", "void") else (kind.kind, kind.cname)


def test_what_was_read_of_the_headers_is_kept_and_is_the_same(keeping: Path) -> None:
    """Every type, its members and their places; every function and its arguments; every constant."""
    for native, (roots, folders) in ((library(), _headers()), (node_library(), _node_headers())):
        read, kept = c_types(roots, folders), c_types(roots, folders)
        assert isinstance(read, FFI) and not isinstance(kept, FFI)
        names = [name for name in kept.list_types()[0] if name.startswith("brace_")]
        assert len(names) > 30
        for name in names:
            assert layout(read, read.typeof(name)) == layout(kept, kept.typeof(name)), name
        one, other = read.dlopen(str(native.path)), kept.dlopen(str(native.path))
        assert dir(one) == dir(other)
        for name in dir(one):
            a, b = getattr(one, name), getattr(other, name)
            assert a == b if isinstance(a, int) else layout(read, read.typeof(a)) == layout(kept, kept.typeof(b)), name


def test_another_header_is_read_anew(keeping: Path, tmp_path: Path) -> None:
    header = tmp_path / "headers" / "thing.h"
    header.parent.mkdir()
    header.write_text('#include "part.h"\ntypedef struct { part_t a[2]; } thing_t;\n')
    for kind, size in (("char", 2), ("double", 16), ("char", 2)):
        (header.parent / "part.h").write_text(f"typedef {kind} part_t;\n")
        for _ in range(2):
            assert c_types([header], [header.parent]).sizeof("thing_t") == size


def test_a_damaged_file_is_made_anew(keeping: Path) -> None:
    roots, folders = _headers()
    c_types(roots, folders)
    (kept,) = [path for path in keeping.rglob("*") if path.is_file()]
    whole = kept.read_bytes()
    for length in (len(whole) // 2, 40, 0):
        kept.write_bytes(whole[:length])
        assert isinstance(c_types(roots, folders), FFI)
        assert kept.read_bytes() == whole


def test_nothing_is_kept_where_python_keeps_nothing(keeping: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    roots, folders = _headers()
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    assert isinstance(c_types(roots, folders), FFI) and not keeping.exists()
    monkeypatch.setattr(sys, "dont_write_bytecode", False)
    keeping.write_text("no folder")  # so that nobody may write there
    assert isinstance(c_types(roots, folders), FFI)
