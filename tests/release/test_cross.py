"""Cross-built for a robot's computer with a 64-bit ARM: the client from the top folder, run under an emulator."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from targets import PROJECT, REFERENCE_K, TARGETS, k_values, output_of

from brace.model import load_limb
from brace.params import pack

ARM = next(target for target in TARGETS if target.name == "aarch64")
LIMB = PROJECT / "tools" / "brace" / "data" / "paper-limb.toml"
PRINTED_N_PER_MM = 3e-4  # half a step of the frames, 0.0005, and half a printed digit
USER = "cmake_minimum_required(VERSION 3.24)\nproject(user C)\nfind_package(brace 0.1 REQUIRED COMPONENTS client)\n"


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The libraries and the client's programs, from the top."""
    ARM.skip_without()
    build = tmp_path_factory.mktemp("aarch64")
    toolchain = f"-DCMAKE_TOOLCHAIN_FILE={PROJECT / ARM.toolchain}"
    output_of("cmake", "-G", "Ninja", "-S", PROJECT, "-B", build, toolchain, "-DBRACE_HOST_SIM=OFF")
    output_of("cmake", "--build", build)
    return build


def test_the_client_reads_a_limb(built: Path, tmp_path: Path) -> None:
    quiet = tmp_path / "quiet.toml"  # a force sensor without noise: K under a load of nothing
    quiet.write_text(LIMB.read_text() + "\n[sensor]\nnoise_n = 0.0\n")
    ports = ("--can", "tcp://127.0.0.1:0", "--seconds", "60", "--json")
    command = [sys.executable, "-m", "brace", "sim", "--model", LIMB, "--plant", quiet, *ports]
    with subprocess.Popen(list(map(str, command)), stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        can = json.loads(process.stdout.readline())["limbs"][0]["can"]
        try:
            text = output_of(*ARM.emulator, built / "tools/client/print_k", can, "1")
        finally:
            process.terminate()
    lines = text.splitlines()
    words = lines[-1].split()
    assert len(lines) == 10
    k = [float(words[words.index(name) + 1]) for name in ("k_xx", "k_xz", "k_zz")]
    assert k == pytest.approx(REFERENCE_K, abs=PRINTED_N_PER_MM)


def test_a_package_is_of_one_processor(built: Path, tmp_path: Path) -> None:
    """What was installed for the ARM is found by a build for it, and by no build for this machine."""
    folder = "lib/aarch64-linux-gnu"
    output_of("cmake", built, f"-DCMAKE_INSTALL_LIBDIR={folder}")
    output_of("cmake", "--install", built, "--prefix", tmp_path / "prefix", "--component", "client")
    (tmp_path / "CMakeLists.txt").write_text(USER)
    arm = (f"-DCMAKE_TOOLCHAIN_FILE={PROJECT / ARM.toolchain}", f"-DCMAKE_PREFIX_PATH={tmp_path / 'prefix'}")
    output_of("cmake", "-S", tmp_path, "-B", tmp_path / "arm", *arm)
    named = f"-Dbrace_DIR={tmp_path / 'prefix' / folder / 'cmake/brace'}"
    with pytest.raises(AssertionError, match=r"version: 0\.1\.\d+ \(aarch64\)"):
        output_of("cmake", "-S", tmp_path, "-B", tmp_path / "host", named)
    flags = output_of(
        "pkg-config", f"--with-path={tmp_path / 'prefix' / folder / 'pkgconfig'}", "--libs", "brace-client"
    )
    assert f"-L{tmp_path / 'prefix' / folder}/pkgconfig/../../../{folder}" in flags


def test_the_same_digits(tmp_path: Path) -> None:
    """The program of the two-file core prints the same on both."""
    ARM.skip_without()
    output_of(sys.executable, "-I", PROJECT / "tools/release/two_files.py", "--out", tmp_path)
    make = ("make", "-s", f"CORE={tmp_path}", f"OUT={tmp_path}")
    texts = [output_of(*make, f"run-{name}", cwd=PROJECT / "examples/bare_loop") for name in ("host", "aarch64")]
    assert texts[0] == texts[1] and k_values(texts[0])


BLOCK = r"""#include <stdio.h>
#include <string.h>
#include "brace/parameters.h"
int main(void) {
    static uint8_t block[4096], again[4096];
    static brace_parameters_t parameters;
    const uint32_t length = (uint32_t)fread(block, 1, sizeof block, stdin);
    uint32_t sequence = 0;
    if (brace_parameters_unpack(block, length, &parameters, &sequence, NULL) != BRACE_OK) { return 1; }
    if (brace_parameters_pack(&parameters, sequence, again, sizeof again) != BRACE_OK) { return 2; }
    printf("%u %g %d\n", (unsigned)sequence, (double)parameters.limb.femur_mm,
           memcmp(block, again, length) == 0);
    return 0;
}
"""


def test_a_big_endian_computer_reads_a_parameter_block(tmp_path: Path) -> None:
    """An s390x stands for all of them. Its K has the same digits, too."""
    compiler, emulator = "s390x-linux-gnu-gcc", ("qemu-s390x-static", "-L", "/usr/s390x-linux-gnu")
    for tool in (compiler, emulator[0]):
        if shutil.which(tool) is None:
            pytest.skip(f"no {tool}")
    interface = PROJECT / "firmware" / "interface"
    output_of(sys.executable, "-I", PROJECT / "tools/release/two_files.py", "--out", tmp_path)
    (tmp_path / "block.c").write_text(BLOCK)
    folders = (interface / "include", interface / "generated", interface / "src", PROJECT / "firmware/core/include")
    include = [f"-I{folder}" for folder in folders]
    sources = [*(interface / "src").glob("*.c"), *(interface / "generated").glob("*.c"), tmp_path / "brace_core.c"]
    output_of(compiler, "-std=c11", "-O1", *include, tmp_path / "block.c", *sources, "-lm", "-o", tmp_path / "block")
    block = pack(load_limb(LIMB), sequence=7).content
    done = subprocess.run([*emulator, tmp_path / "block"], input=block, capture_output=True, timeout=60, check=False)
    assert done.stdout == b"7 185 1\n", done
    limb = PROJECT / "examples" / "bare_loop"
    files = (limb / "main.c", limb / "limb.c", tmp_path / "brace_core.c")
    texts = []
    for name, before in ((compiler, emulator), ("gcc", ())):
        output_of(name, "-std=c11", "-O2", f"-I{tmp_path}", f"-I{limb}", *files, "-lm", "-o", tmp_path / name)
        texts.append(output_of(*before, tmp_path / name))
    assert texts[0] == texts[1] and k_values(texts[0])
