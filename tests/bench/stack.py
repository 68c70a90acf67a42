"""Stack of a function and all it calls, from the compiler's own figures (-fcallgraph-info=su)."""

import re
from pathlib import Path

NODE = re.compile(r'node: \{ title: "([^"]+)" label: "([^"]*)"')
EDGE = re.compile(r'edge: \{ sourcename: "([^"]+)" targetname: "([^"]+)"')
FRAME = re.compile(r"(\d+) bytes \((\w+)")


def _short(title: str) -> str:
    """A static function's title carries its file; its calls use the same title, so only a check needs the name."""
    return title.rsplit(":", 1)[-1]


def worst_stack_bytes(objects: list[Path], function: str) -> tuple[int, tuple[str, ...]]:
    """Deepest stack below a call of `function` [B], and the chain of functions that needs it.

    Functions the compiler has no figure for (the C library's) count as zero and are named with a '?'.
    """
    frames: dict[str, int] = {}
    calls: dict[str, set[str]] = {}
    for objectfile in objects:
        text = objectfile.with_suffix(".ci").read_text()
        for title, label in NODE.findall(text):
            frame = FRAME.search(label)
            if frame:
                if frame[2] != "static":
                    raise RuntimeError(f"{title}: its stack is {frame[2]}, not static")
                frames[title] = int(frame[1])
        for caller, callee in EDGE.findall(text):
            calls.setdefault(caller, set()).add(callee)

    def deepest(title: str, above: tuple[str, ...]) -> tuple[int, tuple[str, ...]]:
        if title in above:
            raise RuntimeError(f"recursion: {' -> '.join((*above, title))}")
        below = [deepest(callee, (*above, title)) for callee in sorted(calls.get(title, ()))]
        size, chain = max(below, default=(0, ()))
        name = _short(title) if title in frames else _short(title) + "?"
        return frames.get(title, 0) + size, (name, *chain)

    return deepest(function, ())
