"""brace_core.h and brace_core.c under a project's own flags: K is right, or the file does not compile and says why."""

from __future__ import annotations

import math
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from targets import PROJECT, output_of

SCRIPT = PROJECT / "tools" / "release" / "two_files.py"
ACCURACY = 2e-6  # brace/planar.h: of lambda_max
FEMUR_MM, TIBIA_MM = 185.0, 313.5
AXIAL_MM_PER_N, BENDING_MM_PER_N = (0.001, 0.002), (0.06, 0.25)
JOINT_RAD_PER_N_MM = (1.0e-5, 1.6e-5)
STRICT = ("-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wsign-conversion", "-Wshadow", "-Wdouble-promotion",
          "-Wundef", "-Wcast-qual", "-Wcast-align", "-Wformat=2", "-Wvla", "-Wwrite-strings", "-Wredundant-decls",
          "-Wmissing-declarations", "-Wnull-dereference", "-Werror")  # fmt: skip
OF_C = ("-Wstrict-prototypes", "-Wmissing-prototypes", "-Wold-style-definition")
OF_CPP = ("-Wold-style-cast", "-Wzero-as-null-pointer-constant", "-Wnon-virtual-dtor")

# Prints K over the knee's whole turn, then the answers to what is not finite. Numbers come in as bits, so that the
# compiler knows none of them.
SWEEP = """
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include "brace_core.h"
static float of_bits(uint32_t bits) {
    volatile uint32_t hidden = bits;
    uint32_t seen = hidden;
    float value;
    memcpy(&value, &seen, sizeof value);
    return value;
}
int main(void) {
    static const uint32_t not_finite[] = {0x7fc00000u, 0xffc00000u, 0x7f800001u, 0x7f800000u, 0xff800000u};
    static brace_limb_t limb;
    static brace_planar_t planar;
    static brace_stiffness_t k;
    limb.femur_mm = 185.0f;
    limb.tibia_mm = 313.5f;
    limb.link[BRACE_FEMUR].axial_mm_per_n = 0.001f;
    limb.link[BRACE_FEMUR].bending_mm_per_n = 0.06f;
    limb.link[BRACE_TIBIA].axial_mm_per_n = 0.002f;
    limb.link[BRACE_TIBIA].bending_mm_per_n = 0.25f;
    limb.joint[BRACE_FEMUR].compliance_rad_per_n_mm = 1.0e-5f;
    limb.joint[BRACE_TIBIA].compliance_rad_per_n_mm = 1.6e-5f;
    if (brace_limb_check(&limb) != BRACE_OK || brace_planar_collapse(&limb, &planar) != BRACE_OK) {
        return 1;
    }
    for (int i = -12; i <= 12; i++) {
        for (int j = -12; j <= 12; j++) {
            const float theta1_rad = (float)i * 0.25f, theta2_rad = (float)j * 0.25f + 0.03f;
            if (brace_planar_stiffness(&planar, theta1_rad, theta2_rad, &k) != BRACE_OK) {
                return 2;
            }
            printf("%.9g %.9g %.9g %.9g %.9g\\n", theta1_rad, theta2_rad, k.k_xx_n_per_mm, k.k_xz_n_per_mm,
                   k.k_zz_n_per_mm);
        }
    }
    for (int i = 0; i < 5; i++) {
        const float bad = of_bits(not_finite[i]);
        brace_limb_t broken = limb;
        broken.femur_mm = bad;
        brace_pose_t pose;
        printf("refused %d %d %d %d\\n", brace_planar_stiffness(&planar, bad, 0.5f, &k),
               brace_planar_stiffness(&planar, 0.5f, bad, &k), brace_limb_check(&broken),
               brace_kinematics_forward(&limb, bad, 0.5f, &pose));
    }
    return 0;
}
"""
LOOSE = {
    "no optimisation": ("-O0",),
    "most optimisation": ("-O3",),
    "for size": ("-Os",),
    "across files": ("-O2", "-flto"),
    "fused products": ("-O3", "-mfma", "-ffp-contract=fast"),
    "PX4": ("-O2", "-funsafe-math-optimizations"),
    "PX4 across files": ("-O3", "-flto", "-funsafe-math-optimizations"),
    "reassociated": ("-O3", "-fassociative-math", "-fno-signed-zeros", "-fno-trapping-math"),
    "reciprocals": ("-O2", "-freciprocal-math"),
    "fast, taken back": ("-Ofast", "-ffast-math", "-fno-fast-math"),
}
SHORT = ("PX4", "reassociated", "fast, taken back")
REFUSED = {"fast": ("-O2", "-ffast-math"), "Ofast": ("-Ofast",), "finite": ("-O2", "-ffinite-math-only")}


@pytest.fixture(scope="module")
def core(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("core")
    output_of(sys.executable, "-I", SCRIPT, "--out", folder)
    (folder / "sweep.c").write_text(SWEEP)
    return folder


def _compiler(name: str) -> str:
    if shutil.which(name) is None:
        pytest.skip(f"no {name}")
    return name


def _k_by_hand(theta1_rad: float, theta2_rad: float) -> np.ndarray:
    """docs/physics.md's sum: levers of the joints, axes of the links; double precision."""
    along = [np.array([math.cos(a), math.sin(a)]) for a in (theta1_rad, theta1_rad - theta2_rad)]
    turned = np.array([[0.0, -1.0], [1.0, 0.0]])
    arms = [FEMUR_MM * along[0] + TIBIA_MM * along[1], TIBIA_MM * along[1]]
    c = sum(s * np.outer(turned @ arm, turned @ arm) for s, arm in zip(JOINT_RAD_PER_N_MM, arms, strict=True))
    for axis, axial, bending in zip(along, AXIAL_MM_PER_N, BENDING_MM_PER_N, strict=True):
        c = c + axial * np.outer(axis, axis) + bending * np.outer(turned @ axis, turned @ axis)
    return np.asarray(np.linalg.inv(c))


@pytest.mark.parametrize("compiler", ["gcc", "clang"])
@pytest.mark.parametrize(
    "flags", [pytest.param(f, id=n, marks=() if n in SHORT else pytest.mark.minutes) for n, f in LOOSE.items()]
)
def test_k_is_right_under_a_projects_flags(compiler: str, flags: tuple[str, ...], core: Path, tmp_path: Path) -> None:
    """Without the barrier, clang's reassociation makes K wrong by 94 lambda_max at every posture."""
    if "-mfma" in flags and "fma" not in Path("/proc/cpuinfo").read_text().split():
        pytest.skip("this processor has no fma")
    program = tmp_path / "sweep"
    output_of(_compiler(compiler), "-std=c11", *flags, f"-I{core}", core / "sweep.c", core / "brace_core.c",
              "-lm", "-o", program)  # fmt: skip
    lines = output_of(program).splitlines()
    rows = [[float(value) for value in line.split()] for line in lines if not line.startswith("refused")]
    assert len(rows) == 625
    for theta1_rad, theta2_rad, xx, xz, zz in rows:
        right = _k_by_hand(theta1_rad, theta2_rad)
        told = np.array([[xx, xz], [xz, zz]])
        assert np.abs(told - right).max() <= ACCURACY * np.linalg.eigvalsh(right)[1], (theta1_rad, theta2_rad)
    assert [line for line in lines if line.startswith("refused")] == ["refused -2 -2 -2 -2"] * 5


@pytest.mark.parametrize("compiler", ["gcc", "clang", "arm-none-eabi-gcc"])
@pytest.mark.parametrize("flags", REFUSED.values(), ids=REFUSED.keys())
def test_what_takes_nan_away_does_not_compile(compiler: str, flags: tuple[str, ...], core: Path) -> None:
    done = subprocess.run(
        [_compiler(compiler), "-std=c11", *flags, "-fsyntax-only", core / "brace_core.c"],
        capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip
    assert done.returncode != 0
    assert "-fno-fast-math" in done.stderr and "NaN" in done.stderr


@pytest.mark.parametrize("compiler", ["gcc", "clang"])
@pytest.mark.parametrize("standard", ["c11", "gnu17", "c2x"])
def test_source_without_a_warning(compiler: str, standard: str, core: Path) -> None:
    output_of(_compiler(compiler), f"-std={standard}", "-O2", *STRICT, *OF_C, "-c", core / "brace_core.c",
              "-o", "/dev/null")  # fmt: skip


@pytest.mark.parametrize("compiler", ["g++", "clang++"])
@pytest.mark.parametrize("standard", ["c++98", "c++11", "c++14", "c++17", "c++20", "c++2b"])
def test_header_in_cpp_without_a_warning(compiler: str, standard: str, core: Path, tmp_path: Path) -> None:
    user = tmp_path / "user.cpp"
    user.write_text(
        '#include "brace_core.h"\n'
        "int main() { brace_pose_t pose; static brace_limb_t limb;\n"
        "             return brace_kinematics_forward(&limb, 0, 0, &pose) ? 0 : 1; }\n"
    )
    output_of(_compiler(compiler), f"-std={standard}", *STRICT, *OF_CPP, "-fsyntax-only", f"-I{core}", user)


def test_source_refuses_to_be_cpp(core: Path) -> None:
    done = subprocess.run(["g++", "-x", "c++", "-fsyntax-only", core / "brace_core.c"],
                          capture_output=True, text=True, timeout=60, check=False)  # fmt: skip
    assert done.returncode != 0 and "brace_core.c is C" in done.stderr
