"""The Python packages that the Debian package brings along, and the list that pins them.

    .venv/bin/python tools/release/requirements.py    # writes requirements.txt anew: newest versions, with their sums

Debian 12's own numpy, scipy and others are older than Brace needs. The list has versions and sums, so a package that
was changed elsewhere is refused, and the same list gives the same bytes.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

FILE = Path(__file__).with_name("requirements.txt")
TOOLS = Path(__file__).resolve().parents[1]
PYTHON, PLATFORM = "3.11", "manylinux_2_28_x86_64"
_OLDER = ("manylinux_2_27_x86_64", "manylinux_2_24_x86_64", "manylinux_2_17_x86_64", "manylinux2014_x86_64")
WHEELS = ("--only-binary", ":all:", "--python-version", PYTHON, "--implementation", "cp",
          *(word for name in (PLATFORM, *_OLDER, "linux_x86_64") for word in ("--platform", name)))  # fmt: skip
_HEAD = "# Written by tools/release/requirements.py: what the Debian package has inside beside Brace itself.\n"


@dataclass(frozen=True)
class Requirement:
    """One pinned package."""

    name: str
    version: str
    sha256: str


def read() -> list[Requirement]:
    """The list."""
    lines = re.findall(r"^([^#=]+)==(\S+) --hash=sha256:(\w+)$", FILE.read_text(), re.MULTILINE)
    return [Requirement(name, version, sha256) for name, version, sha256 in lines]


def fetched(cache: Path) -> Path:
    """A folder with the wheels of the list, and no others."""
    have = {path.name for path in cache.glob("*.whl")} if cache.is_dir() else set()
    if len(have) != len(read()):
        command = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--require-hashes"]
        subprocess.run([*command, "--dest", str(cache), *WHEELS, "--requirement", str(FILE)], check=True)
    return cache


def resolve() -> str:
    """The newest versions that tools/pyproject.toml allows."""
    command = [sys.executable, "-m", "pip", "install", "--quiet", "--dry-run", "--ignore-installed", "--report", "-"]
    import tomllib

    wanted = tomllib.loads((TOOLS / "pyproject.toml").read_text())["project"]["dependencies"]
    done = subprocess.run(
        [*command, *WHEELS, "--target", "/nowhere", *wanted], check=True, capture_output=True, text=True
    )
    lines = []
    for entry in json.loads(done.stdout)["install"]:
        sha256 = entry["download_info"]["archive_info"]["hashes"]["sha256"]
        name = entry["metadata"]["name"].lower().replace("_", "-").replace(".", "-")
        lines.append(f"{name}=={entry['metadata']['version']} --hash=sha256:{sha256}\n")
    return _HEAD + "".join(sorted(lines))


if __name__ == "__main__":
    FILE.write_text(resolve())
