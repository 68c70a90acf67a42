"""A limb as a C header and source: its parameters and its collapsed constants as const data.

The firmware's own C collapses the limb, so that a program need not. Members stand in the order of the headers that the
library was built from; the source asserts their places, so that another header is refused by the compiler.
"""

from __future__ import annotations

import re
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from brace.ground.errors import BadFileError, UsageError
from brace.model import LimbModel
from brace.native import Library, library
from brace.native.c_data import CData
from brace.native.limb import firmware_limb, status_text
from brace.params import pack
from brace.wire.names import PARAMETERS

SUFFIXES = (".c", ".cc", ".cpp")
_LINKS = ("BRACE_COXA", "BRACE_FEMUR", "BRACE_TIBIA")
_PARAMETERS = ("brace_limb_t", "brace_gravity_t")
_EFFECTS = ("joint.", "creep.ratio", "thermal.joint", "contact.")  # keys of what changes K or the force
# What C and C++ keep for themselves as far as a file's stem may be it, and what the source calls its own variables.
_TAKEN = frozenset(
    "alignas alignof and asm auto bool break case catch char class compl const constexpr continue decltype default "
    "delete do double else enum explicit export extern false final float for friend goto if inline int long main "
    "mutable namespace new noexcept not nullptr operator or override private protected public register requires "
    "restrict return short signed sizeof static struct switch template this throw true try typedef typeid typename "
    "union unsigned using virtual void volatile while xor as_floats bit crc crc32_of made status word".split()
)


@dataclass(frozen=True)
class Constants:
    """A collapsed limb: what the name ends with, its C type, what it is for, and what makes it anew."""

    ending: str
    type: str
    purpose: str
    collapse: str  # statements that write `made`, and `status` where the call may refuse
    data: CData


@dataclass(frozen=True)
class CFiles:
    """Header and source of a limb, and the keys of limb.toml that the core's C has no member for."""

    header_name: str
    header: str
    source: str
    left_out: tuple[str, ...]


def c_files(model: LimbModel, path: Path, fixed: bool = False) -> CFiles:
    """The limb for a source of this name; the header stands beside it. The file's stem names the data. `fixed`: its
    constants are those of a processor without an FPU.
    UsageError: no C name can be made of it. BadFileError: the firmware refuses the limb."""
    name = _name(path)
    native = library()
    limb = firmware_limb(native, model)
    weights = native.ffi.new("brace_gravity_t *")
    members = np.frombuffer(native.ffi.buffer(weights), dtype=np.float32)
    members[:] = [model.number(one.key) for one in PARAMETERS if one.member.startswith("gravity.")]
    if fixed:
        constants = list(_fixed_constants(native, name, model, limb, weights))
    else:
        constants = list(_float_constants(native, name, limb, weights))
    left_out = tuple(
        one.key
        for one in PARAMETERS
        if one.key.startswith(_EFFECTS) and not one.member.startswith("limb.")
        and model.values[one.key] != one.default
    )  # fmt: skip
    return CFiles(
        f"{path.stem}.h",
        _header(name, model, constants, left_out),
        _source(native, name, path.stem, limb, weights, constants),
        left_out,
    )


def _name(path: Path) -> str:
    if path.suffix not in SUFFIXES:
        raise UsageError(
            f"{path.name!r} is no name of a C source",
            why="--c writes a source and, beside it, a header of the same stem",
            next_step=f"--c {path.with_suffix('.c')}",
        )
    name = path.stem
    if re.fullmatch(r"[A-Za-z]\w*", name, re.ASCII) and name not in _TAKEN and not name.startswith("brace"):
        return name
    stem = re.sub(r"\W", "_", name, flags=re.ASCII)
    fit = stem if re.fullmatch(r"[A-Za-z]\w*", stem) and stem not in _TAKEN and not stem.startswith("brace") else ""
    raise UsageError(
        f"{name!r} cannot name data in C",
        where=str(path),
        why="the file's stem names the limb in C: a letter, then letters, digits and _; brace_ is the library's own",
        next_step=f"--c {path.with_name((fit or f'limb_{stem}') + path.suffix)}",
    )


def _float_constants(native: Library, name: str, limb: CData, weights: CData) -> Iterator[Constants]:
    """The collapsed forms that this limb has, for a processor with an FPU."""
    new, lib = native.ffi.new, native.lib
    planar, general = new("brace_planar_t *"), new("brace_general_t *")
    if lib.brace_planar_collapse(limb, planar) == 0:
        yield Constants("planar", "brace_planar_t", "K at no load: brace_planar_stiffness",
                        f"status = brace_planar_collapse(&{name}, &made);", planar)  # fmt: skip
    else:  # its base yields unequally, or it is very slender
        lib.brace_general_collapse(limb, general)
        yield Constants("general", "brace_general_t", "K at no load: brace_general_stiffness",
                        f"brace_general_collapse(&{name}, &made);", general)  # fmt: skip
    loaded = new("brace_loaded_t *")
    lib.brace_loaded_collapse(limb, weights, loaded)
    yield Constants("loaded", "brace_loaded_t", "K under a load: brace_loaded_stiffness",
                    f"brace_loaded_collapse(&{name}, &{name}_weights, &made);", loaded)  # fmt: skip
    spatial = new("brace_spatial_t *")
    if lib.brace_spatial_collapse(limb, spatial) == 0 and _yields_across(native, spatial):
        yield Constants("spatial", "brace_spatial_t", "K in space: brace_spatial_stiffness",
                        f"status = brace_spatial_collapse(&{name}, &made);", spatial)  # fmt: skip
        in_space = new("brace_loaded_space_t *")
        lib.brace_loaded_space_collapse(limb, weights, in_space)
        yield Constants("loaded_space", "brace_loaded_space_t", "K in space under a load: brace_loaded_space_settle",
                        f"brace_loaded_space_collapse(&{name}, &{name}_weights, &made);", in_space)  # fmt: skip


def _fixed_constants(native: Library, name: str, model: LimbModel, limb: CData, weights: CData) -> Iterator[Constants]:
    """The same for a processor without one."""
    new, lib = native.ffi.new, native.lib
    fixed = new("brace_planar_fixed_t *")
    if status := lib.brace_planar_fixed_collapse(limb, fixed):
        raise BadFileError(
            "this limb has no form in fixed point",
            where=model.where("geometry"),
            why=status_text(native, status),
            next_step="the same command without --arith fixed",
        )
    yield Constants("fixed", "brace_planar_fixed_t", "K at no load: brace_planar_fixed_stiffness",
                    f"status = brace_planar_fixed_collapse(&{name}, &made);", fixed)  # fmt: skip
    loaded, loaded_fixed = new("brace_loaded_t *"), new("brace_loaded_fixed_t *")
    lib.brace_loaded_collapse(limb, weights, loaded)
    lib.brace_loaded_fixed_collapse(loaded, loaded_fixed)
    yield Constants("loaded_fixed", "brace_loaded_fixed_t", "K under a load: brace_loaded_fixed_stiffness",
                    f"brace_loaded_t as_floats;\n        brace_loaded_collapse(&{name}, &{name}_weights, &as_floats);\n"
                    "        brace_loaded_fixed_collapse(&as_floats, &made);", loaded_fixed)  # fmt: skip


def _yields_across(native: Library, spatial: CData) -> bool:
    """Whether K in space exists. Two knees, because torsion of the femur has no lever at a straight one."""
    k = native.ffi.new("brace_stiffness_spatial_t *")
    return any(native.lib.brace_spatial_stiffness(spatial, 0.0, 0.5, knee, k) == 0 for knee in (0.0, 1.0))


# --- the texts -----------------------------------------------------------------------------------------------


def _comment(text: str) -> str:
    """Anybody's text inside a C comment."""
    printable = "".join(letter if letter.isprintable() else " " for letter in text)
    return printable.replace("*/", "* /").replace("/*", "/ *").replace("\\", "/").replace("??", "? ?")


_HEADER = """/* The limb {title} as const data, for a program that has Brace's core.
 *
 *     {name}_check()    once, at the start; use the limb only where it returns BRACE_OK
 *     {call}    in every tick
 *
 * Angles are true ones: brace_limb_true_angle adds a joint's zero offset to what is commanded. All data are const and
 * may stay in flash. With -fdata-sections and -Wl,--gc-sections only what is used is linked.
 *{left_out}
 * Written by brace export --c from a limb.toml; do not edit: change the limb.toml and export it again. */
#ifndef {guard}_H
#define {guard}_H

{include}

#ifdef __cplusplus
extern "C" {{
#endif

/* What a controller with these parameters reports as its parameter_crc, and brace params pack prints. */
#define {guard}_PARAMETER_CRC 0x{crc:08x}u

/* Lengths [mm], compliances, zero offsets, trust; members are named as the keys of limb.toml. */
extern const brace_limb_t {name};
/* Weights of its parts [N], and where they pull. */
extern const brace_gravity_t {name}_weights;

/* The limb collapsed for the tick, each to be read by its function alone. */
{constants}

/* Are these the numbers that were exported, and are the constants those that the linked core makes of them?
 * returns BRACE_OK; BRACE_E_CHECKSUM: a number of the limb has changed since it was exported;
 *         BRACE_E_SCHEMA: a constant has changed, or the core is of another version: export the limb again;
 *         or what brace_limb_check says.
 * Cost: as much as collapsing the limb. */
brace_status_t {name}_check(void);

#ifdef __cplusplus
}}
#endif

#endif
"""


def _header(name: str, model: LimbModel, constants: list[Constants], left_out: tuple[str, ...]) -> str:
    plane = constants[0]
    function = "brace_planar_fixed" if plane.ending == "fixed" else f"brace_{plane.ending}"
    unit = "_q28" if plane.ending == "fixed" else ""
    springs = (
        f"\n *         {name}.joint[BRACE_FEMUR].compliance_rad_per_n_mm + {name}.base.rotation_rad_per_n_mm,"
        f"\n *         {name}.joint[BRACE_TIBIA].compliance_rad_per_n_mm,"
    )
    lost = [f" *     {key} = {_comment(str(model.values[key]))}" for key in left_out]
    return _HEADER.format(
        title=repr(_comment(str(model.values["name"]) or name)),
        name=name,
        guard=name.upper(),
        call=f"{function}_stiffness(&{name}_{plane.ending}, theta1_rad{unit}, theta2_rad{unit},"
        f"{springs if plane.ending == 'general' else ''} &k)",
        left_out="\n"
        + "\n".join([" * Given in the limb.toml and left out, because no struct of the core has it:", *lost, " *"])
        if lost
        else "",
        include=_INCLUDE,
        crc=pack(model).identity,
        constants="\n".join(f"extern const {one.type} {name}_{one.ending}; /* {one.purpose} */" for one in constants),
    )


_INCLUDE = """#if defined(__has_include)
#if __has_include("brace_core.h")
#define BRACE_IS_TWO_FILES 1
#endif
#endif
#ifdef BRACE_IS_TWO_FILES
#include "brace_core.h"
#elif defined(__cplusplus)
#include <cfloat> // the headers' own, outside of extern "C"
#include <cmath>
#include <cstddef>
#include <cstdint>
extern "C" {
#include "brace/brace.h"
}
#else
#include "brace/brace.h"
#endif"""

_CRC = """/* CRC-32 (IEEE 802.3, reflected), continued from `crc`, over 32-bit words, the lowest byte of each first. */
static uint32_t crc32_of(uint32_t crc, const void *data, size_t bytes)
{
    crc = ~crc;
    for (size_t at = 0; at < bytes; at += sizeof crc) {
        uint32_t word;
        memcpy(&word, (const char *)data + at, sizeof word);
        crc ^= word;
        for (int bit = 0; bit < 32; bit++) {
            crc = (crc & 1u) != 0u ? (crc >> 1) ^ 0xEDB88320u : crc >> 1;
        }
    }
    return ~crc;
}
"""


_BEGIN = """/* Written by brace export --c; do not edit. {stem}.h is the manual. Compiles as C11 and as C++17. */
/* clang-format off */
#include "{stem}.h"

#include <assert.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* The numbers below stand in the order of the headers' members. */
#define HAS_BYTES(type, bytes) \\
    static_assert(sizeof(type) == (bytes), #type " is another version's: export the limb again")
#define IS_AT(type, member, bytes) \\
    static_assert(offsetof(type, member) == (bytes), #member " has moved: export the limb again")
"""


def _source(native: Library, name: str, stem: str, limb: CData, weights: CData, constants: list[Constants]) -> str:
    data = [("", "brace_limb_t", limb), ("weights", "brace_gravity_t", weights)]
    data += [(one.ending, one.type, one.data) for one in constants]
    checksum = zlib.crc32(bytes(native.ffi.buffer(limb)) + bytes(native.ffi.buffer(weights)))
    parts = [_BEGIN.format(stem=stem)]
    parts += [_places(native, kind) for _, kind, _ in data]
    for ending, kind, value in data:
        parts.append(
            f"\nconst {kind} {name}{'_' if ending else ''}{ending} = {_initializer(native, value[0], '', 0)};\n"
        )
    parts.append("\n" + _CRC + _check(name, checksum, constants))
    return "".join(parts)


def _check(name: str, checksum: int, constants: list[Constants]) -> str:
    lines = [
        "",
        f"brace_status_t {name}_check(void)",
        "{",
        f"    uint32_t crc = crc32_of(0u, &{name}, sizeof {name});",
        f"    crc = crc32_of(crc, &{name}_weights, sizeof {name}_weights);",
        f"    if (crc != 0x{checksum:08x}u) {{",
        "        return BRACE_E_CHECKSUM;",
        "    }",
        f"    brace_status_t status = brace_limb_check(&{name});",
    ]
    for one in constants:
        lines += [
            "    if (status == BRACE_OK) {",
            f"        {one.type} made;",
            f"        {one.collapse}",
            f"        if (status == BRACE_OK && memcmp(&made, &{name}_{one.ending}, sizeof made) != 0) {{",
            "            status = BRACE_E_SCHEMA;",
            "        }",
            "    }",
        ]
    return "\n".join([*lines, "    return status;", "}", ""])


def _places(native: Library, kind: str) -> str:
    """Assertions that a struct of parameters still has these members, in this order, and no others. Constants need no
    more than their size: the check compares them with new ones."""
    members = [] if kind not in _PARAMETERS else list(_members(native, native.ffi.typeof(kind)))
    lines = [f"IS_AT({kind}, {place}, {offset});" for place, offset in members]
    return "\n".join([*lines, f"HAS_BYTES({kind}, {native.ffi.sizeof(kind)});", ""])


def _members(native: Library, kind: CData, place: str = "", offset: int = 0) -> Iterator[tuple[str, int]]:
    """Each number of a C type: the expression after the struct's name, and its offset in bytes."""
    if kind.kind == "struct":
        for field, member in kind.fields:
            yield from _members(native, member.type, f"{place}.{field}" if place else field, offset + member.offset)
    elif kind.kind == "array":
        size = native.ffi.sizeof(kind.item)
        for index in range(kind.length):
            yield from _members(native, kind.item, f"{place}[{index}]", offset + index * size)
    else:
        yield place, offset


def _initializer(native: Library, value: CData, place: str, depth: int) -> str:
    """Braces and numbers, each with its member's name."""
    kind = native.ffi.typeof(value)
    indent = "    " * (depth + 1)
    if kind.kind == "struct":
        parts = [(field, getattr(value, field)) for field, _ in kind.fields]
    else:
        parts = [(f"[{_LINKS[index] if kind.length == 3 else index}]", value[index]) for index in range(kind.length)]
    lines = []
    for label, part in parts:
        where = f"{place}{label}" if label.startswith("[") or not place else f"{place}.{label}"
        if isinstance(part, (int, float)):
            lines.append(f"{indent}{_number(kind, label, part)}, /* {where} */")
        else:
            lines.append(f"{indent}{_initializer(native, part, where, depth + 1)}, /* {where} */")
    return "{\n" + "\n".join(lines) + "\n" + "    " * depth + "}"


def _number(kind: CData, label: str, value: float | int) -> str:
    """A constant that a C compiler reads as this very number."""
    c_type = dict(kind.fields)[label].type.cname if kind.kind == "struct" else kind.item.cname
    if c_type == "float":
        single = np.float32(value)
        if not np.isfinite(single):
            raise ValueError(f"{label} is not finite")
        return (
            repr(float(str(single)))
            if 1e-4 <= abs(single) < 1e6 or not single
            else np.format_float_scientific(single, trim="-")
        ) + "f"
    if c_type == "uint32_t":
        return f"{value}u"
    if c_type == "int64_t":
        return f"INT64_C({value})" if value != -(1 << 63) else "INT64_MIN"
    return str(value) if value != -(1 << 31) else "INT32_MIN"
