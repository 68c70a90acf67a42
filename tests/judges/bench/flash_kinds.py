"""What an image's flash is made of, by kinds of instructions, from the disassembly."""

import re
from pathlib import Path

from toolchain import PREFIX, run

ARITHMETIC, MEMORY, CONSTANTS, CONTROL, MOVES = KINDS = (
    "arithmetic", "loads, stores", "constants, tables", "branches, calls, comparisons", "moves, frames")

LINE = re.compile(r"^\s+[0-9a-f]+:\t([0-9a-f ]+)\t(\S+)\s*(.*)", re.MULTILINE)
# The first that fits, by mnemonic and operands; what fits none is a move.
RULES = (
    (CONSTANTS, r"\.(word|short|byte)\b"),
    (CONSTANTS, r"v?ldr\S* \S+, \[pc"),
    (CONSTANTS, r"vmov\S* \S+, #"),
    (MOVES, r"(v?push|v?pop)\b|(ldmia|stmdb)\S* sp!|(add|sub)w? sp,"),
    (MEMORY, r"v?(ldr|str|ldm|stm)"),
    (CONTROL, r"v(cmp|mrs)|(cmp|cmn|tst)\b|it\S* "),
    (CONTROL, r"(b|bl|bx|cbz|cbnz)(eq|ne|cs|cc|mi|pl|vs|vc|hi|ls|ge|lt|gt|le)?(\.[nw])? "),
    (ARITHMETIC, r"v(add|sub|mul|fma|fms|fnm|nmul|mla|mls|nml|div|sqrt|abs|neg|cvt)"),
    (ARITHMETIC, r"(smull|smlal|smmul|umull|mul|mla|mls|lsl|lsr|asr|ror)"),
    (ARITHMETIC, r"(add|adc|sub|sbc|rsb|and|orr|eor|bic|ubfx|sbfx|bfi)"),
)


def _kind(instruction: str) -> str:
    return next((kind for kind, rule in RULES if re.match(rule, instruction)), MOVES)


def kinds_of(image: Path, flash: int) -> dict[str, int]:
    """Kind -> bytes of an image that weighs `flash` [B]; what is no code is constants."""
    found = dict.fromkeys(KINDS, 0)
    for code, mnemonic, operands in LINE.findall(run([PREFIX + "objdump", "-d", image])):
        found[_kind(f"{mnemonic} {operands}")] += len(code.replace(" ", "")) // 2
    found[CONSTANTS] += flash - sum(found.values())
    return found
