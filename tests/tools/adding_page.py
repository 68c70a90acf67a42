"""The worked examples of docs/adding.md: their steps, as the page has them, done in a copy of the project."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]
PAGE = PROJECT / "docs" / "adding.md"
# "In `FILE`, behind the line with `TEXT`", "In the new file `FILE`", and the block below; words may stand between.
_STEP = re.compile(
    r"^\d+\. In (?:`(?P<file>[^`]+)`,\s+(?P<place>behind|before) the line with\s+`(?P<line>[^`]+)`"
    r"|the\s+new\s+file\s+`(?P<new>[^`]+)`)(?:(?!^\d+\. |^   ```).*\n)+   ```\w*\n(?P<block>(?:(?!   ```).*\n)+)",
    re.M,
)


@dataclass(frozen=True)
class Step:
    """Text that is written at a place of a file; no place: the file is new."""

    file: str
    place: str
    line: str
    text: str

    @property
    def is_done(self) -> bool:
        """Somebody who tries the page has done it in the project itself."""
        path = PROJECT / self.file
        return path.is_file() and self.text in path.read_text()

    def do(self, project: Path) -> None:
        """Writes it in a copy of the project."""
        path = project / self.file
        if not self.place:
            assert not path.exists(), f"{self.file} is there already"
            path.write_text(self.text)
            return
        lines = path.read_text().splitlines(keepends=True)
        found = [number for number, line in enumerate(lines) if self.line in line]
        assert len(found) == 1, f"{self.file} has {len(found)} lines with {self.line}"
        first = found[0] + (self.place == "behind")
        lines[first:first] = [self.text]
        path.write_text("".join(lines))


def steps(title: str) -> list[Step]:
    """Those of one part of the page."""
    (part,) = [text for text in PAGE.read_text().split("\n## ")[1:] if text.startswith(f"{title}\n")]
    found = [
        Step(one["file"] or one["new"], one["place"] or "", one["line"] or "", _unindented(one["block"]))
        for one in _STEP.finditer(part)
    ]
    blocks = len(re.findall(r"^   ```\w", part, re.M)) + len(re.findall(r"^   ```\n   \|", part, re.M))
    assert len(found) == blocks, f"{title}: {blocks} blocks, and {len(found)} steps say where one goes"
    return found


def _unindented(block: str) -> str:
    """Without the three columns by which a list is indented."""
    return "".join(line.removeprefix("   ") if line.strip() else "\n" for line in block.splitlines(keepends=True))
