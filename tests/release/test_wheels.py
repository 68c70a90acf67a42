"""The wheels of a release in empty environments: by each Python that is here, and by Debian's own Pythons for a 64-bit
ARM under an emulator. K and a simulated record are the same bytes everywhere; a diagnosis names the same.

$BRACE_WHEELS is a folder with wheels that were built before; without it they are built here, which takes longest.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import zipfile
from dataclasses import dataclass
from pathlib import Path

import pytest
from targets import PROJECT, output_of

sys.path.insert(0, str(PROJECT / "tools"))
from release import source  # noqa: E402
from release.python_packages import MACHINES, MANYLINUX, source_distribution, wheel  # noqa: E402

DATA = PROJECT / "tools" / "brace" / "data"
PLAY_RAD = 0.006  # README.md, "What a model lacks"
PYTHONS = ("3.10", "3.11", "3.12", "3.13", "3.14")
DEBIANS = {"bookworm": "3.11", "trixie": "3.13"}
FRAME_N_PER_MM = 2.51e-4  # half a step of the frames that carry K, 0.0005
QUICK = "3.10"  # the oldest: what a newer Python has fails there
OLDER = ("2_34", "2_31", "2_28", "2_27", "2_17")  # what a Debian 12 takes
SAME = ("k.json", "measured/data.csv", "measured/meta.toml")
EVERY_MODULE = """
import importlib, pkgutil, brace
for module in pkgutil.walk_packages(brace.__path__, "brace."):
    if not module.name.endswith("__main__"):
        try:
            importlib.import_module(module.name)
        except ModuleNotFoundError as error: # of an extra: nothing here asks for one
            if error.name.split(".")[0] == "brace":
                raise
"""


@dataclass(frozen=True)
class Place:
    """A Python into which the wheel was installed, and the variables with which it starts."""

    python: tuple[str, ...]
    variables: tuple[tuple[str, str], ...] = ()

    def run(self, folder: Path, *words: object) -> str:
        environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
        done = subprocess.run(
            [*self.python, *map(str, words)], cwd=folder, env={**environment, **dict(self.variables)}, text=True,
            capture_output=True, timeout=3000, stdin=subprocess.DEVNULL,
        )  # fmt: skip
        assert done.returncode == 0, f"{words}\n{done.stdout}{done.stderr}"
        return done.stdout

    def brace(self, folder: Path, *words: object) -> str:
        return self.run(folder, "-m", "brace", *words)


HERE = Place((sys.executable,), (("PYTHONPATH", str(PROJECT / "tools")),))


@pytest.fixture(scope="module")
def wheels(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """By machine."""
    if "BRACE_WHEELS" in os.environ:
        built = Path(os.environ["BRACE_WHEELS"])
        return {machine: next(built.glob(f"brace-*_{machine}.whl")) for machine in MACHINES}
    pytest.importorskip("build")
    pytest.importorskip("scikit_build_core")
    pytest.importorskip("auditwheel")
    if shutil.which("aarch64-linux-gnu-g++") is None:
        pytest.skip("no aarch64-linux-gnu-g++")
    work, dist = tmp_path_factory.mktemp("work"), tmp_path_factory.mktemp("dist")
    sources = source.Source(PROJECT, "0" * 40, 1_700_000_000, source.version_of(PROJECT))
    sdist = source_distribution(sources, work, dist)
    return {machine: wheel(sources, sdist, machine, work, dist) for machine in MACHINES}


def python_of(version: str) -> str | None:
    """A Python of this version: in PATH, or kept by pyenv."""
    kept = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv")) / "versions"
    found = [shutil.which(f"python{version}"), *map(str, sorted(kept.glob(f"{version}.*/bin/python3")))]
    for candidate in filter(None, found):
        if subprocess.run([candidate, "-c", "import venv"], capture_output=True, check=False).returncode == 0:
            return candidate
    return None


def installed(file: Path, version: str, folder: Path) -> Place:
    """In an environment of its own."""
    python = python_of(version)
    if python is None:
        pytest.skip(f"no Python {version}")
    output_of(python, "-m", "venv", folder)
    pip = (folder / "bin" / "python", "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-compile")
    output_of(*pip, file)
    return Place((str(folder / "bin" / "python"),))


def installed_for_arm(file: Path, suite: str, folder: Path) -> Place:
    """pip of this machine chooses what a Debian's own pip would choose; its Python runs under qemu-user."""
    if shutil.which("qemu-aarch64-static") is None:
        pytest.skip("no qemu-aarch64-static")
    fetched = subprocess.run([PROJECT / "tests/fetch/arm64-python", suite], capture_output=True, text=True, check=False)
    if fetched.returncode:
        pytest.skip(fetched.stderr.strip())
    platforms = [word for tag in OLDER for word in ("--platform", f"manylinux_{tag}_aarch64")]
    pip = (sys.executable, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-compile")
    chosen = ("--only-binary", ":all:", "--implementation", "cp", "--python-version", DEBIANS[suite], *platforms)
    output_of(*pip, "--target", folder, *chosen, file)
    root = fetched.stdout.strip()
    return Place(("qemu-aarch64-static", "-L", root, f"{root}/usr/bin/python3"), (("PYTHONPATH", str(folder)),))


def first_page(place: Place, folder: Path) -> Path:
    """README's commands."""
    folder.mkdir(parents=True)
    for name in ("paper-limb.toml", "paper-rig.toml"):
        shutil.copy(DATA / name, folder)
    limb = (folder / "paper-limb.toml").read_text()
    hidden = re.sub(r"(?m)^(\[joint\.tibia\].*)$", rf"\1\ngap_rad = {PLAY_RAD}", limb)
    assert hidden != limb
    (folder / "hidden.toml").write_text(hidden)
    posture = ("--theta1", "1.0", "--theta2", "1.4")
    (folder / "k.json").write_text(place.brace(folder, "k", "--model", "paper-limb.toml", *posture, "--json"))
    place.brace(folder, "simulate", "--model", "hidden.toml", "--rig", "paper-rig.toml", "--out", "measured")
    place.brace(folder, "diagnose", "measured", "--model", "paper-limb.toml", "--out", "found")
    return folder


@pytest.fixture(scope="module")
def expected(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return first_page(HERE, tmp_path_factory.mktemp("here") / "page")


def judge(found: Path, expected: Path) -> None:
    """The same bytes; the same verdict and names; values apart by less than a tenth of their interval."""
    for name in SAME:
        assert (found / name).read_bytes() == (expected / name).read_bytes(), name
    reports = [json.loads((folder / "found/diagnosis.json").read_text()) for folder in (found, expected)]
    assert reports[0]["verdict"] == reports[1]["verdict"] == "effect"
    named = [[(effect["name"], effect["where"]) for effect in report["effects"]] for report in reports]
    assert named[0] == named[1]
    for ours, theirs in zip(reports[0]["effects"], reports[1]["effects"], strict=True):
        for key, value in theirs["parameters"].items():
            interval = value["high"] - value["low"]
            assert ours["parameters"][key]["value"] == pytest.approx(value["value"], abs=0.1 * interval), key


def on_the_wire(place: Place, folder: Path) -> None:
    """A simulated limb of this Python is asked by the same Python."""
    command = [*place.python, "-m", "brace", "sim", "--model", "paper-limb.toml", "--can", "tcp://127.0.0.1:0"]
    environment = {**os.environ, **dict(place.variables)}
    with subprocess.Popen(
        [*command, "--seconds", "600", "--json"], cwd=folder, env=environment, stdout=subprocess.PIPE, text=True
    ) as limb:
        assert limb.stdout is not None
        try:
            can = json.loads(limb.stdout.readline())["limbs"][0]["can"]
            asked = ("query", "--bus", can, "--theta1", "1.0", "--theta2", "1.4", "--json")
            answer = json.loads(place.brace(folder, *asked))
        finally:
            limb.terminate()
    k = json.loads((folder / "k.json").read_text())
    assert answer["k_xx_n_per_mm"] == pytest.approx(k["k_xx_n_per_mm"], abs=FRAME_N_PER_MM)


def test_what_a_wheel_says_of_itself(wheels: dict[str, Path]) -> None:
    metadata = pytest.importorskip("packaging.metadata")
    for machine, path in wheels.items():
        assert path.name.endswith(f"-py3-none-{MANYLINUX}_{machine}.whl")
        with zipfile.ZipFile(path) as file:
            names = set(file.namelist())
            about = next(name for name in names if name.endswith(".dist-info/METADATA"))
            said = metadata.Metadata.from_email(file.read(about), validate=True)
            library = file.read("brace/_native/libbrace_host.so")
        assert str(said.requires_python) == ">=3.10" and said.description_content_type == "text/markdown"
        assert said.description and said.description.startswith("# Brace") and said.license_expression == "Apache-2.0"
        assert {"brace/docs/errors.md", "brace/data/paper-limb.toml"} <= names
        assert library[18] == {"x86_64": 62, "aarch64": 183}[machine]  # ELF's e_machine


@pytest.mark.parametrize(
    "version", [pytest.param(one, marks=() if one == QUICK else pytest.mark.minutes) for one in PYTHONS]
)
def test_on_x86_64(version: str, wheels: dict[str, Path], expected: Path, tmp_path: Path) -> None:
    place = installed(wheels["x86_64"], version, tmp_path / "environment")
    place.run(tmp_path, "-c", EVERY_MODULE)
    judge(first_page(place, tmp_path / "page"), expected)
    on_the_wire(place, tmp_path / "page")


@pytest.mark.minutes
@pytest.mark.parametrize("suite", DEBIANS)
def test_on_aarch64(suite: str, wheels: dict[str, Path], expected: Path, tmp_path: Path) -> None:
    place = installed_for_arm(wheels["aarch64"], suite, tmp_path / "environment")
    assert place.run(tmp_path, "-c", "import platform; print(platform.machine())") == "aarch64\n"
    judge(first_page(place, tmp_path / "page"), expected)
    on_the_wire(place, tmp_path / "page")
