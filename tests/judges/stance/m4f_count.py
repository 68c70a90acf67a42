"""Instructions of the statics of six limbs on an emulated Cortex-M4F, which has no doubles in hardware.

    .venv/bin/python tests/judges/stance/m4f_count.py --seed 5 --count 100

Stances as speed.py draws them: feet that stick (friction 5) and feet that slide (0.35), from no load to weight and
payload in one implicit step. Needs libstdc++-arm-none-eabi-dev, Eigen and the bench's emulator.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TypeAlias

import numpy as np
from speed import LIMBS, _draw, _ours

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "judges" / "bench"))

from emulate import build_plugin, count  # type: ignore[import-not-found, unused-ignore] # noqa: E402
import toolchain  # type: ignore[import-not-found, unused-ignore] # noqa: E402
from toolchain import HARNESS_FLAGS, M4F, compile_source  # noqa: E402

Drawn: TypeAlias = tuple[np.ndarray, np.ndarray, np.ndarray, float]
HERE = Path(__file__).parent
STATICS = ROOT / "tools" / "stance"
EIGEN = Path("/usr/include/eigen3")
GOAL = 168_000  # 1 ms at 168 MHz


def _numbers(values: np.ndarray) -> str:
    return "{" + ", ".join(repr(float(value)) for value in np.ravel(values)) + "}"


def _limb(foot: np.ndarray, k: np.ndarray, friction: float) -> str:
    return (f"{{.foot_mm = {_numbers(foot)}, .k_n_per_mm = {_numbers(k)}, .normal = {{0.0, 0.0, 1.0}}, "
            f".friction_ratio = {friction!r}}}")  # fmt: skip


def _draws(seed: int, wanted: int, friction: float) -> list[Drawn]:
    """Those that have a rest."""
    rng = np.random.default_rng(seed)
    drawn: list[Drawn] = []
    while len(drawn) < wanted:
        one = _draw(rng, friction)
        if _ours(*one)[1] >= 0:
            drawn.append(one)
    return drawn


def _image(drawn: list[Drawn], name: str) -> Path:
    folder = toolchain.BUILD / "stance" / name
    folder.mkdir(parents=True, exist_ok=True)
    rows = ["{.limb_count = 6, .limb = {" + ", ".join(_limb(f, k, friction) for f, k in zip(feet, ks)) + "}}"
            for feet, ks, _, friction in drawn]  # fmt: skip
    offsets = [_numbers(offset) for *_, offset, _ in drawn]
    (folder / "stances.h").write_text(
        f"#define STANCES {len(drawn)}\n#define STANCE_ROWS {', '.join(rows)}\n"
        f"#define OFFSET_ROWS {', '.join(offsets)}\n"
    )
    flags = (*HARNESS_FLAGS, f"-I{folder}", f"-I{STATICS / 'include'}")
    cxx = ("-O2", "-DEIGEN_NO_MALLOC", "-DEIGEN_NO_DEBUG", f"-isystem{EIGEN}", f"-I{STATICS / 'include'}",
           "-fno-threadsafe-statics")  # fmt: skip
    bench = ROOT / "tests" / "judges" / "bench"
    sources = [(HERE / "m4f" / "stance_job.c", flags), (bench / "image" / "harness.c", HARNESS_FLAGS),
               (toolchain.BOARDS / "common" / "startup.c", HARNESS_FLAGS)]  # fmt: skip
    sources += [(path, cxx) for path in sorted((STATICS / "src").glob("*.cpp"))]
    objects = [compile_source(path, folder / f"{path.stem}.o", M4F, given) for path, given in sources]
    image: Path = toolchain.link_image(objects, folder / "statics.elf", M4F)
    return image


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--seed", type=int, required=True)
    asked = parser.parse_args()
    plugin = build_plugin()
    for name, friction in (("stick", 5.0), ("slide", 0.35)):
        drawn = _draws(asked.seed, asked.count, friction)
        counted = count(_image(drawn, name), M4F, plugin, "brace_stance_settle")
        sliding = [_ours(*one)[1] for one in drawn]
        same = [int(np.sum(row == 1.0)) == slides for row, slides in zip(counted.results, sliding)]
        each = np.array(counted.instructions)
        print(f"feet {name}: {np.median(each):,.0f} instructions, worst {each.max():,}, {np.mean(each <= GOAL):.0%} "
              f"within {GOAL:,}; as many feet slide as on x86 in {sum(same)} of {len(same)}; {np.mean(sliding):.2f} of "
              f"{LIMBS} slide")  # fmt: skip
    return 0


if __name__ == "__main__":
    sys.exit(main())
