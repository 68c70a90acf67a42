"""Brace in somebody else's CMake project: by find_package, add_subdirectory and FetchContent, on six machines."""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterator, Sequence
from pathlib import Path

import pytest
from targets import (
    EXAMPLES,
    PROJECT,
    REFERENCE_K,
    TARGETS,
    TOLERANCE_N_PER_MM,
    Target,
    children_cpu_s,
    k_values,
    output_of,
)

CORE = PROJECT / "firmware" / "core"
PROGRAM = EXAMPLES / "your_cmake"
BUILDS_S = 120.0  # all six machines together, in processor time
HOST = TARGETS[0]
PRESET_OF = {HOST.name: "host"}  # of the others each has a preset of its name, or none


def configured(source: Path, build: Path, target: Target, *more: str) -> Path:
    """A build folder, built."""
    compiler = [f"-DCMAKE_C_COMPILER={target.compiler}"]
    if target.toolchain:
        compiler = [f"-DCMAKE_TOOLCHAIN_FILE={PROJECT / target.toolchain}"]
    output_of("cmake", "-G", "Ninja", "-S", source, "-B", build, *compiler, *more)
    output_of("cmake", "--build", build)
    return build


def check_k(target: Target, program: Path) -> None:
    assert k_values(target.run(program)) == [pytest.approx(REFERENCE_K, abs=TOLERANCE_N_PER_MM)]


@pytest.fixture(scope="module", autouse=True)
def in_time() -> Iterator[None]:
    """All builds of this file."""
    before_s = children_cpu_s()
    yield
    assert children_cpu_s() - before_s < BUILDS_S


def install_core(target: Target, folder: Path) -> None:
    """From the preset's own build folder, where ./dev has built it by the same commands; else built alone."""
    built = PROJECT / "build" / PRESET_OF.get(target.name, target.name)
    core = built if (built / "build.ninja").is_file() else configured(CORE, folder / "core", target)
    output_of("cmake", "--install", core, "--component", "core", "--prefix", folder / "first")
    shutil.rmtree(folder / "core", ignore_errors=True)


@pytest.mark.parametrize("target", TARGETS, ids=lambda target: target.name)
def test_find_package(target: Target, tmp_path: Path) -> None:
    """The core alone is built by Clang and for RISC-V; of GCC's host and the Cortex-M it is installed as the whole has
    it."""
    target.skip_without()
    install_core(target, tmp_path)
    (tmp_path / "first").rename(tmp_path / "prefix")  # an installed tree may be moved
    build = configured(PROGRAM, tmp_path / "build", target, f"-Dbrace_DIR={tmp_path / 'prefix/lib/cmake/brace'}")
    check_k(target, build / "k")
    for text in (path.read_text() for path in (tmp_path / "prefix").rglob("*.cmake")):
        assert str(PROJECT) not in text and str(tmp_path) not in text
    if target is HOST:
        limb = PROGRAM.parent / "bare_loop"
        files: list[Path | str] = [PROGRAM / "k.c", limb / "limb.c", f"-I{limb}"]
        by_pkg_config(files, tmp_path / "prefix", "brace-core", tmp_path / "by_pkg_config")
        check_k(target, tmp_path / "by_pkg_config")
        no_such_component(tmp_path)


def by_pkg_config(files: Sequence[Path | str], prefix: Path, name: str, program: Path) -> None:
    flags = output_of("pkg-config", f"--with-path={prefix / 'lib/pkgconfig'}", "--cflags", "--libs", name).split()
    output_of("gcc", *files, *flags, "-o", program)


def no_such_component(tmp_path: Path) -> None:
    """A component that is not there stops a build with a sentence."""
    lists = "cmake_minimum_required(VERSION 3.24)\nproject(p C)\nfind_package(brace REQUIRED COMPONENTS {})\n"
    for part, words in (("client", "component client is not installed here"), ("cor", "it has core, app and client")):
        (tmp_path / part).mkdir()
        (tmp_path / part / "CMakeLists.txt").write_text(lists.format(part))
        prefix = f"-DCMAKE_PREFIX_PATH={tmp_path / 'prefix'}"
        with pytest.raises(AssertionError, match=words):
            output_of("cmake", "-S", tmp_path / part, "-B", tmp_path / part / "build", prefix)


def test_sources_taken_in(tmp_path: Path) -> None:
    """By FetchContent, built; by add_subdirectory, configured, which gives the same commands."""
    HOST.skip_without()
    source = tmp_path / "brace"
    shutil.copytree(CORE, source / "firmware" / "core")  # the core needs nothing else of the repository
    from_source = f"-DBRACE_SOURCE={source}"
    build = configured(PROGRAM, tmp_path / "build", HOST, "-DBRACE_FROM=fetch", from_source)
    check_k(HOST, build / "k")
    output_of("cmake", "--install", build, "--prefix", tmp_path / "prefix")
    assert not (tmp_path / "prefix").exists()  # it installs nothing into somebody else's package
    folder = tmp_path / "folder"
    output_of("cmake", "-G", "Ninja", "-S", PROGRAM, "-B", folder, "-DBRACE_FROM=folder", from_source)
    link = output_of("ninja", "-C", folder, "-t", "commands", "k").splitlines()[-1]
    assert re.search(r"libbrace_core\.a\s+-lm\b", link)


USER = """#include "brace/app.h"
#include "brace/app_memory.h"
#include "brace/status_text.h"
#include "brace_hal_blank.h"
static brace_app_t app;
int main(void) { return brace_app_start(&app, brace_hal_blank()) != BRACE_OK || brace_status_text(0) == 0; }
"""
USER_LISTS = """cmake_minimum_required(VERSION 3.24)
project(user LANGUAGES C)
{brace}
add_executable(user user.c {hal}/src/brace_hal_blank.c)
target_include_directories(user PRIVATE {hal}/include)
target_link_libraries(user PRIVATE brace::app)
"""
HAL = PROJECT / "hal" / "blank"


@pytest.mark.parametrize("preset", ["host", "m4f", "m3"])
def test_the_controller_as_a_package(preset: str, tmp_path: Path) -> None:
    """From the presets' own build folders: what ./dev setup has built is what would be installed."""
    built = PROJECT / "build" / preset
    if not (built / "build.ninja").is_file():
        pytest.skip(f"no build/{preset}; ./dev setup makes it")
    for part in ("core", "app", *(["client"] if preset == "host" else [])):
        output_of("cmake", "--install", built, "--prefix", tmp_path / "prefix", "--component", part)
    (tmp_path / "user.c").write_text(USER)
    (tmp_path / "CMakeLists.txt").write_text(
        USER_LISTS.format(brace="find_package(brace REQUIRED COMPONENTS app)", hal=HAL)
    )
    target = next(target for target in TARGETS if target.name.endswith({"host": "gcc"}.get(preset, preset)))
    link = ["-DCMAKE_EXE_LINKER_FLAGS=--specs=rdimon.specs"] if target.toolchain else []
    build = configured(
        tmp_path, tmp_path / "build", target, f"-Dbrace_DIR={tmp_path / 'prefix/lib/cmake/brace'}", *link
    )
    if preset == "host":
        target.run(build / "user")
        files = (tmp_path / "user.c", HAL / "src" / "brace_hal_blank.c", f"-I{HAL / 'include'}")
        by_pkg_config(files, tmp_path / "prefix", "brace-app", tmp_path / "user")


def test_the_whole_taken_in(tmp_path: Path) -> None:
    """add_subdirectory of the repository: configuring shows whether all targets are there; nothing but libraries."""
    HOST.skip_without()
    (tmp_path / "user.c").write_text(USER)
    (tmp_path / "CMakeLists.txt").write_text(
        USER_LISTS.format(brace=f"add_subdirectory({PROJECT} brace)", hal=HAL)
    )
    output_of("cmake", "-G", "Ninja", "-S", tmp_path, "-B", tmp_path / "build")
    targets = output_of("ninja", "-C", tmp_path / "build", "-t", "targets", "all")
    assert "libbrace_app.a" in targets and "libbrace_client.a" in targets
    assert "brace_host" not in targets and "print_k" not in targets and "power_cuts" not in targets
