"""Gets what the bench needs and the repository must not hold: peers' sources and the emulator's plugin header.

Everything goes to .cache/bench through the ordinary package clients (apt, pip) and is checked against the
checksums below; a second run finds it there.
"""

import hashlib
import shutil
import subprocess
import sys
import tarfile
from collections.abc import Callable, Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
CACHE = ROOT / ".cache" / "bench"

CASADI = "casadi==3.8.2"
CASADI_SHA256 = "118df1a9ae944a80989849ea5cfa76c20b28e95d6f568c9f989e8c16a66ab1db"
CMSIS_DSP = "cmsisdsp==1.10.3"
CMSIS_DSP_SHA256 = "307d32298faa7c58db912851027fce35f886fec7eb1a27c4b309ce1a97f47519"
PLUGIN_HEADER_SHA256 = "19f277b037d05a8bcb5069f2f81a465d177208e5903048a915c56627d4c3748e"


class Missing(Exception):
    """Something the bench needs cannot be had here; the text says what and what to try."""


def _run(command: Sequence[str | Path], what: str, cwd: Path | None = None) -> None:
    try:
        done = subprocess.run(command, cwd=cwd, capture_output=True, text=True, check=False)
    except FileNotFoundError as error:
        raise Missing(f"{what}: no program '{command[0]}'") from error
    if done.returncode != 0:
        last = (done.stderr.strip() or done.stdout.strip() or "no message").splitlines()[-1]
        raise Missing(f"{what}: '{command[0]}' failed; last words: {last}")


def _checked(file: Path, sha256: str) -> Path:
    found = hashlib.sha256(file.read_bytes()).hexdigest()
    if found != sha256:
        raise Missing(f"{file.name}: not the file this bench was made with (sha256 {found})")
    return file


def _into(directory: Path, make: Callable[[Path], None]) -> Path:
    """directory, filled by make(part) first if it is not there; half-made folders never stay."""
    if not directory.is_dir():
        part = directory.with_suffix(".part")
        shutil.rmtree(part, ignore_errors=True)
        part.mkdir(parents=True)
        make(part)
        part.rename(directory)
    return directory


def _only_file(directory: Path, pattern: str) -> Path:
    files = sorted(directory.glob(pattern))
    if len(files) != 1:
        raise Missing(f"{directory.name}: expected one {pattern}, found {len(files)}")
    return files[0]


def casadi() -> Path:
    """Folder to put on PYTHONPATH for `import casadi` [about 90 MB]."""
    def make(part: Path) -> None:
        pip = [sys.executable, "-m", "pip", "--disable-pip-version-check", "--quiet"]
        wheels = part / "wheel"
        _run([*pip, "download", "--no-deps", "--only-binary", ":all:", "--dest", wheels, CASADI], "CasADi")
        wheel = _checked(_only_file(wheels, "*.whl"), CASADI_SHA256)
        _run([*pip, "install", "--no-deps", "--no-index", "--target", part, wheel], "CasADi")
        shutil.rmtree(wheels)

    return _into(CACHE / "casadi", make)


def cmsis_dsp() -> Path:
    """CMSIS-DSP's source folder: Include, PrivateInclude, Source."""
    def make(part: Path) -> None:
        _run([sys.executable, "-m", "pip", "--disable-pip-version-check", "--quiet", "download", "--no-deps",
              "--no-binary", "cmsisdsp", "--dest", part, CMSIS_DSP], "CMSIS-DSP")
        _unpack(_checked(_only_file(part, "*.tar.gz"), CMSIS_DSP_SHA256), part)

    return _only_file(_into(CACHE / "cmsis-dsp", make), "cmsisdsp-*/Include").parent


def plugin_header() -> Path:
    """Folder of qemu-plugin.h, out of Debian's source package of the emulator."""
    def make(part: Path) -> None:
        sources = CACHE / "qemu-source"
        _run([ROOT / "tests" / "fetch" / "debian-source", "qemu", sources], "the emulator's plugin header")
        with tarfile.open(_only_file(sources, "qemu_*.orig.tar.*")) as archive:
            for member in archive:
                if member.name.endswith("/include/qemu/qemu-plugin.h"):
                    stream = archive.extractfile(member)
                    assert stream is not None
                    (part / "qemu-plugin.h").write_bytes(stream.read())
                    break
        _checked(part / "qemu-plugin.h", PLUGIN_HEADER_SHA256)
        shutil.rmtree(sources)

    return _into(CACHE / "qemu-plugin", make)


def _unpack(archive: Path, into: Path) -> None:
    with tarfile.open(archive) as contents:
        contents.extractall(into)  # no filter: Python 3.11.2 has none; the file's sum was checked
    archive.unlink()
