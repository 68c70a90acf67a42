"""What a release is made of: the sources of the last commit, and its time, which is the time of every file released."""

from __future__ import annotations

import gzip
import hashlib
import io
import os
import re
import shutil
import subprocess
import tarfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]


class ReleaseError(Exception):
    """A step that could not be done; the message says which, why, and what to try."""


@dataclass(frozen=True)
class Source:
    """`folder` has the files of `commit` and no others; `epoch_s` is the commit's time."""

    folder: Path
    commit: str
    epoch_s: int
    version: str

    @property
    def environment(self) -> dict[str, str]:
        """For every tool that writes files: the time, and one place for the sources whatever the folder is called."""
        mapped = f"-ffile-prefix-map={self.folder.parent}=brace"
        return {
            **os.environ,
            "SOURCE_DATE_EPOCH": str(self.epoch_s),
            "CFLAGS": mapped,
            "CXXFLAGS": mapped,
            "TZ": "UTC",
            "LC_ALL": "C.UTF-8",
            "PYTHONHASHSEED": "0",
        }


def run(*command: object, cwd: Path | None = None, environment: Mapping[str, str] | None = None) -> str:
    """What a command prints; ReleaseError with its last words where it fails."""
    words = [str(part) for part in command]
    try:
        done = subprocess.run(words, cwd=cwd, env=environment, capture_output=True, text=True, check=False)
    except FileNotFoundError:
        raise ReleaseError(f"no program {words[0]}: ./dev release installs what it needs on Debian") from None
    if done.returncode:
        raise ReleaseError(f"{' '.join(words)}\n{(done.stdout + done.stderr)[-3000:]}")
    return done.stdout


def export(folder: Path) -> Source:
    """Writes the sources of the last commit into a folder."""
    commit = run("git", "rev-parse", "HEAD", cwd=PROJECT).strip()
    epoch_s = int(run("git", "log", "-1", "--format=%ct", cwd=PROJECT))
    archive = subprocess.run(["git", "archive", "HEAD"], cwd=PROJECT, capture_output=True, check=True).stdout
    with tarfile.open(fileobj=io.BytesIO(archive)) as tar:
        tar.extractall(folder)  # no filter: Debian 12's Python 3.11.2 has none; git has just made this archive
    return Source(folder, commit, epoch_s, version_of(folder))


def version_of(folder: Path) -> str:
    """The version that these sources say they are."""
    text = (folder / "firmware" / "core" / "cmake" / "version.cmake").read_text()
    found = re.search(r"^set\(BRACE_VERSION (\S+)\)", text, re.MULTILINE)
    if not found:
        raise ReleaseError("firmware/core/cmake/version.cmake does not set BRACE_VERSION")
    return found[1]


def set_times(folder: Path, epoch_s: int) -> None:
    """Gives every file and folder the release's time, and the usual rights."""
    for path in sorted([folder, *folder.rglob("*")], reverse=True):
        if not path.is_symlink():
            is_program = path.is_dir() or bool(path.stat().st_mode & 0o100)
            path.chmod(0o755 if is_program else 0o644)
        os.utime(path, (epoch_s, epoch_s), follow_symlinks=False)


def archive(folder: Path, name: str, out: Path, epoch_s: int) -> None:
    """A .tar.gz of a folder: files in order, nobody's, all of one time. `name` is the folder's name inside."""
    buffer = io.BytesIO()
    with tarfile.open(fileobj=buffer, mode="w", format=tarfile.PAX_FORMAT) as tar:
        for path in sorted(folder.rglob("*")):
            entry = tar.gettarinfo(str(path), f"{name}/{path.relative_to(folder)}")
            entry.uid = entry.gid = 0
            entry.uname = entry.gname = ""
            entry.mtime = epoch_s
            entry.mode = 0o755 if entry.mode & 0o100 else 0o644
            if path.is_file() and not path.is_symlink():
                with path.open("rb") as file:
                    tar.addfile(entry, file)
            else:
                tar.addfile(entry)
    out.write_bytes(gzip.compress(buffer.getvalue(), compresslevel=9, mtime=epoch_s))


def sums(folder: Path) -> str:
    """Lines as `sha256sum --check` reads them, of every file in a folder."""
    files = sorted(path for path in folder.rglob("*") if path.is_file() and path != folder / "SHA256SUMS")
    lines = (f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.relative_to(folder)}\n" for path in files)
    return "".join(lines)


def fresh(folder: Path) -> Path:
    """An empty folder."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    return folder
