"""What .editorconfig says holds in every text file: UTF-8, line ends, no trailing blanks; C and C++ have no tabs, no
line of more than 120 columns, and the form that .clang-format describes. tests/check.py judges columns and form."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(PROJECT / "tests"))

from check import ALL_LINES, base, clang_format, formatted_by_clang, long_lines  # noqa: E402


def faults(name: str, content: bytes) -> list[str]:
    """What is wrong with a file; a file with a zero byte is no text."""
    if b"\0" in content:
        return []
    lines = content.decode().split("\n")
    rules = {
        "a carriage return": "\r" in content.decode(),
        "no line end at its end": lines[-1] != "",
        "trailing blanks": not name.endswith(".svg") and any(line != line.rstrip(" \t") for line in lines),
        "a tab": name.endswith(ALL_LINES) and any("\t" in line for line in lines),
    }
    return [f"{name} has {rule}" for rule, broken in rules.items() if broken]


def test_every_text_file_is_as_editorconfig_says() -> None:
    names = subprocess.run(["git", "ls-files", "-z"], cwd=PROJECT, capture_output=True, text=True, check=True).stdout
    files = {name: PROJECT / name for name in names.split("\0") if name and (PROJECT / name).is_file()}
    assert len(files) > 1000
    assert [fault for name, path in files.items() for fault in faults(name, path.read_bytes())] == []


def test_faults_are_seen() -> None:
    assert len(faults("a.c", b"\tint x; \r\n\n ")) == 4
    assert faults("a.svg", b"<g> \n") == []


def test_no_line_has_too_many_columns() -> None:
    assert long_lines(base()) == []


def test_c_and_cpp_are_as_clang_format_says() -> None:
    names = subprocess.run(["git", "ls-files", "-z"], cwd=PROJECT, capture_output=True, text=True, check=True).stdout
    files = formatted_by_clang(Path(name) for name in names.split("\0") if name)
    assert len(files) > 700
    assert clang_format(files)
