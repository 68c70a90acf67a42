"""The small preprocessor that turns our headers into declarations, and the structs that come of it."""

from __future__ import annotations

from pathlib import Path

from cffi import FFI

from brace.native import library
from brace.native.cdef import declarations


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
    assert len(set(positions.tolist())) == len(keys)
