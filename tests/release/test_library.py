"""The folder that other build systems take: by those of their tools that can be had here, or by stand-ins for their
CMake functions. What PlatformIO, ESP-IDF and Zephyr themselves would build needs toolchains of their own servers."""

from __future__ import annotations

import json
import os
import re
import shutil
import sys
import tarfile
from pathlib import Path

import pytest
from targets import EXAMPLES, PROJECT, REFERENCE_K, TARGETS, TOLERANCE_N_PER_MM, k_values, output_of

ARM = next(target for target in TARGETS if target.name == "aarch64")
# A part of each build system: what its own function does with the sources that it is given.
ESP_IDF = """
set(ESP_PLATFORM 1)
function(idf_component_register)
    cmake_parse_arguments(arg "" "" "SRCS;INCLUDE_DIRS" ${ARGN})
    list(TRANSFORM arg_SRCS PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
    list(TRANSFORM arg_INCLUDE_DIRS PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
    add_library(core ${arg_SRCS})
    target_include_directories(core PUBLIC ${arg_INCLUDE_DIRS})
endfunction()
add_subdirectory(${LIBRARY} library)
"""
ZEPHYR = """
set(CONFIG_BRACE_CORE y)
macro(zephyr_library_named name)
    add_library(core)
endmacro()
macro(zephyr_library_sources)
    target_sources(core PRIVATE ${ARGN})
endmacro()
macro(zephyr_library_compile_options)
    target_compile_options(core PRIVATE ${ARGN})
endmacro()
macro(zephyr_include_directories)
    target_include_directories(core PUBLIC ${ARGN})
endmacro()
add_subdirectory(${LIBRARY}/zephyr library)
"""
PLAIN = "add_subdirectory(${LIBRARY} library)\nadd_library(core ALIAS brace_core)\n"
USER = "cmake_minimum_required(VERSION 3.24)\nproject(user C)\n{taken}\nadd_executable(k {k} {limb}/limb.c)\n" \
       "target_include_directories(k PRIVATE {limb})\ntarget_link_libraries(k PRIVATE core m)\n"  # fmt: skip
ARM_PROFILE = "[settings]\nos=Linux\narch=armv8\ncompiler=gcc\ncompiler.version=12\ncompiler.libcxx=libstdc++11\n" \
              "build_type=Release\n[buildenv]\nCC=aarch64-linux-gnu-gcc\n"  # fmt: skip


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("library") / "brace-core"
    output_of(sys.executable, PROJECT / "tools/release/library.py", "--out", out)
    return out


def tool(name: str) -> str:
    """Beside this Python, or in PATH."""
    found = shutil.which(name, path=f"{Path(sys.executable).parent}:{os.environ['PATH']}")
    if found is None:
        pytest.skip(f"no {name}: pip install it")
    return found


@pytest.mark.parametrize(
    "taken", [pytest.param(PLAIN, id="add_subdirectory"), pytest.param(ESP_IDF, id="ESP-IDF"),
              pytest.param(ZEPHYR, id="Zephyr")]
)  # fmt: skip
def test_taken_in(taken: str, library: Path, tmp_path: Path) -> None:
    limb = EXAMPLES / "bare_loop"
    words = {"taken": taken, "k": EXAMPLES / "your_cmake" / "k.c", "limb": limb}
    (tmp_path / "CMakeLists.txt").write_text(USER.format(**words))
    output_of("cmake", "-G", "Ninja", "-S", tmp_path, "-B", tmp_path / "build", f"-DLIBRARY={library}")
    output_of("cmake", "--build", tmp_path / "build")
    assert k_values(output_of(tmp_path / "build/k")) == [pytest.approx(REFERENCE_K, abs=TOLERANCE_N_PER_MM)]


def test_platformio_packs_it(library: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PLATFORMIO_CORE_DIR", str(tmp_path / "core"))
    monkeypatch.setenv("PLATFORMIO_SETTING_ENABLE_TELEMETRY", "no")
    packed = tmp_path / "library"
    shutil.copytree(library, packed)
    manifest = json.loads((packed / "library.json").read_text())
    assert manifest.pop("license") == "Apache-2.0"  # pio asks a server for the names of licences
    (packed / "library.json").write_text(json.dumps(manifest))
    output_of(tool("pio"), "pkg", "pack", packed, "-o", tmp_path / "packed.tar.gz")
    with tarfile.open(tmp_path / "packed.tar.gz") as tar:
        assert {"library.json", "src/brace_core.c", "src/brace_core.h", "examples/k/limb.c"} <= set(tar.getnames())


@pytest.mark.parametrize("machine", ["host", "aarch64"])
def test_conan_creates_it(machine: str, library: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CONAN_HOME", str(tmp_path / "conan"))
    conan = tool("conan")
    output_of(conan, "profile", "detect")
    profile: list[object] = []
    if machine == "aarch64":
        ARM.skip_without()
        (tmp_path / "arm").write_text(ARM_PROFILE)
        profile = ["--profile:host", tmp_path / "arm", "--profile:build", "default"]
    output_of(conan, "create", library, *profile)
    made = next((tmp_path / "conan/p/b").glob("*/p/lib/libbrace_core.a"))
    target = ARM if machine == "aarch64" else TARGETS[0]
    limb = EXAMPLES / "bare_loop"
    include = (f"-I{limb}", f"-I{made.parents[1] / 'include'}")
    output_of(
        target.compiler, EXAMPLES / "your_cmake/k.c", limb / "limb.c", *include, made, "-lm", "-o", tmp_path / "k"
    )
    assert k_values(target.run(tmp_path / "k")) == [pytest.approx(REFERENCE_K, abs=TOLERANCE_N_PER_MM)]


def test_kconfig_knows_the_switch(library: Path) -> None:
    kconfiglib = pytest.importorskip("kconfiglib")
    switches = kconfiglib.Kconfig(str(library / "zephyr/Kconfig"), warn=False).syms
    assert switches["BRACE_CORE"].type == kconfiglib.BOOL
    assert re.search(r"kconfig: zephyr/Kconfig", (library / "zephyr/module.yml").read_text())
