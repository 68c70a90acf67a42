"""./dev release [--out dist]: everything that a release has, from the last commit, the same bytes each time.

    brace-V-py3-none-manylinux_2_34_*.whl  the brace command with the native library inside, for x86_64 and aarch64
    brace-V.tar.gz                      its source distribution
    libbrace-dev_V_*.deb                C libraries, headers and man pages for amd64 and arm64
    firmware/                           images with their sums
    brace_core.h, brace_core.c          the core as two files
    brace-core-V.zip                    the same for PlatformIO, Arduino, ESP-IDF, Zephyr, Conan and CMSIS packs
    brace.dbc, brace_fd.dbc, modbus.csv what is on the wires
    paper-limb.toml, paper-rig.toml     a limb and a rig to begin with
    brace-V-source.tar.gz               the whole repository: examples, firmware, tests
    brace-V.cdx.json                    bill of materials
    SHA256SUMS
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

from release import source as sources
from release.source import PROJECT, ReleaseError, Source, archive, export, fresh, run, sums

TO_BEGIN_WITH = ("paper-limb.toml", "paper-rig.toml")
ON_THE_WIRES = ("brace.dbc", "brace_fd.dbc", "modbus.csv")


def main(arguments: list[str] | None = None) -> int:
    """The command. It exports the last commit, and goes on with the tools of that commit."""
    parser = argparse.ArgumentParser(prog="./dev release", description="all files of a release, from the last commit")
    parser.add_argument("--out", type=Path, default=Path("dist"), metavar="FOLDER", help="default: dist; emptied first")
    parser.add_argument("--work", type=Path, default=PROJECT / "build" / "release", help=argparse.SUPPRESS)
    parser.add_argument("--commit", help=argparse.SUPPRESS)
    parser.add_argument("--epoch", type=int, help=argparse.SUPPRESS)
    asked = parser.parse_args(arguments)
    try:
        if asked.commit:
            folder = PROJECT
            made_of = Source(folder, asked.commit, asked.epoch, sources.version_of(folder))
            make(made_of, asked.work, asked.out)
            return 0
        if run("git", "status", "--porcelain", cwd=PROJECT).strip():
            print("release: the last commit is released; what is not committed is not in it", file=sys.stderr)
        made_of = export(fresh(asked.work) / "source")
        command = [sys.executable, "-m", "release", "--work", asked.work.resolve(), "--out", asked.out.resolve()]
        command += ["--commit", made_of.commit, "--epoch", str(made_of.epoch_s)]
        tools = str(made_of.folder.resolve() / "tools")
        environment = {**os.environ, "PYTHONPATH": tools, "PYTHONDONTWRITEBYTECODE": "1"}  # nothing is added to sources
        return subprocess.run(command, env=environment, cwd=made_of.folder, check=False).returncode
    except ReleaseError as error:
        print(f"release: {error}", file=sys.stderr)
        return 1


def make(source: Source, work: Path, dist: Path) -> None:
    """All files, into an emptied folder."""
    from release import bill_of_materials, debian, images, library, python_packages, two_files
    from release.about import about

    if about(source.folder).has_placeholders:
        print("release: an address in tools/pyproject.toml is still to be filled in", file=sys.stderr)
    began = time.monotonic()

    def step(name: str) -> None:
        print(f"release: {time.monotonic() - began:4.0f} s  {name}", file=sys.stderr, flush=True)

    os.environ["SOURCE_DATE_EPOCH"] = str(source.epoch_s)
    fresh(dist)
    step("source archive, core as two files, wires, bill of materials")
    archive(source.folder, f"brace-{source.version}", dist / f"brace-{source.version}-source.tar.gz", source.epoch_s)
    for name, text in two_files.two_files(source.version).items():
        (dist / name).write_text(text)
    for name in ON_THE_WIRES:
        shutil.copy(source.folder / "firmware" / "interface" / name, dist)
    for name in TO_BEGIN_WITH:
        shutil.copy(source.folder / "tools" / "brace" / "data" / name, dist)
    library.write_zip(source.folder, work, dist / f"brace-core-{source.version}.zip", source.epoch_s)
    bill_of_materials.write(source, dist)
    step("source distribution")
    sdist = python_packages.source_distribution(source, work, dist)
    for machine in python_packages.MACHINES:
        step(f"wheel for {machine}")
        python_packages.wheel(source, sdist, machine, work, dist)
    step("firmware images")
    images.images(source, work, dist)
    for machine in python_packages.MACHINES:
        step(f"Debian package for {machine}")
        debian.package(source, machine, work, dist)
    (dist / "SHA256SUMS").write_text(sums(dist))
    step(f"done: {dist}")


if __name__ == "__main__":
    sys.exit(main())
