"""What a shell's user meets: help at once, completion, man pages, --quiet, and lines in a log."""

from __future__ import annotations

import argparse
import json
import os
import resource
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest

from brace.cli import common, main, streams
from brace.cli.command_line import build_parser
from brace.cli.completion_command import completion
from brace.cli.subcommands import SUBCOMMANDS
from command_bench import DATA, PROJECT

HELP_S, EMPTY_S = 0.1, 0.02


def output_of(*command: str, **environment: str) -> str:
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, env={**os.environ, **environment})
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_help_at_once(tmp_path: Path) -> None:
    """The least processor time of some starts. Where others use this machine's caches, an empty program takes longer than
    its 20 ms, and help may take as much longer."""
    environment = {**os.environ, "PYTHONPYCACHEPREFIX": str(tmp_path)}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)

    def spent_s(*words: str) -> float:
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        subprocess.run([sys.executable, *words], env=environment, check=True, capture_output=True)
        return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before

    pairs = [(spent_s("-c", "pass"), spent_s("-m", "brace", "--help")) for _ in range(8)]  # the first one compiles
    empty, help_s = (min(column) for column in zip(*pairs))
    assert help_s < HELP_S * max(1.0, empty / EMPTY_S)


def test_help_loads_no_subcommand() -> None:
    loaded = "[name for name in sys.modules if name == 'numpy' or name.endswith('_command')]"
    words = f"import sys; from brace.cli import main; main(['--help']); print({loaded})"
    assert output_of(sys.executable, "-c", words).splitlines()[-1] == "[]"


@pytest.mark.parametrize("options", [["--quiet", "params", "pack"], ["params", "pack", "--quiet"], ["params", "pack"]])
def test_quiet(options: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    block = tmp_path / "block.bin"
    assert main([*options, "--model", str(DATA / "paper-limb.toml"), "--out", str(block)]) == 0
    assert (capsys.readouterr().err == "") == ("--quiet" in options)
    assert block.is_file()


def test_quiet_still_says_what_went_wrong(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["k", "--quiet", "--model", "nowhere.toml", "--theta1", "1", "--theta2", "1"]) == 3
    assert "nowhere.toml" in capsys.readouterr().err


def test_long_work_tells_a_log(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    streams.prepare()  # every command begins so
    assert common.LINE_EVERY_S == 10.0
    monkeypatch.setattr(common, "LINE_EVERY_S", 0.05)
    with common.progress("fitting", 8) as advance:
        advance(2, "tibia")
        time.sleep(0.3)
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) >= 2 and all(line == "brace: fitting: tibia: 0 s so far, 25 % done" for line in lines)
    with common.progress("short"):
        pass
    assert capsys.readouterr().err == ""


def words_after(shell: str, line: str, tmp_path: Path) -> list[str]:
    """What a shell offers behind a line."""
    script = tmp_path / "brace"
    script.write_text(completion(shell) + "\n")
    if shell == "fish":
        offered = output_of("fish", "-c", f"source {script}; complete -C '{line}'", HOME=str(tmp_path))
        return [word.partition("\t")[0] for word in offered.splitlines()]
    words = line.split(" ")
    set_words = f"COMP_WORDS=({' '.join(words)} ); COMP_CWORD={len(words) - 1}"
    if words[-1] == "":
        set_words = f"COMP_WORDS=({' '.join(words)} ''); COMP_CWORD={len(words) - 1}"
    shown = f"source {script}; {set_words}; _shtab_brace; printf '%s\\n' \"${{COMPREPLY[@]}}\""
    return output_of("bash", "-c", shown).split()


@pytest.mark.parametrize("shell", ["bash", "fish"])
def test_completion(shell: str, tmp_path: Path) -> None:
    if shutil.which(shell) is None:
        pytest.skip(f"no {shell}")
    assert set(words_after(shell, "brace ta", tmp_path)) == {"take-up"}
    assert "--theta1" in words_after(shell, "brace k --the", tmp_path)


def test_completion_as_json(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["completion", "bash", "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == {"shell": "bash", "script": completion("bash").rstrip("\n")}


def test_every_subcommand_has_json() -> None:
    """The subcommands of a subcommand, too."""

    def without(parser: argparse.ArgumentParser) -> list[str]:
        below = [action for action in parser._actions if isinstance(action, argparse._SubParsersAction)]
        if below:
            return [prog for action in below for child in action.choices.values() for prog in without(child)]
        return [] if "--json" in parser._option_string_actions else [parser.prog]

    assert without(build_parser()) == []


def test_completion_for_zsh(tmp_path: Path) -> None:
    text = completion("zsh")
    assert "take-up" in text and "--theta1" in text and "_files" in text
    if shutil.which("zsh"):
        (tmp_path / "_brace").write_text(text)
        output_of("zsh", "-n", str(tmp_path / "_brace"))


def test_man_pages(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("argparse_manpage")
    sys.path.insert(0, str(PROJECT / "tools"))
    from release.man_pages import man_pages

    monkeypatch.setenv("SOURCE_DATE_EPOCH", "0")
    pages = man_pages("1.2.3")
    assert sorted(pages) == sorted(["brace.1", *(f"brace-{name}.1" for name in SUBCOMMANDS)])
    assert pages == man_pages("1.2.3")
    assert '"1970\\-01\\-01" "Brace 1.2.3"' in pages["brace-k.1"] and "theta1" in pages["brace-k.1"]
