"""brace_core.h and brace_core.c: any C11 compiler takes them, and K is docs/physics.md's on each machine."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Iterator
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

SCRIPT = PROJECT / "tools" / "release" / "two_files.py"
BUILDS_S = 120.0  # all six machines together, from nothing, in processor time


@pytest.fixture(scope="module")
def core(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("core")
    output_of(sys.executable, "-I", SCRIPT, "--out", folder)
    return folder


@pytest.fixture(scope="module", autouse=True)
def in_time() -> Iterator[None]:
    """All builds of this file."""
    before_s = children_cpu_s()
    yield
    assert children_cpu_s() - before_s < BUILDS_S


@pytest.mark.parametrize("target", TARGETS, ids=lambda target: target.name)
def test_reference_k(target: Target, core: Path, tmp_path: Path) -> None:
    target.skip_without()
    place = "host" if target.name.startswith("host") else target.name
    where = (f"CC={target.compiler}", f"CORE={core}", f"OUT={tmp_path}")
    text = output_of("make", "-s", *where, f"run-{place}", cwd=EXAMPLES / "bare_loop")
    reported = k_values(text)
    assert len(reported) == 3
    assert reported[0] == pytest.approx(REFERENCE_K, abs=TOLERANCE_N_PER_MM)


def test_same_bytes_and_nothing_of_others(core: Path, tmp_path: Path) -> None:
    output_of(sys.executable, "-I", SCRIPT, "--out", tmp_path, cwd=tmp_path)
    for name in ("brace_core.h", "brace_core.c"):
        text = (core / name).read_text()
        assert (tmp_path / name).read_text() == text
        assert '#include "' not in text.replace('#include "brace_core.h"', "")
        assert re.match(r"/\* Brace \d+\.\d+\.\d+: ", text)
        assert "SPDX-License-Identifier" + ": Apache-2.0\n" in text and str(PROJECT) not in text


def test_the_header_is_one_for_strict_c_and_for_cpp(core: Path, tmp_path: Path) -> None:
    strict = ("-std=c11", "-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Werror", "-fsyntax-only", f"-I{core}")
    output_of("gcc", *strict, core / "brace_core.c")
    (tmp_path / "user.cpp").write_text(
        '#include "brace_core.h"\n'
        "int main() { brace_pose_t pose; brace_limb_t limb = {};\n"
        "             return brace_kinematics_forward(&limb, 0, 0, &pose) ? 0 : 1; }\n"
    )
    output_of("g++", "-std=c++17", "-Wall", "-Wextra", "-Werror", "-fsyntax-only", f"-I{core}", tmp_path / "user.cpp")


def test_names_that_two_sources_share_are_kept_apart(tmp_path: Path) -> None:
    """Two sources with a static function, a type, an enumerator and a macro of the same name."""
    sys.path.insert(0, str(PROJECT / "tools"))
    from release import two_files

    source = (
        "#define LIMIT {n}\ntypedef struct {{ int value; }} pair_t;\nenum {{ STEP = LIMIT, LAST }};\n"
        "static int mean(pair_t p)\n{{\n    return p.value + STEP;\n}}\n"
        "int {name}(void) {{ pair_t p = {{.value = {n}}}; return mean(p); }}\n"
    )
    parts = [
        two_files.Part(Path(f"{name}.c"), source.format(n=n, name=name), {Path(f"{name}.c")})
        for n, name in ((1, "one"), (2, "two"))
    ]
    text = "\n".join(part for _, part in two_files._kept_apart(parts))
    main = tmp_path / "main.c"
    main.write_text(text + "\nint main(void) { return one() * 10 + two(); }\n")
    output_of("gcc", "-Werror", main, "-o", tmp_path / "main")
    assert subprocess.run([tmp_path / "main"], check=False).returncode == 24
