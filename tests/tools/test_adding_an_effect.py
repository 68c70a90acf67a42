"""The worked example of docs/adding.md, done for real: a throw-away effect is added to a copy of the project, in at most
four files written by hand, and the copy's simulator shows it and the copy's diagnosis finds it."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

PROJECT = Path(__file__).resolve().parents[2]
MOST_FILES = 4
LEFT_BEHIND = ("build", ".git", ".venv", ".cache", "__pycache__", ".pytest_cache", ".mypy_cache")
TRUE_RATIO = -0.3

DICTIONARY_ENTRY = """[[group.entry]]
name = "one_sided_ratio"
register = [228, 230, 232]
table = "joint.*"
unit = ""
range = [-0.9, 5.0]
default = 0.0
description = "how much stiffer the spring at @ is for deflections above zero, of itself"

"""

LAW = """// A joint's spring that is stiffer, or softer, for deflections above zero.
#pragma once

#include "effects/effect.h"

namespace brace::effects::one_sided_spring {

// What the spring's torque is multiplied by. Torque and deflection have the same sign, so either may be given.
inline double factor(double one_sided_ratio, double deflection_or_torque)
{
    return deflection_or_torque > 0.0 ? 1.0 + one_sided_ratio : 1.0;
}

} // namespace brace::effects::one_sided_spring
"""

ROW = '''    Effect(
        "one_sided_spring",
        JOINTS,
        words="a one-sided spring",
        meaning="the joint is stiffer or softer for deflections above zero",
        law="torque = spring torque * (1 + ratio) for deflections above zero",
        told_by="another slope for each sign of the load",
        numbers=(Number("one_sided_ratio", 0.1, between(-0.8, 3.0), tried_at(-0.3, 0.3)),),
        ways=(Way(("one_sided_ratio",)),),
        joint_test=InJointTest(
            turns=lambda size: (Turn("one_sided_ratio", 0.1),),
            starts=lambda size: ({"one_sided_ratio": 0.2}, {"one_sided_ratio": -0.2}),
        ),
    ),
'''


def dictionary(text: str) -> str:
    """The number's home: unit, range, default, meaning."""
    before = '[[group.entry]]\nname = "friction_n_mm"\n'
    return swapped(text, before, DICTIONARY_ENTRY + before)


def joint_law(text: str) -> str:
    """The simulated joint's spring asks the law."""
    text = swapped(text, '#include "effects/joint_hardening.h"\n',
                   '#include "effects/joint_hardening.h"\n#include "effects/one_sided_spring.h"\n')  # fmt: skip
    text = swapped(text, "!effects::joint_hardening::acts(law);",
                   "!effects::joint_hardening::acts(law)\n           && law.one_sided_ratio == 0.0;")  # fmt: skip
    text = swapped(
        text,
        "    return effects::joint_compliance::torque_n_mm(law, elastic) + "
        "effects::joint_hardening::torque_n_mm(law, elastic);\n",
        "    return effects::one_sided_spring::factor(law.one_sided_ratio, elastic)\n"
        "           * (effects::joint_compliance::torque_n_mm(law, elastic)\n"
        "              + effects::joint_hardening::torque_n_mm(law, elastic));\n",
    )
    text = swapped(
        text,
        "    return effects::joint_compliance::stiffness_n_mm_per_rad(law)\n"
        "           + effects::joint_hardening::stiffness_n_mm_per_rad(law, elastic_rad(law, deflection_rad));\n",
        "    const double elastic = elastic_rad(law, deflection_rad);\n"
        "    return effects::one_sided_spring::factor(law.one_sided_ratio, elastic)\n"
        "           * (effects::joint_compliance::stiffness_n_mm_per_rad(law)\n"
        "              + effects::joint_hardening::stiffness_n_mm_per_rad(law, elastic));\n",
    )
    return swapped(
        text,
        "    return effects::joint_hardening::deflection_rad(law, torque_n_mm);\n",
        "    torque_n_mm /= effects::one_sided_spring::factor(law.one_sided_ratio, torque_n_mm);\n"
        "    return effects::joint_hardening::deflection_rad(law, torque_n_mm);\n",
    )


def catalogue(text: str) -> str:
    """The row of which the diagnosis, the report and the words follow."""
    before = '    Effect(\n        "creep",\n'
    return swapped(text, before, ROW + before)


WRITTEN: dict[str, Callable[[str], str]] = {
    "firmware/interface/dictionary.toml": dictionary,
    "host_sim/effects/one_sided_spring.h": lambda _: LAW,
    "host_sim/plant/joint_law.h": joint_law,
    "tools/brace/effects/catalogue.py": catalogue,
}

COPY_FIRST = Path(__file__).resolve().parent / "copy_first"


def swapped(text: str, old: str, new: str) -> str:
    assert text.count(old) == 1, f"the worked example expects this once:\n{old}"
    return text.replace(old, new)


def run(command: list[str], folder: Path) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "PYTHONPATH": f"{folder / 'tools'}:{COPY_FIRST}"}  # the copy before the project
    environment |= {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}  # small matrices: threads only wait
    environment.pop("BRACE_LIBRARY", None)
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, f"{' '.join(command)}\n{done.stdout[-3000:]}\n{done.stderr[-3000:]}"
    return done


def files_of(folder: Path) -> dict[str, bytes]:
    """Every source of the project, by its path."""
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file() and not set(path.relative_to(folder).parts) & set(LEFT_BEHIND)
    }


OF_LIBRARY = re.compile(r"(host_sim/CMakeFiles/brace_host_sim|firmware/(core|interface)/CMakeFiles/\w+)\.dir/.*\.o$")


# Compiling it takes as long as a third of all others, and nothing here asks for the reference under load.
LEFT_OUT = "host_sim/CMakeFiles/brace_host_sim.dir/api/reference_loaded.cpp.o"


def stand_in(left_out: Path, folder: Path) -> Path:
    """An object with the same functions; whoever calls one ends there."""
    told = run(["nm", "--defined-only", "--extern-only", str(left_out)], folder).stdout
    source = folder / "stand_in.c"
    names = re.findall(r" T (brace_\w+)$", told, re.M)
    source.write_text("".join(f"void {name}(void) {{ __builtin_trap(); }}\n" for name in names))
    run(["cc", "-c", "-fPIC", str(source), "-o", str(source.with_suffix(".o"))], folder)
    return source.with_suffix(".o")


def objects(folder: Path, changed: set[str]) -> list[Path]:
    """What the copy's library is linked of. An object that knows no changed file is the project's own; the others are
    compiled in the copy, but the one that is left out."""
    ours, build = PROJECT / "build" / "host", folder / "build" / "host"
    targets = run(["ninja", "-C", str(build), "-t", "targets", "all"], folder).stdout.splitlines()
    wanted = [name for name in (line.split(":")[0] for line in targets) if OF_LIBRARY.match(name)]
    told = run(["ninja", "-C", str(ours), "-t", "deps"], PROJECT).stdout
    includes = dict(part.split(":", 1) for part in told.split("\n\n") if ":" in part)
    wanted.remove(LEFT_OUT)
    stale = [name for name in wanted if any(f"/{file}\n" in includes[name] + "\n" for file in changed)]
    run(["cmake", "--build", str(build), "--target", *stale], folder)
    parts = [(build if name in stale else ours) / name for name in wanted]
    return [*parts, stand_in(ours / LEFT_OUT, folder / "build")]


@dataclass(frozen=True)
class Extended:
    """A copy of the project with the effect in it, and the files there that the generator wrote anew."""

    folder: Path
    generated: set[str]


@pytest.fixture(scope="module")
def extended(tmp_path_factory: pytest.TempPathFactory) -> Extended:
    """The copy, generated and built as far as simulating and diagnosing need it: the controller is left out."""
    if shutil.which("cmake") is None or shutil.which("ninja") is None:
        pytest.skip("no cmake or ninja: the copy cannot be built")
    folder = tmp_path_factory.mktemp("extended") / "project"
    shutil.copytree(PROJECT, folder, ignore=shutil.ignore_patterns(*LEFT_BEHIND, "*.egg-info"), symlinks=True)
    for name, change in WRITTEN.items():
        path = folder / name
        path.write_text(change(path.read_text() if path.is_file() else ""))
    told = run([sys.executable, "-m", "interface"], folder / "tools").stderr
    build = folder / "build" / "host"
    run(["cmake", "-S", ".", "-B", str(build), "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release"], folder)
    generated = {line.removeprefix("wrote ") for line in told.splitlines()}
    parts = objects(folder, {*WRITTEN, *generated})
    run(["c++", "-shared", "-o", str(build / "libbrace_host.so"), *map(str, parts)], folder)
    return Extended(folder, generated)


def test_four_files_are_written_and_the_rest_is_generated(extended: Extended) -> None:
    before, after = files_of(PROJECT), files_of(extended.folder)
    touched = {name for name in after if after[name] != before.get(name)}
    print("written by hand:", *sorted(WRITTEN), "generated:", *sorted(extended.generated), sep="\n  ")
    assert len(WRITTEN) <= MOST_FILES and touched == set(WRITTEN) | extended.generated
    assert "host_sim/api/brace_plant_model.h" in extended.generated


def brace(folder: Path, *arguments: object) -> Any:
    return json.loads(run([sys.executable, "-m", "brace", *map(str, arguments), "--json"], folder).stdout)


def limbs(folder: Path, extra: str) -> tuple[Path, Path]:
    """The believed limb, and the true one that has the effect as well."""
    believed = (PROJECT / "tools" / "brace" / "data" / "paper-limb.toml").read_text()
    (folder / "believed.toml").write_text(believed)
    lines = believed.splitlines(keepends=True)
    place = next(number for number, line in enumerate(lines) if line.startswith("[joint.tibia]"))
    (folder / "true.toml").write_text("".join([*lines[: place + 1], extra, *lines[place + 1 :]]))
    return folder / "believed.toml", folder / "true.toml"


def the_one_effect(found: Any) -> dict[str, Any]:
    assert found["verdict"] == "effect", found["sentence"]
    assert [effect["name"] for effect in found["effects"]] == ["one_sided_spring"], found["sentence"]
    effect: dict[str, Any] = found["effects"][0]
    assert effect["where"] == "joint.tibia"
    ratio = effect["parameters"]["joint.tibia.one_sided_ratio"]
    assert ratio["value"] == pytest.approx(TRUE_RATIO, abs=0.05)
    return effect


def test_a_loading_record_of_the_copy_shows_it_and_is_diagnosed(extended: Extended, tmp_path: Path) -> None:
    believed, true = limbs(tmp_path, f"one_sided_ratio = {TRUE_RATIO}\n")
    rig = tmp_path / "rig.toml"
    head, *configurations = (PROJECT / "tools/brace/data/paper-rig.toml").read_text().split("[[configuration]]")
    rig.write_text("[[configuration]]".join([head, *configurations[::3]]))  # four are enough here
    brace(extended.folder, "simulate", "--model", true, "--rig", rig, "--out", tmp_path / "record")
    found = brace(extended.folder, "diagnose", tmp_path / "record", "--model", believed, "--out", tmp_path / "found")
    the_one_effect(found)
    assert "a one-sided spring" in (tmp_path / "found" / "report.html").read_text().lower()


JOINT_TEST = """
import sys
from pathlib import Path
import numpy as np
from brace.model import load_limb
from brace.native.plant import JointPlayer
columns = {"t_s": np.arange(1000) * 0.02, "test": np.repeat(np.arange(4), 250).astype(np.int32)}
columns["angle_rad"] = np.tile(0.02 * np.interp(np.linspace(0, 4, 250), [0, 1, 3, 4], [0, 1, -1, 0]), 4)
np.save(sys.argv[2], JointPlayer(columns, "tibia").play(load_limb(Path(sys.argv[1]))))
np.savez(sys.argv[3], **columns)
"""


def test_a_joint_test_reads_the_same_row(extended: Extended, tmp_path: Path) -> None:
    believed, true = limbs(tmp_path, f"one_sided_ratio = {TRUE_RATIO}\n")
    torque_file, columns_file = tmp_path / "torque.npy", tmp_path / "columns.npz"
    run([sys.executable, "-c", JOINT_TEST, str(true), str(torque_file), str(columns_file)], extended.folder)
    columns = np.load(columns_file)
    torque = np.load(torque_file)
    torque = torque + 1e-3 * np.ptp(torque) * np.random.default_rng(1).standard_normal(torque.size)
    folder = tmp_path / "joint"
    folder.mkdir()
    (folder / "meta.toml").write_text('format = 1\nkind = "joint_test"\njoint = "tibia"\n')
    rows = zip(columns["t_s"], columns["angle_rad"], torque, columns["test"])
    lines = [f"{t:.2f},{angle:.9f},{read:.4f},{test}" for t, angle, read, test in rows]
    (folder / "data.csv").write_text("t_s,angle_rad,torque_n_mm,test\n" + "\n".join(lines) + "\n")
    the_one_effect(brace(extended.folder, "diagnose", folder, "--model", believed, "--out", tmp_path / "found"))
