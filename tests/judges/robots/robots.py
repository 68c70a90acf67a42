"""Legs and arms of real robots, and legs made at random, through `brace new --urdf`: right, or truly refused?

    .venv/bin/python -m pip install -e 'tools[robots]'
    .venv/bin/python tests/judges/robots/robots.py [--made 40] [--seed 520318] [--folder URDFS] [--write]

--write puts the table into docs/your-limb.md. Exit code 1 where anything is wrong. README.md says what is judged."""

from __future__ import annotations

import argparse
import importlib.metadata
import os
import re
import sys
import tempfile
from collections import defaultdict
from pathlib import Path

import made
import numpy as np
from chain import HINGES, read
from legs import Leg, brace, judge

PACKAGE = "example-robot-data"
PAGE = Path(__file__).resolve().parents[3] / "docs" / "your-limb.md"
BEGIN, END = "<!-- robots.py writes from here -->\n", "<!-- to here -->\n"
SEED = 520_318
REFUSED = {
    "count": "not two or three hinges up to the end", "slide": "a slide on the way",
    "hip and knee": "two hinges across one another", "three in the plane": "three hinges in one plane",
    "on an axis": "the end lies on an axis", "mimic": "a joint that mimics another", "no yaw": "", "two hinges": "",
    "leaning plane": "",
}  # fmt: skip


def packaged() -> dict[str, Path]:
    """URDFs of the installed package by a short name; none without it."""
    try:
        files = importlib.metadata.distribution(PACKAGE).files or []
    except importlib.metadata.PackageNotFoundError:
        return {}
    return named([Path(str(file.locate())) for file in files if file.suffix == ".urdf"])


def named(paths: list[Path]) -> dict[str, Path]:
    """By the folder of the robot, with the file's name where there are several of it."""
    found = {}
    for path in sorted(paths):
        folder = next((part for part in path.parts if re.search("_(description|data)$", part)), path.stem)
        found[f"{folder.rpartition('_')[0].removesuffix('_simple') or path.stem}/{path.stem}"] = path
    return found


def real(paths: dict[str, Path], folder: Path) -> dict[str, list[list[Leg]]]:
    """What became of every end of every robot."""
    found: dict[str, list[list[Leg]]] = {}
    for name, path in paths.items():
        robot = read(path)
        found[name] = [judge(robot, end, folder) for end in robot.ends()]
        if trouble := without_tip(path, folder):
            found[name].append([Leg(path.stem, "no tip named", "refused", wrong=[trouble])])
    return found


def without_tip(path: Path, folder: Path) -> str:
    """With no tip named, the only end of two or three hinges, or the ends that there are; what is wrong with it."""
    robot = read(path)
    parents = {parent for parent, _ in robot.above.values()}
    ends = [
        link for link in robot.links
        if link not in parents and sum(joint.kind in HINGES for joint in robot.moving_up_to(link)) in (2, 3)
    ]  # fmt: skip
    _, _, err = brace("new", "--out", folder / "never.toml", "--urdf", path)
    counted = re.search(r"(\d+) chains of two or three hinges end in this robot", err)
    if len(ends) == 1:
        return f"there is one end, {ends[0]}: {err}" if counted else ""
    if not counted or int(counted[1]) != len(ends):
        return f"{len(ends)} ends: {err}"
    said = re.search(r"their ends: (.*)", err)
    return "" if not ends or said and set(said[1].split(", ")) == set(ends) else f"{ends} are the ends: {err}"


def made_at_random(each: int, seed: int, folder: Path) -> dict[str, list[list[Leg]]]:
    """Legs of every kind."""
    found = defaultdict(list)
    path = folder / "made.urdf"
    for number, kind in enumerate(made.KINDS):
        for index in range(each):
            end = made.write(path, kind, np.random.default_rng([seed, index, number]))
            found[kind].append(judge(read(path), end, folder, index))
    return found


def what_became(tries: list[Leg]) -> str:
    """One leg in some words."""
    kind, _, reason = tries[0].why.partition("\n")[0].partition(": ")
    gone = next((leg for leg in tries if leg.became == "space"), None)
    if gone:
        return "in space with --urdf-frame leg; else planar" if gone.own_frame else "in space"
    if planar := next((leg for leg in tries if leg.became == "plane"), None):
        own = " with --urdf-frame leg" if planar.own_frame else ""
        if kind == "two hinges":
            return f"planar{own}: two hinges"
        aside = re.search(r"the (\w+) stands (\S+) mm beside", reason)
        rolls = "its first joint rolls" if " 90 deg from the vertical" in reason else "its first joint leans"
        return f"planar{own}: {rolls}" + (f", and the {aside[1]} stands {aside[2]} mm beside it" if aside else "")
    return "refused: " + REFUSED[re.split(r"\W*:", tries[-1].why)[0]]


def table(found: dict[str, list[list[Leg]]]) -> str:
    """Markdown: a line for robots of one kind of leg, one for each reason of a refusal."""
    limbs: dict[tuple[str, str], list[Leg]] = defaultdict(list)
    refused: dict[str, list[str]] = defaultdict(list)
    for name, ends in found.items():
        for tries in ends:
            became = what_became(tries)
            if became.startswith("refused"):
                refused[became.partition(": ")[2]].append(name)
            else:
                limbs[name, became] += tries
    lines = [
        "| robot of example-robot-data 6.0.0 | legs | what becomes of them | K off by, at most |", "|---|---|---|---|"
    ]  # fmt: skip
    for (name, became), legs in limbs.items():
        error = max(leg.error for leg in legs)
        lines.append(f"| {name} | {len({leg.end for leg in legs})} | {became} | {error:.0e} |")
    lines += ["", "| refused | ends | of |", "|---|---|---|"]
    for reason, names in sorted(refused.items(), key=lambda each: -len(each[1])):
        lines.append(f"| {reason} | {len(names)} | {', '.join(sorted({name.partition('/')[0] for name in names}))} |")
    return "\n".join(lines) + "\n"


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--made", type=int, default=40, help="legs made at random, of each kind")
    parser.add_argument("--seed", type=int, default=SEED)
    parser.add_argument("--folder", type=Path, help="URDFs, instead of the package's")
    parser.add_argument("--write", action="store_true", help="put the table into docs/your-limb.md")
    arguments = parser.parse_args()
    paths = named(list(arguments.folder.resolve().rglob("*.urdf"))) if arguments.folder else packaged()
    if not paths:
        print(f"{PACKAGE} is not installed: pip install -e 'tools[robots]', or --folder with URDFs", file=sys.stderr)
        return 2
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        found = real(paths, Path(folder))
        at_random = made_at_random(arguments.made, arguments.seed, Path(folder))
        left = [path.name for path in Path(folder).iterdir() if path.suffix.lower() == ".txt"]
    print(table(found))
    wrong = 0
    for name, ends in {**found, **at_random}.items():
        for leg in (leg for tries in ends for leg in tries):
            wrong += bool(leg.wrong)
            for sentence in leg.wrong[:2]:
                print(f"WRONG {name} {leg.end} ({leg.became}): {sentence}")
    counted = {which: [leg for ends in legs.values() for tries in ends for leg in tries]
               for which, legs in (("real", found), ("made", at_random))}  # fmt: skip
    for which, legs in counted.items():
        became = {each: sum(leg.became == each for leg in legs) for each in ("space", "plane", "refused")}
        print(f"{which}: {len(legs)} runs: {became}")
    print(f"{wrong} wrong" + (f"; left behind: {left}" if left else ""))
    if arguments.write:
        before, _, rest = PAGE.read_text().partition(BEGIN)
        PAGE.write_text(before + BEGIN + table(found) + END + rest.partition(END)[2])
    return 1 if wrong or left else 0


if __name__ == "__main__":
    sys.exit(main())
