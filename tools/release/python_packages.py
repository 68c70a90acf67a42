"""The source distribution and the wheel of the `brace` command."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

from release.source import Source, fresh, run

# What CMake needs to build libbrace_host.so, and the licence; the package itself lies beside it.
NATIVE = ("CMakeLists.txt", "firmware", "hal", "host_sim")
NOT_NATIVE = shutil.ignore_patterns("boards", "*.md", "stm32f405", "mps2")


def source_distribution(source: Source, work: Path, dist: Path) -> Path:
    """brace-<version>.tar.gz: tools/pyproject.toml and tools/brace, with the C and C++ sources in `native`."""
    tree = fresh(work / "sdist")
    shutil.copytree(source.folder / "tools" / "brace", tree / "brace")
    shutil.copy(source.folder / "tools" / "pyproject.toml", tree)
    shutil.copy(source.folder / "LICENSE", tree)
    for name in NATIVE:
        path = source.folder / name
        if path.is_dir():
            shutil.copytree(path, tree / "native" / name, ignore=NOT_NATIVE)
        else:
            (tree / "native").mkdir(exist_ok=True)
            shutil.copy(path, tree / "native")
    build = (sys.executable, "-m", "build", "--no-isolation", "--sdist", "--outdir", dist, tree)
    run(*build, environment=source.environment)
    return dist / f"brace-{source.version}.tar.gz"


def wheel(source: Source, sdist: Path, work: Path, dist: Path) -> Path:
    """The wheel, built from the source distribution as anybody would build it."""
    tree = fresh(work / "wheel")
    shutil.unpack_archive(sdist, tree)
    build = (sys.executable, "-m", "build", "--no-isolation", "--wheel", "--outdir", dist)
    run(*build, tree / sdist.name.removesuffix(".tar.gz"), environment=source.environment)
    return next(dist.glob(f"brace-{source.version}-*.whl"))
