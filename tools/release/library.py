"""The core as one folder that PlatformIO, Arduino, ESP-IDF, Zephyr, Conan and CMSIS packs take as it is.

    python3 tools/release/library.py --out brace-core

It has the two files of the core, the manifests of `packaging` filled in, the licence, and an example with a limb in it.
"""

from __future__ import annotations

import argparse
import re
import shutil
import sys
import time
import zipfile
from pathlib import Path

if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from release import two_files
from release.about import About, about
from release.source import PROJECT

TEMPLATES = "packaging"
EXAMPLE = ("main.c", "limb.c", "limb.h")


def filled_in(text: str, ours: About) -> str:
    """A template with the words between @ replaced; KeyError for a word that nobody knows."""
    words = {
        "version": ours.version,
        "summary": ours.summary,
        "author": ours.author,
        "email": ours.email,
        "homepage": ours.urls["Homepage"],
        "source": ours.urls["Source"],
    }
    return re.sub(r"@(\w+)@", lambda found: words[found[1]], text)


def write(project: Path, out: Path) -> None:
    """Writes the folder. The same sources give the same bytes."""
    ours = about(project)
    for template in sorted((project / TEMPLATES).rglob("*")):
        if template.is_file() and template.name != "README.md":
            path = out / template.relative_to(project / TEMPLATES)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(filled_in(template.read_text(), ours))
    (out / "src").mkdir(exist_ok=True)
    for name, text in two_files.two_files(ours.version).items():
        (out / "src" / name).write_text(text)
    (out / "examples" / "k").mkdir(parents=True, exist_ok=True)
    for name in EXAMPLE:
        shutil.copy(project / "examples" / "bare_loop" / name, out / "examples" / "k")
    shutil.copy(project / "LICENSE", out / "LICENSE")


def write_zip(project: Path, work: Path, out: Path, epoch_s: int) -> None:
    """The folder as a .zip, which Arduino's and PlatformIO's tools install; all files of one time."""
    folder = work / "brace-core"
    shutil.rmtree(folder, ignore_errors=True)
    write(project, folder)
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as file:
        for path in sorted(path for path in folder.rglob("*") if path.is_file()):
            entry = zipfile.ZipInfo(str(path.relative_to(work)), time.gmtime(epoch_s)[:6])
            entry.external_attr = 0o644 << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            file.writestr(entry, path.read_bytes())


def main(arguments: list[str] | None = None) -> int:
    """The command."""
    parser = argparse.ArgumentParser(description="the core as a folder that other build systems take")
    parser.add_argument("--out", type=Path, required=True, metavar="FOLDER", help="where it is written")
    write(PROJECT, parser.parse_args(arguments).out)
    return 0


if __name__ == "__main__":
    sys.exit(main())
