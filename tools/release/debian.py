"""The Debian packages of the C libraries, one for each architecture: core, controller, client, headers, man pages.

They depend on no Python. The `brace` command is a Python package: pip or pipx installs it.
"""

from __future__ import annotations

import gzip
import shutil
from pathlib import Path

from release import man_pages
from release.about import about
from release.python_packages import MACHINES
from release.source import Source, fresh, run, set_times

PACKAGE = "libbrace-dev"
ARCHITECTURES = {"x86_64": "amd64", "aarch64": "arm64"}
PARTS = ("core", "app", "client")
CONTROL = """Package: {package}
Source: brace
Version: {version}
Architecture: {architecture}
Multi-Arch: same
Maintainer: {author} <{email}>
Homepage: {homepage}
Installed-Size: {kilobytes}
Recommends: libc6-dev
Suggests: cmake, pkgconf, libmodbus-dev, can-utils
Section: libdevel
Priority: optional
Description: stiffness at the tip of a climbing robot's limb, C libraries
 The libraries brace-core and brace-app compute the stiffness of a limb in
 programs and controllers of your own; brace-client reads it from a limb's
 controller over CAN and Modbus. The command brace, to which the man pages
 belong, is a Python package: pipx install brace.
"""
COPYRIGHT = """Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: Brace

Files: *
Copyright: 2026 {author}
License: Apache-2.0
 On Debian systems the text is in /usr/share/common-licenses/Apache-2.0.
"""


def package(source: Source, machine: str, work: Path, dist: Path) -> Path:
    """libbrace-dev_<version>_<architecture>.deb"""
    root = fresh(work / f"debian-{machine}")
    _libraries(source, machine, work / f"libraries-{machine}", root / "usr")
    man_pages.write(root / "usr/share/man/man1", source.version)
    for page in sorted((root / "usr/share/man/man1").iterdir()):
        _compressed(page)
    _documents(source, root / "usr/share/doc" / PACKAGE)
    _control(root, source, machine)
    set_times(root, source.epoch_s)
    out = dist / f"{PACKAGE}_{source.version}_{ARCHITECTURES[machine]}.deb"
    # xz, because Debian's dpkg reads zstd only from Debian 12 on, and a Jetson's Ubuntu is older
    build = ("dpkg-deb", "--root-owner-group", "-Zxz", "-z9", "--threads-max=1", "--build", root, out)
    run(*build, environment=source.environment)
    return out


def _documents(source: Source, folder: Path) -> None:
    """What a person reads, and programs to begin with."""
    _write(folder / "copyright", COPYRIGHT.format(author=about(source.folder).author))
    _compressed(_write(folder / "changelog", (source.folder / "CHANGELOG.md").read_text()))
    shutil.copytree(source.folder / "examples", folder / "examples")
    shutil.copytree(source.folder / "docs", folder / "docs", ignore=shutil.ignore_patterns("*.json", "*.toml"))


def _libraries(source: Source, machine: str, build: Path, prefix: Path) -> None:
    """The C libraries and their packages for CMake and pkg-config, in the folder of the architecture."""
    cache = ["-DCMAKE_BUILD_TYPE=Release", "-DBRACE_TESTS=OFF", "-DBRACE_HOST_SIM=OFF"]
    cache.append(f"-DCMAKE_INSTALL_LIBDIR=lib/{machine}-linux-gnu")
    environment = dict(source.environment)
    if MACHINES[machine]:
        cache.append(f"-DCMAKE_TOOLCHAIN_FILE={source.folder / MACHINES[machine]}")
        # A static library links nothing, and the headers of libmodbus are the same for every architecture.
        environment["PKG_CONFIG_LIBDIR"] = run("pkg-config", "--variable", "pc_path", "pkg-config").strip()
    run("cmake", "-G", "Ninja", "-S", source.folder, "-B", build, *cache, environment=environment)
    libraries = ("brace_app", "brace_hal_selftest", "brace_hal_dynamixel", "brace_client")  # app needs the core's
    run("cmake", "--build", build, "--target", *libraries, environment=environment)
    for part in PARTS:
        run("cmake", "--install", build, "--prefix", prefix, "--component", part)


def _control(root: Path, source: Source, machine: str) -> None:
    kilobytes = sum(path.stat().st_size for path in root.rglob("*") if path.is_file()) // 1024
    ours = about(source.folder)
    text = CONTROL.format(
        package=PACKAGE, version=source.version, architecture=ARCHITECTURES[machine], kilobytes=kilobytes,
        author=ours.author, email=ours.email, homepage=ours.urls["Homepage"],
    )  # fmt: skip
    _write(root / "DEBIAN/control", text)


def _write(path: Path, text: str) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return path


def _compressed(path: Path) -> None:
    path.with_name(path.name + ".gz").write_bytes(gzip.compress(path.read_bytes(), compresslevel=9, mtime=0))
    path.unlink()
