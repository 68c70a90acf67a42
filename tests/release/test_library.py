"""The folder that other build systems take: by those of their tools that can be had here, or by stand-ins for their
CMake functions. What ESP-IDF and Zephyr themselves would build needs toolchains of their own servers. PlatformIO builds
with this machine's compiler, and with the SCons of pip instead of its server's."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
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
# A platform of PlatformIO for this machine's compiler.
PLATFORM = {
    "platform.json": '{"name": "here", "version": "1.0.0", "title": "this machine", "description": "its compiler", '
                     '"packages": {}}',
    "platform.py": "from platformio.public import PlatformBase\nclass HerePlatform(PlatformBase):\n    pass\n",
    "builder/main.py": "from SCons.Script import Default, DefaultEnvironment\nenv = DefaultEnvironment()\n"
                       "env.Replace(PROGNAME='program', CC='gcc', AR='gcc-ar', RANLIB='gcc-ranlib', LIBPATH=[])\n"
                       "Default([env.BuildProgram()])\n",
}  # fmt: skip
PROJECT_INI = "[env:here]\nplatform = symlink://{platform}\nlib_deps = file://{packed}\n" \
              "build_flags = -Wall -Wextra -Werror -lm\n"  # fmt: skip


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


def packed_by_platformio(pio: str, library: Path, folder: Path) -> Path:
    packed, tar = folder / "library", folder / "packed.tar.gz"
    shutil.copytree(library, packed)
    manifest = json.loads((packed / "library.json").read_text())
    assert manifest.pop("license") == "Apache-2.0"  # pio asks a server for the names of licences
    (packed / "library.json").write_text(json.dumps(manifest))
    output_of(pio, "pkg", "pack", packed, "-o", tar)
    return tar


def offline_core(pio: str, core: Path) -> None:
    """A PlatformIO whose server was asked before: it has its SCons, which is that of pip."""
    python = Path(pio).parent / "python"
    asked = "from platformio.dependencies import get_core_dependencies as d; import SCons; print(d()['tool-scons'][1:])"
    done = subprocess.run([python, "-c", asked], capture_output=True, text=True, check=False)
    if done.returncode:
        pytest.skip("no SCons for PlatformIO: pip install scons beside it")
    scons = core / "packages/tool-scons"
    scons.mkdir(parents=True)
    about = {"name": "tool-scons", "version": done.stdout.strip()}
    (scons / "package.json").write_text(json.dumps(about))
    spec = {"owner": "platformio", "id": 1, "name": "tool-scons", "requirements": None, "uri": None}
    (scons / ".piopm").write_text(json.dumps({**about, "type": "tool", "spec": spec}))
    (scons / "scons.py").write_text("from SCons.Script import main\nmain()\n")


def test_platformio_packs_and_builds_it(library: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pio, platform, project = tool("pio"), tmp_path / "here", tmp_path / "project"
    monkeypatch.setenv("PLATFORMIO_CORE_DIR", str(tmp_path / "core"))
    monkeypatch.setenv("PLATFORMIO_SETTING_ENABLE_TELEMETRY", "no")
    packed = packed_by_platformio(pio, library, tmp_path)
    with tarfile.open(packed) as tar:
        assert {"library.json", "src/brace_core.c", "src/brace_core.h", "examples/k/limb.c"} <= set(tar.getnames())
    offline_core(pio, tmp_path / "core")
    for name, text in PLATFORM.items():
        (platform / name).parent.mkdir(parents=True, exist_ok=True)
        (platform / name).write_text(text)
    (project / "src").mkdir(parents=True)
    for file in (EXAMPLES / "your_cmake/k.c", *(EXAMPLES / "bare_loop").glob("limb.[ch]")):
        shutil.copy(file, project / "src")
    (project / "platformio.ini").write_text(PROJECT_INI.format(platform=platform, packed=packed))
    output_of(pio, "run", "-d", project)
    said = output_of(project / ".pio/build/here/program")
    assert k_values(said) == [pytest.approx(REFERENCE_K, abs=TOLERANCE_N_PER_MM)]


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
