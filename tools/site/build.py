"""docs/ and the C headers as a site: build.py FOLDER. Exit code 1 at any warning, 4 where a generator is missing."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent


def build(folder: Path) -> int:
    """Writes the site; returns the exit code."""
    for program in ("doxygen", Path(sys.executable).with_name("mkdocs")):
        if shutil.which(program) is None:
            print(f"{program} is missing: ./dev docs installs it", file=sys.stderr)
            return 4
    environment = os.environ | {"NO_MKDOCS_2_WARNING": "1"}
    mkdocs = [sys.executable, "-m", "mkdocs", "build", "--quiet", "--strict", "-f", HERE / "mkdocs.yml", "-d", folder]
    pages = subprocess.run(mkdocs, env=environment, check=False).returncode
    (folder / "c").mkdir(parents=True, exist_ok=True)
    wanted = (HERE / "Doxyfile").read_text() + f"\nOUTPUT_DIRECTORY = {folder / 'c'}\n"
    headers = subprocess.run(["doxygen", "-"], input=wanted, text=True, cwd=HERE, check=False).returncode
    return int(pages != 0 or headers != 0)


if __name__ == "__main__":
    sys.exit(build(Path(sys.argv[1]).resolve()))
