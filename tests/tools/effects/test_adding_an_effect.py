"""The effect of docs/adding.md, done for real: joints that yield more with the square of the temperature are added to a
copy of the project, in four files written by hand and a test. The copy's simulator shows it as its law says, the copy's
own suite of all numbers passes, and without any one of the steps something fails."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

from adding_page import PROJECT, Step, steps

STEPS = steps("Adding an effect")
pytestmark = pytest.mark.skipif(any(step.is_done for step in STEPS), reason="the example stands in the project itself")
MOST_FILES = 5
LEFT_BEHIND = ("build", ".git", ".venv", ".cache", "__pycache__", ".pytest_cache", ".mypy_cache")
LONG_S = 1500.0  # for a build on a busy machine: nobody waits for ever
COPY_FIRST = Path(__file__).resolve().parent / "copy_first"


def run(command: list[str], folder: Path) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "PYTHONPATH": f"{folder / 'tools'}:{COPY_FIRST}"}  # the copy before the project
    environment |= {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}  # small matrices: threads only wait
    environment.pop("BRACE_LIBRARY", None)
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=LONG_S)
    assert done.returncode == 0, f"{' '.join(command)}\n{done.stdout[-3000:]}\n{done.stderr[-3000:]}"
    return done


def files_of(folder: Path) -> dict[str, bytes]:
    """Every source of the project, by its path."""
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file() and not set(path.relative_to(folder).parts) & set(LEFT_BEHIND)
    }


OF_LIBRARY = re.compile(
    r"(host_sim/CMakeFiles/brace_host_sim|tools/stance/CMakeFiles/brace_stance|"
    r"firmware/(core|interface)/CMakeFiles/\w+)\.dir/.*\.o$"
)


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


def unity_root() -> str:
    """The folder of unity.c that the project's own build has found."""
    lines = (PROJECT / "build/host/CMakeCache.txt").read_text().splitlines()
    (found,) = [line.partition("=")[2] for line in lines if line.startswith("UNITY_ROOT")]
    return found


@dataclass(frozen=True)
class Extended:
    """A copy of the project with the effect in it, and the files there that the generator wrote anew."""

    folder: Path
    generated: set[str]
    parts: list[Path]  # the objects of its library


@pytest.fixture(scope="module")
def extended(tmp_path_factory: pytest.TempPathFactory) -> Extended:
    """The copy, generated and built as far as simulating and diagnosing need it: the controller is left out."""
    if shutil.which("cmake") is None or shutil.which("ninja") is None:
        pytest.skip("no cmake or ninja: the copy cannot be built")
    folder = tmp_path_factory.mktemp("extended") / "project"
    shutil.copytree(PROJECT, folder, ignore=shutil.ignore_patterns(*LEFT_BEHIND, "*.egg-info"), symlinks=True)
    for step in STEPS:
        step.do(folder)
    told = run([sys.executable, "-m", "interface"], folder / "tools").stderr
    build = folder / "build" / "host"
    run(["cmake", "-S", ".", "-B", str(build), "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release"], folder)
    generated = {line.removeprefix("wrote ") for line in told.splitlines()}
    parts = objects(folder, {*(step.file for step in STEPS), *generated})
    run(["c++", "-shared", "-o", str(build / "libbrace_host.so"), *map(str, parts)], folder)
    return Extended(folder, generated, parts)


@pytest.mark.minutes
def test_five_files_are_written_and_the_rest_is_generated(extended: Extended) -> None:
    before, after = files_of(PROJECT), files_of(extended.folder)
    touched = {name for name in after if after[name] != before.get(name)}
    written = {step.file for step in STEPS}
    assert len(written) <= MOST_FILES and touched == written | extended.generated
    assert "host_sim/api/brace_plant_model.h" in extended.generated


@pytest.mark.minutes
def test_the_suite_of_all_numbers_plays_the_new_one(extended: Extended, tmp_path: Path) -> None:
    """The same suite that the project has: it reads the numbers from the generated table."""
    unity = unity_root()
    (eigen,) = [flag for flag in ("/usr/include/eigen3", "/usr/local/include/eigen3") if Path(flag).is_dir()][:1]
    suite = extended.folder / "tests/host_sim/test_every_number.cpp"
    run(["cc", "-c", "-DUNITY_INCLUDE_DOUBLE", f"{unity}/unity.c", "-o", str(tmp_path / "unity.o")], tmp_path)
    flags = ["-std=c++17", "-O1", "-DUNITY_INCLUDE_DOUBLE", "-DEIGEN_MAX_STATIC_ALIGN_BYTES=32", "-ffp-contract=off"]
    includes = [f"-I{extended.folder / 'host_sim'}", f"-isystem{eigen}", f"-I{unity}"]
    program = tmp_path / "test_every_number"
    run(["c++", *flags, *includes, str(suite), str(tmp_path / "unity.o"), *map(str, extended.parts), "-o",
         str(program)], tmp_path)  # fmt: skip
    assert "1 Tests 0 Failures" in run([str(program)], tmp_path).stdout


LAW = """
import numpy as np
from pathlib import Path
from brace.model import load_limb
from brace.native.plant import LoadingPlayer
place = [0.0, 1.0, 2.0, 1.0, 0.0, -1.0, 0.0]
rows = len(place)
columns = {"run": np.zeros(rows, np.int32), "theta1_rad": np.full(rows, 0.5), "theta2_rad": np.full(rows, 1.2),
           "t_s": np.arange(rows) * 1.0, "dx_mm": np.array(place), "dz_mm": np.zeros(rows)}
limb = load_limb(Path("tools/brace/data/paper-limb.toml"))
curved = limb.with_values({"thermal.joint_compliance_per_degc2": 0.003})
def force(model, temp_degc):
    return LoadingPlayer(columns | {"temp_degc": temp_degc + np.zeros(rows)}).play(model)["fx_n"]
for temp_degc in (12.0, 22.0, 32.0):  # at one temperature it is a limb with other springs
    factor = 1.0 + 0.003 * (temp_degc - 22.0) ** 2
    springs = {f"joint.{one}.compliance_rad_per_n_mm": factor * limb.number(f"joint.{one}.compliance_rad_per_n_mm")
               for one in ("femur", "tibia")}
    assert np.abs(force(curved, temp_degc) - force(limb.with_values(springs), temp_degc)).max() < 1e-8
changing = np.linspace(22.0, 40.0, rows)  # beside a linear rate too small to show, nothing changes
beside = curved.with_values({"thermal.joint_compliance_per_degc": 1e-12})
assert np.abs(force(curved, changing) - force(beside, changing)).max() < 1e-6
assert np.abs(force(curved, changing) - force(limb, changing)).max() > 0.1
"""


@pytest.mark.minutes
def test_the_simulated_limb_follows_the_law(extended: Extended) -> None:
    run([sys.executable, "-c", LAW], extended.folder)


@pytest.mark.minutes
def test_the_catalogue_has_its_row(extended: Extended) -> None:
    listed = run([sys.executable, "-m", "brace.effects"], extended.folder).stdout
    assert "## thermal_curve" in listed and "`thermal.joint_compliance_per_degc2`: -0.1 to 0.1 1/degC^2" in listed


def name_of(step: Step | None) -> str:
    return f"{Path(step.file).name}-{step.line[:9]}" if step else "nothing"


@pytest.fixture(scope="module")
def unity(tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    """What a test of C++ is compiled with."""
    folder, built = unity_root(), tmp_path_factory.mktemp("unity") / "unity.o"
    run(["cc", "-c", "-DUNITY_INCLUDE_DOUBLE", f"{folder}/unity.c", "-o", str(built)], built.parent)
    return ["-DUNITY_INCLUDE_DOUBLE", f"-I{folder}", str(built)]


def part_of_project(folder: Path, left_out: Step | None = None) -> Path:
    """What the law and its test need, with the effect in it but for one step."""
    for name in ("firmware/core", "firmware/interface", "host_sim", "tools/interface", "tools/brace", "docs"):
        shutil.copytree(PROJECT / name, folder / name, ignore=shutil.ignore_patterns("__pycache__"))
    (folder / "tests/host_sim").mkdir(parents=True)
    for step in STEPS:
        if step is not left_out:
            step.do(folder)
    run([sys.executable, "-m", "interface"], folder / "tools")
    return folder


def its_test_passes(project: Path, unity: list[str]) -> bool:
    """Is the page's own test of the law there, and does it pass?"""
    compiled = subprocess.run(["c++", "-std=c++17", "-Ihost_sim", "tests/host_sim/test_thermal_curve.cpp", *unity, "-o",
                               "of_law"], cwd=project, capture_output=True, check=False, timeout=LONG_S)  # fmt: skip
    return compiled.returncode == 0 and subprocess.run(project / "of_law", check=False, timeout=60).returncode == 0


@pytest.mark.parametrize("left_out", [None, *STEPS], ids=name_of)
def test_without_a_step_something_fails(left_out: Step | None, tmp_path: Path, unity: list[str]) -> None:
    project = part_of_project(tmp_path, left_out)
    # As tests/tools/effects/test_effects_page.py: every law has its row.
    row = 'Effect(\n        "thermal_curve"' in (project / "tools/brace/effects/catalogue.py").read_text()
    assert (its_test_passes(project, unity) and row) == (left_out is None)


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("* warmer_degc * warmer_degc", "* warmer_degc"),
        (" - model.thermal.reference_degc", ""),
        ("*= std::max", "/= std::max"),
        ("1.0 + model", "1.0 - model"),
    ],
)
def test_its_test_fails_for_a_wrong_law(right: str, wrong: str, tmp_path: Path, unity: list[str]) -> None:
    law = part_of_project(tmp_path) / "host_sim/effects/thermal_curve.h"
    assert law.read_text().count(right) == 1
    law.write_text(law.read_text().replace(right, wrong))
    assert not its_test_passes(tmp_path, unity)
