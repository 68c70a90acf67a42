"""MISRA C:2012 over the firmware by cppcheck's addon, judged by deviations.toml. `./dev misra` runs it.

usage: misra.py [--findings FILE] [--all]

Each finding of the addon has to be covered by an entry of deviations.toml, which says why it stays. A finding without
an entry fails the run. So does an entry without a finding: what it excused is gone, and it would excuse the next one.

exit codes: 0 every finding is covered, 1 some is not, 4 cppcheck could not do its work.
"""

from __future__ import annotations

import argparse
import fnmatch
import hashlib
import os
import re
import shutil
import subprocess
import sys
import tomllib
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
DEVIATIONS = Path(__file__).resolve().parent / "deviations.toml"
CHECKED = ("firmware", "hal/dynamixel")
CATEGORIES = ("advisory", "required")  # from a mandatory rule nobody may deviate
FINDING = re.compile(r"(?P<file>[^:]+):(?P<line>\d+):(\d+:)? misra-c2012-(?P<rule>[0-9.]+)$")


class ToolError(Exception):
    """cppcheck is missing or could not do its work."""


@dataclass(frozen=True, order=True)
class Finding:
    """One line of the addon's output."""

    rule: str
    file: str
    line: int
    text: str  # of the source's line

    def __str__(self) -> str:
        return f"{self.file}:{self.line}: rule {self.rule}: {self.text.strip()}"


@dataclass(frozen=True)
class Deviation:
    """What may stay: a rule, in these files, on lines that have this in them."""

    rule: str
    category: str
    files: tuple[str, ...]
    line: str
    why: str

    def covers(self, finding: Finding) -> bool:
        """Is this finding excused by this entry?"""
        return (
            finding.rule == self.rule
            and any(fnmatch.fnmatch(finding.file, pattern) for pattern in self.files)
            and re.search(self.line, finding.text) is not None
        )


def read_deviations(path: Path = DEVIATIONS) -> list[Deviation]:
    """The list. A required rule may only be left with a file or a line named."""
    found = []
    for item in tomllib.loads(path.read_text())["deviation"]:
        entry = Deviation(
            item["rule"],
            item["category"],
            tuple(item.get("files", ["*"])),
            item.get("line", ""),
            " ".join(item["why"].split()),
        )
        if entry.category not in CATEGORIES:
            raise SystemExit(f"{path.name}: rule {entry.rule}: {entry.category!r} is none of {CATEGORIES}")
        if entry.category == "required" and entry.files == ("*",) and not entry.line:
            raise SystemExit(f"{path.name}: rule {entry.rule} is required: name the files or the lines")
        if len(entry.why) < 20:
            raise SystemExit(f"{path.name}: rule {entry.rule}: say why")
        found.append(entry)
    return found


def uncovered(findings: Iterable[Finding], deviations: list[Deviation]) -> list[Finding]:
    """Findings that no entry excuses."""
    return [item for item in findings if not any(entry.covers(item) for entry in deviations)]


def idle(findings: Iterable[Finding], deviations: list[Deviation]) -> list[Deviation]:
    """Entries that excuse nothing."""
    kept = list(findings)
    return [entry for entry in deviations if not any(entry.covers(item) for item in kept)]


def sources() -> list[str]:
    """The C files that are looked at, relative to the project's folder."""
    return sorted(str(path.relative_to(ROOT)) for part in CHECKED for path in (ROOT / part).rglob("*.c"))


def include_folders() -> list[str]:
    """Every folder with headers in it, and those above it that are called include or src."""
    headers = [path.parent for part in ("firmware", "hal") for path in (ROOT / part).rglob("*.h")]
    above = [
        parent for folder in headers for parent in folder.parents if parent.name in ("include", "src", "generated")
    ]
    return sorted({str(folder.relative_to(ROOT)) for folder in [*headers, *above]})


def kept_results(root: Path = ROOT) -> Path:
    """What cppcheck keeps of its last run; nothing after any change. A comment that moves lines changes no file for
    cppcheck, and then its findings stand at other lines."""
    kept = root / "build" / "misra"
    stamp, now = kept / "texts", hashlib.sha256()
    for text in sorted(path for part in ("firmware", "hal") for path in (root / part).rglob("*.[ch]")):
        now.update(str(text.relative_to(root)).encode() + text.read_bytes())
    if not stamp.is_file() or stamp.read_text() != now.hexdigest():
        shutil.rmtree(kept, ignore_errors=True)
        kept.mkdir(parents=True)
        stamp.write_text(now.hexdigest())
    return kept


def run_cppcheck(jobs: int) -> str:
    """The addon's findings, one a line. What has not changed since the last run comes from build/misra."""
    kept = kept_results()
    command = [
        "cppcheck",
        "--addon=misra",
        "--platform=unix32",  # the sizes of a Cortex-M's types
        "--std=c11",
        "--language=c",
        "--quiet",
        "--enable=style",
        "--max-configs=1",
        f"-j{jobs}",
        f"--cppcheck-build-dir={kept}",
        "--template={file}:{line}: {id}",
        *(f"-I{folder}" for folder in include_folders()),
        *sources(),
    ]
    try:
        done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    except FileNotFoundError as error:
        raise ToolError("cppcheck is not installed; try: apt-get install cppcheck") from error
    if done.returncode != 0:
        raise ToolError(f"cppcheck ended with {done.returncode}: {done.stdout[-500:]}")
    return done.stderr


def parse(output: str, root: Path = ROOT) -> list[Finding]:
    """The findings of rules, each once: a header is seen from every file that includes it."""
    found, texts = set(), {}
    for text in output.splitlines():
        match = FINDING.match(text)
        if match is None:
            continue
        name, line = match["file"], int(match["line"])
        if name not in texts:
            texts[name] = (root / name).read_text().splitlines()
        found.add(Finding(match["rule"], name, line, texts[name][line - 1] if line > 0 else ""))
    return sorted(found)


def main() -> int:
    parser = argparse.ArgumentParser(description="MISRA C:2012 over the firmware, judged by deviations.toml")
    parser.add_argument("--findings", type=Path, help="judge what cppcheck wrote earlier instead of running it")
    parser.add_argument("--all", action="store_true", help="list covered findings too")
    asked = parser.parse_args()
    deviations = read_deviations()
    output = asked.findings.read_text() if asked.findings else run_cppcheck(os.cpu_count() or 1)
    findings = parse(output)
    if not findings:
        raise ToolError("the addon found nothing at all: was it run?")
    wrong, unused = uncovered(findings, deviations), idle(findings, deviations)
    for finding in findings if asked.all else wrong:
        print(finding)
    for entry in unused:
        print(
            f"deviations.toml: rule {entry.rule}, {' '.join(entry.files)}, {entry.line!r}: excuses nothing any more"
        )
    print(
        f"{len(sources())} files, {len(findings)} findings, {len(findings) - len(wrong)} of them covered by "
        f"{len(deviations)} deviations; {len(wrong)} not covered"
    )
    return 1 if wrong or unused else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except ToolError as error:
        print(f"misra: {error}", file=sys.stderr)
        sys.exit(4)
