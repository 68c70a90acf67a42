"""The parameters' C structs, and their ranges as constants: limb_fields.h, ranges.h, parameter_fields.h."""

from __future__ import annotations

import math
from collections.abc import Sequence

from interface.c_comment import c_comment
from interface.dictionary import ANGLES, LINKS, Dictionary, Entry, Struct

_MADE = "/* Written by tools/interface from dictionary.toml; do not edit. */\n"
_LIMB = "limb"
_CORE = (_LIMB, "gravity")  # structs that the core knows too
_ROOT = "brace_parameters_t"


def limb_fields_header(dictionary: Dictionary) -> str:
    """firmware/core/include/brace/limb_fields.h: the limb's structs, inner ones first, and its weights."""
    limb = _limb(dictionary)
    others = [struct for struct in dictionary.structs if struct.member in _CORE and struct is not limb]
    inner = [struct for struct in dictionary.structs if struct.member.startswith(_LIMB + ".")]
    links = ", ".join(f"BRACE_{link.upper()} = {index}" for index, link in enumerate(LINKS))
    return (
        _guarded("LIMB_FIELDS")
        + "/* The three links and, by the same index, the joint at the near end of each. */\n"
        + f"enum {{ {links}, BRACE_LINK_COUNT = {len(LINKS)} }};\n\n"
        + "".join(_struct(struct, []) for struct in inner)
        + _struct(limb, inner)
        + "".join(_struct(struct, []) for struct in others)
        + "#endif\n"
    )


def parameter_fields_header(dictionary: Dictionary) -> str:
    """generated/brace/parameter_fields.h: what else a controller is sent, and all of it together."""
    outer = [struct for struct in dictionary.structs if "." not in struct.member]
    whole = Struct("", _ROOT, "Everything a controller is sent once and keeps.", ())
    return (
        _guarded("PARAMETER_FIELDS")
        + '#include <stdint.h>\n\n#include "brace/limb_fields.h"\n\n'
        + "".join(_struct(struct, []) for struct in outer if struct.member not in _CORE)
        + _struct(whole, outer)
        + "#endif\n"
    )


def ranges_header(dictionary: Dictionary) -> str:
    """firmware/core/include/brace/ranges.h: what each parameter may be."""
    lines = [
        _guarded("RANGES"),
        c_comment("Least and greatest value of each parameter, both allowed. Of a range that leaves out zero itself, the"
                  " least value is the smallest float above it. Units are in the names."),
        "#include <float.h>\n#include <math.h>\n",
    ]
    for struct in dictionary.structs:
        lines.append(f"\n/* {struct.type} */\n")
        for entry in struct.fields:
            if entry.texts or not entry.numbers:
                name = f"BRACE_RANGE_{_stem(struct)}_{entry.field.upper()}"
                low, high = c_range(entry)
                lines.append(f"#define {name}_MIN {low}\n#define {name}_MAX {high}\n")
    lines.append(_limb_ranges(dictionary))
    return "".join(lines) + "\n#endif\n"


def c_range(entry: Entry) -> tuple[str, str]:
    """Bounds as C constants. Rounding is monotone: what lies within as a double lies within as a float."""
    if entry.type == "u32":
        return f"{entry.low:d}u", f"{entry.high:d}u"
    return "0x1p-149f" if entry.open_low else c_float(entry.low, entry.infinite), c_float(entry.high, entry.infinite)


def c_float(value: float, infinite: bool) -> str:
    """A C constant; an end that is infinite and not allowed is the greatest float."""
    sign = "-" if value < 0 else ""
    if math.isinf(value):
        return sign + ("INFINITY" if infinite else "FLT_MAX")
    return f"{float(value)!r}f"


def _limb_ranges(dictionary: Dictionary) -> str:
    limb = [entry for entry in dictionary.parameters if entry.member.startswith(_LIMB + ".")]
    rows = [
        f"X({entry.member.removeprefix(_LIMB + '.')}, {name}_MIN, \\\n      {name}_MAX)"
        for entry in limb
        for name in [f"BRACE_RANGE_{_stem(_struct_of(dictionary, entry))}_{entry.field.upper()}"]
    ]
    return (
        "\n/* Every member of brace_limb_t in its order, for the preprocessor: X(member, least, greatest). */\n"
        "#define BRACE_LIMB_RANGES(X) \\\n    " + " \\\n    ".join(rows) + "\n"
    )


def _struct_of(dictionary: Dictionary, entry: Entry) -> Struct:
    place = entry.member.rpartition(".")[0]
    return next(
        struct for struct in dictionary.structs
        if place in [struct.member.replace("*", str(part)) for part in range(len(LINKS))]
    )


def _stem(struct: Struct) -> str:
    """JOINT of brace_joint_t."""
    return struct.type.removeprefix("brace_").removesuffix("_t").upper()


def _limb(dictionary: Dictionary) -> Struct:
    return next(struct for struct in dictionary.structs if struct.member == _LIMB)


def _guarded(name: str) -> str:
    return f"{_MADE}#ifndef BRACE_{name}_H\n#define BRACE_{name}_H\n\n"


def _struct(struct: Struct, inner: Sequence[Struct]) -> str:
    lines = [c_comment(struct.says), "typedef struct {\n"]
    for entry in struct.fields:
        kind = "float" if entry.type == "f32" else "uint32_t"
        lines.append(c_comment(f"{_general(entry)} {_range(entry)}", "    "))
        lines.append(f"    {kind} {entry.field};\n")
    for part in inner:
        name = part.member.rpartition(".")[2].replace("*", "BRACE_LINK_COUNT")
        lines.append(f"    {part.type} {name};\n")
    return "".join(lines) + f"}} {struct.type};\n\n"


def _general(entry: Entry) -> str:
    """The description of the first of three links or joints, said of any of them."""
    place = "link" if ".link[" in entry.member else "joint"
    if "[" not in entry.member:
        return entry.description
    return entry.description.replace(LINKS[0], place).replace(ANGLES[0], "the joint")


def _range(entry: Entry) -> str:
    if entry.texts:
        return "[" + ", ".join(f"{number} {text}" for number, text in enumerate(entry.texts)) + "]"
    unit = f"{entry.unit}, " if entry.unit else ""
    if entry.numbers:
        return f"[{unit}{', '.join(str(number) for number in entry.numbers)}]"
    least = "above 0" if entry.open_low else f"{entry.low:g}"
    return f"[{unit}{least} to {entry.high:g}]"

