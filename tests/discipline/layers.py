"""Who includes whom in firmware/, hal/ and host_sim/, judged by docs/layers.toml.

    python tests/discipline/layers.py     prints every include that the list does not allow, and every circle

A source and the header of its name that it includes count as one unit: a circle of units is a circle of includes, or
of functions that call back through one another's headers. Exit codes: 0 none, 1 some.
"""

from __future__ import annotations

import re
import sys
import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from sources import ROOT, Finding

LIST = ROOT / "docs" / "layers.toml"
FOLDERS = ("firmware", "hal", "host_sim")
SUFFIXES = (".c", ".cpp", ".h")
WRITTEN_BY_THE_BUILD = ("build_info.h",)
INCLUDE_FOLDERS = ("generated", "host_sim", "include", "src")
INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"')

LAYER = "layer"
CIRCLE = "circle"


@dataclass(frozen=True)
class Include:
    """One #include of a file of the project; paths are relative to the root."""

    source: Path
    line: int
    target: Path


@dataclass(frozen=True)
class Room:
    """Files that belong together, and the rooms whose headers they may include."""

    name: str
    folders: tuple[Path, ...]
    knows: frozenset[str]


def read_rooms(path: Path) -> list[Room]:
    """The list of rooms. Raises ValueError when a room knows one that is not listed."""
    listed = tomllib.loads(path.read_text())["room"]
    rooms = [
        Room(name, tuple(Path(place) for place in entry["files"]), frozenset(entry["knows"]))
        for name, entry in listed.items()
    ]
    for room in rooms:
        unknown = room.knows - listed.keys()
        if unknown:
            raise ValueError(f"{path.name}: {room.name} knows {', '.join(sorted(unknown))}: there is no such room")
    return rooms


def room_of(file: Path, rooms: Iterable[Room]) -> Room | None:
    """The room with the longest folder that holds the file."""
    holding = [(len(place.parts), room) for room in rooms for place in room.folders if file.is_relative_to(place)]
    return max(holding, key=lambda at: at[0])[1] if holding else None


def project_files(root: Path) -> list[Path]:
    """All C and C++ files, relative to the root."""
    return sorted(
        path.relative_to(root)
        for folder in FOLDERS
        for path in (root / folder).rglob("*")
        if path.suffix in SUFFIXES
    )


def includes_of(root: Path, files: list[Path]) -> tuple[list[Include], list[Finding]]:
    """Every include of a project file; and those that name no file, or more than one."""
    known = set(files)
    by_name: dict[str, list[Path]] = {}
    for file in files:
        by_name.setdefault(file.name, []).append(file)
    found, unclear = [], []
    for file in files:
        for number, line in enumerate((root / file).read_text().splitlines(), 1):
            match = INCLUDE.match(line)
            if match is None or match[1] in WRITTEN_BY_THE_BUILD:
                continue
            name = Path(match[1])
            beside = file.parent / name
            ending = [path for path in by_name.get(name.name, []) if _ends(path, name)]
            rooted = [path for path in ending if _root_of(path, name).name in INCLUDE_FOLDERS]
            fitting = [beside] if beside in known else rooted or ending
            if len(fitting) == 1:
                found.append(Include(file, number, fitting[0]))
            else:
                why = f'"{name}" is one of {", ".join(map(str, fitting))}' if fitting else f'"{name}" is no file'
                unclear.append(Finding(root / file, number, LAYER, f"{why}; name it from its include folder"))
    return found, unclear


def _root_of(path: Path, name: Path) -> Path:
    """The folder from which an include of this name finds this file."""
    return Path(*path.parts[: -len(name.parts)])


def _ends(path: Path, name: Path) -> bool:
    return path.parts[-len(name.parts):] == name.parts


def forbidden(root: Path, files: list[Path], includes: list[Include], rooms: list[Room]) -> list[Finding]:
    """Files in no room, and includes of a room that the list does not allow."""
    found = [
        Finding(root / file, 1, LAYER, f"is in no room of {LIST.name}; add its folder")
        for file in files
        if room_of(file, rooms) is None
    ]
    for include in includes:
        own, other = room_of(include.source, rooms), room_of(include.target, rooms)
        if own is not None and other is not None and other != own and other.name not in own.knows:
            why = f"{own.name} may not know {other.name}: it includes {include.target}"
            found.append(Finding(root / include.source, include.line, LAYER, why))
    return found


def units(files: list[Path], includes: list[Include]) -> dict[Path, Path]:
    """File -> the file that stands for its unit: of a source and its header, the header."""
    chosen = {file: file for file in files}

    def head(file: Path) -> Path:
        while chosen[file] != file:
            file = chosen[file]
        return file

    for include in includes:
        if include.source.suffix != ".h" and include.source.stem == include.target.stem:
            chosen[head(include.source)] = head(include.target)
    return {file: head(file) for file in files}


def circles(root: Path, files: list[Path], includes: list[Include]) -> list[Finding]:
    """Units that include one another, directly or by way of others; one finding each circle, at one of its lines."""
    unit = units(files, includes)
    lines: dict[Path, dict[Path, Include]] = {file: {} for file in unit.values()}
    for include in includes:
        if unit[include.source] != unit[include.target]:
            lines[unit[include.source]].setdefault(unit[include.target], include)
    found = []
    for circle in strongly_connected({file: set(targets) for file, targets in lines.items()}):
        if len(circle) > 1:
            inside = [line for file in circle for target, line in lines[file].items() if target in circle]
            shown = "; ".join(f"{line.source}:{line.line} includes {line.target}" for line in inside)
            found.append(Finding(root / inside[0].source, inside[0].line, CIRCLE, f"{len(circle)} units: {shown}"))
    return found


def strongly_connected(graph: Mapping[Path, set[Path]]) -> list[list[Path]]:
    """Groups of nodes that reach one another."""
    reached = {node: _reach(graph, node) for node in graph}
    groups: dict[frozenset[Path], list[Path]] = {}
    for node in graph:
        mutual = frozenset(other for other in reached[node] if node in reached[other]) | {node}
        groups.setdefault(mutual, []).append(node)
    return [sorted(group) for group in groups.values()]


def _reach(graph: Mapping[Path, set[Path]], start: Path) -> set[Path]:
    seen: set[Path] = set()
    queue = [start]
    while queue:
        for other in graph[queue.pop()] - seen:
            seen.add(other)
            queue.append(other)
    return seen


def check(root: Path = ROOT, listed: Path = LIST) -> list[Finding]:
    """Everything that is wrong."""
    files = project_files(root)
    includes, unclear = includes_of(root, files)
    return unclear + forbidden(root, files, includes, read_rooms(listed)) + circles(root, files, includes)


def main() -> int:
    """Prints the findings; the exit code."""
    findings = check()
    print("\n".join([*map(str, findings), f"{len(findings)} findings"]))
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
