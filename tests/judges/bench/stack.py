"""Stack of a function and all it calls, from the compiler's own figures (-fcallgraph-info=su).

A call that ends its function by a jump (a sibling call) finds the caller's frame taken down already, so the two do not
add. The object file's relocations show which calls are jumps; each function has a section of its own.
"""

import re
from collections import defaultdict
from pathlib import Path

from toolchain import PREFIX, run

NODE = re.compile(r'node: \{ title: "([^"]+)" label: "([^"]*)"')
EDGE = re.compile(r'edge: \{ sourcename: "([^"]+)" targetname: "([^"]+)"')
FRAME = re.compile(r"(\d+) bytes \((\w+)")
SECTION = re.compile(r"RELOCATION RECORDS FOR \[\.text\.(?:unlikely\.)?([^\]]+)\]")
TARGET = re.compile(r"^[0-9a-f]+ (R_ARM_\w+)\s+(\S+)", re.MULTILINE)
JUMPS = {"R_ARM_THM_JUMP24", "R_ARM_THM_JUMP19", "R_ARM_THM_JUMP11"}


def _short(title: str) -> str:
    """A static function's title carries its file; its calls use the same title, so only a check needs the name."""
    return title.rsplit(":", 1)[-1]


def _jumps(objectfile: Path) -> set[tuple[str, str]]:
    """(caller, callee), by their short names, of all calls in an object that are jumps wherever they stand."""
    text = run([PREFIX + "objdump", "-r", objectfile])
    kinds: dict[tuple[str, str], set[str]] = defaultdict(set)
    for part in text.split("\n\n"):
        section = SECTION.search(part)
        if section:
            for kind, target in TARGET.findall(part):
                kinds[section[1], target].add(kind)
    return {call for call, found in kinds.items() if found <= JUMPS}


def worst_stack_bytes(objects: list[Path], function: str) -> tuple[int, tuple[str, ...]]:
    """Deepest stack below a call of `function` [B], and the chain of functions that needs it.

    Functions the compiler has no figure for (the C library's) count as zero and are named with a '?'.
    """
    frames: dict[str, int] = {}
    calls: dict[str, set[str]] = {}
    jumps: set[tuple[str, str]] = set()
    for objectfile in objects:
        jumped = _jumps(objectfile)
        text = objectfile.with_suffix(".ci").read_text()
        for title, label in NODE.findall(text):
            frame = FRAME.search(label)
            if frame:
                if frame[2] != "static":
                    raise RuntimeError(f"{title}: its stack is {frame[2]}, not static")
                frames[title] = int(frame[1])
        for caller, callee in EDGE.findall(text):
            calls.setdefault(caller, set()).add(callee)
            if (_short(caller), _short(callee)) in jumped:
                jumps.add((caller, callee))

    def deepest(title: str, above: tuple[str, ...]) -> tuple[int, tuple[str, ...]]:
        if title in above:
            raise RuntimeError(f"recursion: {' -> '.join((*above, title))}")
        frame = frames.get(title, 0)
        sizes: list[tuple[int, tuple[str, ...]]] = [(frame, ())]
        for callee in sorted(calls.get(title, ())):
            size, chain = deepest(callee, (*above, title))
            sizes.append((size if (title, callee) in jumps else frame + size, chain))
        size, chain = max(sizes)
        name = _short(title) if title in frames else _short(title) + "?"
        return size, (name, *chain)

    return deepest(function, ())
