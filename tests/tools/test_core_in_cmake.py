"""The core in somebody else's CMake project: one line takes it in, and K is that of docs/physics.md."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

PROJECT = Path(__file__).resolve().parents[2]

LISTS = """cmake_minimum_required(VERSION 3.24)
project(somebody C)
add_subdirectory({core} core)
add_executable(k k.c)
target_link_libraries(k PRIVATE brace_core)
"""

PROGRAM = """#include <stdio.h>
#include "brace/planar.h"

int main(void)
{
    const brace_limb_t limb = {
        .femur_mm = 185.0f, .tibia_mm = 313.5f,
        .link[BRACE_FEMUR] = {.axial_mm_per_n = 0.001f, .bending_mm_per_n = 0.06f},
        .link[BRACE_TIBIA] = {.axial_mm_per_n = 0.002f, .bending_mm_per_n = 0.25f},
        .joint[BRACE_FEMUR] = {.compliance_rad_per_n_mm = 1.0e-5f},
        .joint[BRACE_TIBIA] = {.compliance_rad_per_n_mm = 1.6e-5f},
    };
    brace_planar_t planar;
    brace_stiffness_t k;
    const int failed = brace_planar_collapse(&limb, &planar) || brace_planar_stiffness(&planar, 1.0f, 1.4f, &k);
    printf("%.6f %.6f %.6f\\n", k.k_xx_n_per_mm, k.k_xz_n_per_mm, k.k_zz_n_per_mm);
    return failed;
}
"""


def test_one_line_takes_the_core_in(tmp_path: Path) -> None:
    if shutil.which("cmake") is None or shutil.which("ninja") is None:
        pytest.skip("no cmake or ninja")
    (tmp_path / "CMakeLists.txt").write_text(LISTS.format(core=PROJECT / "firmware" / "core"))
    (tmp_path / "k.c").write_text(PROGRAM)
    for command in (["cmake", "-G", "Ninja", "-S", ".", "-B", "build"], ["cmake", "--build", "build"]):
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=300)
        assert done.returncode == 0, done.stdout + done.stderr
    told = subprocess.run([tmp_path / "build" / "k"], capture_output=True, text=True, timeout=10, check=True).stdout
    assert [float(part) for part in told.split()] == pytest.approx([3.96389818, -0.63872477, 0.42806022], abs=4e-6)
