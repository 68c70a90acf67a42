"""The Debian package, for Debian 12 on amd64: the `brace` command with all that it needs, and the C libraries.

The command's Python packages lie in /usr/lib/brace and nobody else sees them, because Debian 12's own numpy, scipy and
others are older than Brace needs. requirements.txt pins them.
"""

from __future__ import annotations

import gzip
import shutil
import sys
from pathlib import Path

from brace.cli.completion_command import SHELLS, completion
from release import man_pages, requirements
from release.source import Source, fresh, run, set_times

ARCHITECTURE = "amd64"
COMMAND = """#!/usr/bin/python3 -I
import sys

sys.path.insert(0, "/usr/lib/brace")
from brace.cli import main

sys.exit(main())
"""
CONTROL = """Package: brace
Version: {version}
Architecture: {architecture}
Maintainer: The Brace authors <brace@localhost>
Installed-Size: {kilobytes}
Depends: python3 (>= 3.11), python3 (<< 3.12), libc6 (>= 2.36), libstdc++6 (>= 12)
Recommends: can-utils, libmodbus5
Suggests: cmake, pkg-config, libmodbus-dev
Section: science
Priority: optional
Description: stiffness at the tip of a climbing robot's limb
 The command brace computes the stiffness of a limb, identifies it from
 measurements, finds what a model lacks, and talks to the limb's controller
 over CAN and Modbus. The C libraries brace-core, brace-app and brace-client
 compute it in programs of your own and read it from a controller.
"""
COMPLETIONS = {
    "bash": "usr/share/bash-completion/completions/brace",
    "zsh": "usr/share/zsh/vendor-completions/_brace",
    "fish": "usr/share/fish/vendor_completions.d/brace.fish",
}
COPYRIGHT = """Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: Brace

Files: *
Copyright: 2026 The Brace authors
License: Apache-2.0
 On Debian systems the text is in /usr/share/common-licenses/Apache-2.0.

Files: usr/lib/brace/*
Copyright: the authors of each package
License: each package's own, in its folder *.dist-info
"""


def package(source: Source, wheel: Path, work: Path, cache: Path, dist: Path) -> Path:
    """brace_<version>_amd64.deb. `cache` keeps the wheels of requirements.txt from one run to the next."""
    root = fresh(work / "debian")
    _python(wheel, requirements.fetched(cache), root / "usr" / "lib" / "brace", source)
    _libraries(source, work, root)
    _write(root / "usr/bin/brace", COMMAND).chmod(0o755)
    for shell in SHELLS:
        _write(root / COMPLETIONS[shell], completion(shell) + "\n")
    man_pages.write(root / "usr/share/man/man1", source.version)
    for page in sorted((root / "usr/share/man/man1").iterdir()):
        _compressed(page)
    _documents(source, root / "usr/share/doc/brace")
    _control(root, source)
    set_times(root, source.epoch_s)
    out = dist / f"brace_{source.version}_{ARCHITECTURE}.deb"
    build = ("dpkg-deb", "--root-owner-group", "-Zzstd", "-z9", "--threads-max=1", "--build", root, out)
    run(*build, environment=source.environment)
    return out


def _documents(source: Source, folder: Path) -> None:
    """What a person reads. brace/ground/errors.py says in messages where the pages lie."""
    _write(folder / "copyright", COPYRIGHT)
    _compressed(_write(folder / "changelog", (source.folder / "CHANGELOG.md").read_text()))
    shutil.copytree(source.folder / "examples", folder / "examples")
    shutil.copytree(source.folder / "docs", folder / "docs", ignore=shutil.ignore_patterns("*.json", "*.toml"))
    for name in ("paper-limb.toml", "paper-rig.toml"):
        shutil.copy(source.folder / "tools" / "brace" / "data" / name, folder)


def _python(wheel: Path, wheels: Path, folder: Path, source: Source) -> None:
    """The command and its packages, compiled, so that nobody needs the right to write there."""
    install = (sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--no-compile", "--no-index")
    chosen = (*requirements.WHEELS, "--target", folder)
    run(*install, *chosen, wheel, *sorted(wheels.glob("*.whl")), environment=source.environment)
    shutil.rmtree(folder / "bin", ignore_errors=True)
    shutil.rmtree(folder / "share", ignore_errors=True)
    _forget_where_from(folder)
    # No time is in a compiled file, so the same sources give the same bytes.
    compile_all = ("-m", "compileall", "-q", "--invalidation-mode", "unchecked-hash")
    run("/usr/bin/python3", *compile_all, "-s", folder, "-p", "/usr/lib/brace", folder, environment=source.environment)


def _forget_where_from(folder: Path) -> None:
    """pip notes the folder of this machine that a wheel came from, and that note's sum."""
    for note in folder.glob("*.dist-info/direct_url.json"):
        note.unlink()
        record = note.with_name("RECORD")
        lines = record.read_text().splitlines(keepends=True)
        record.write_text("".join(line for line in lines if "direct_url.json" not in line))


def _libraries(source: Source, work: Path, root: Path) -> None:
    """The C libraries and their packages for CMake and pkg-config."""
    build = work / "host"
    cache = ("-DCMAKE_BUILD_TYPE=Release", "-DBRACE_TESTS=OFF", "-DBRACE_HOST_SIM=OFF", "-DCMAKE_INSTALL_LIBDIR=lib")
    run("cmake", "-G", "Ninja", "-S", source.folder, "-B", build, *cache, environment=source.environment)
    run("cmake", "--build", build, environment=source.environment)
    for part in ("core", "app", "client"):
        run("cmake", "--install", build, "--prefix", root / "usr", "--component", part)


def _control(root: Path, source: Source) -> None:
    kilobytes = sum(path.stat().st_size for path in root.rglob("*") if path.is_file()) // 1024
    text = CONTROL.format(version=source.version, architecture=ARCHITECTURE, kilobytes=kilobytes)
    _write(root / "DEBIAN/control", text)


def _write(path: Path, text: str) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return path


def _compressed(path: Path) -> None:
    path.with_name(path.name + ".gz").write_bytes(gzip.compress(path.read_bytes(), compresslevel=9, mtime=0))
    path.unlink()
