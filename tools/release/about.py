"""Who made Brace, and where it lives: tools/pyproject.toml says it once, for all that is released."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path

PLACEHOLDER = "example.com"


@dataclass(frozen=True)
class About:
    """What every package says of itself; `urls` by the names that pip shows."""

    name: str
    version: str
    summary: str
    author: str
    email: str
    urls: dict[str, str]
    keywords: tuple[str, ...]
    needs: tuple[str, ...]  # of the command, as pip reads them

    @property
    def has_placeholders(self) -> bool:
        """Whether the address of the author or of the project is still to be filled in."""
        return any(PLACEHOLDER in text for text in (self.email, *self.urls.values()))


def about(folder: Path) -> About:
    """As the sources in this folder say it."""
    project = tomllib.loads((folder / "tools" / "pyproject.toml").read_text())["project"]
    author = project["authors"][0]
    return About(
        project["name"],
        project["version"],
        project["description"],
        author["name"],
        author["email"],
        dict(project["urls"]),
        tuple(project["keywords"]),
        tuple(project["dependencies"]),
    )
