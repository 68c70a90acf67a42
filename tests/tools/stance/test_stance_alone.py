"""tools/stance builds alone, and a C program finds its header and library where it is installed."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

PROJECT = Path(__file__).resolve().parents[3]
PROGRAM = """#include <brace/stance.h>
#include <stdio.h>
int main(void)
{
    brace_stance_t stance = {.limb_count = 3};
    const double x_mm[] = {100.0, -50.0, -50.0}, y_mm[] = {0.0, 80.0, -80.0};
    for (int i = 0; i < 3; i++) {
        stance.limb[i] = (brace_stance_limb_t){.foot_mm = {x_mm[i], y_mm[i], 0.0}, .normal = {0.0, 0.0, 1.0},
            .k_n_per_mm = {2.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 2.0}, .friction_ratio = 0.5};
    }
    brace_stance_state_t state;
    brace_stance_load_t load = {.force_n = {0.0, 0.0, -30.0}};
    const int placed = brace_stance_place(&stance, 0, &state);
    const int settled = brace_stance_settle(&stance, &load, 8, &state, 0);
    printf("%d %d %.6f\\n", placed, settled, state.foot[0].force_n[2]);
    return 0;
}
"""


@pytest.mark.minutes  # it compiles Eigen
def test_the_statics_build_alone(tmp_path: Path) -> None:
    build, installed = tmp_path / "build", tmp_path / "installed"
    for command in (
        ["cmake", "-S", str(PROJECT / "tools/stance"), "-B", str(build), f"-DCMAKE_INSTALL_PREFIX={installed}"],
        ["cmake", "--build", str(build)],
        ["cmake", "--install", str(build)],
    ):
        subprocess.run(command, check=True, capture_output=True, timeout=300)
    (tmp_path / "program.c").write_text(PROGRAM)
    (library,) = installed.rglob("libbrace_stance.a")
    program = tmp_path / "program"
    command = ["cc", "-std=c11", f"-I{installed}/include", str(tmp_path / "program.c"), str(library), "-lstdc++", "-lm"]
    subprocess.run([*command, "-o", str(program)], check=True, timeout=60)
    said = subprocess.run([program], check=True, capture_output=True, text=True, timeout=10).stdout
    assert said == "0 0 10.000000\n"
