"""The command against hostile models, odd options and broken streams."""

from __future__ import annotations

import argparse
import json
import math
import os
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from command_bench import LIMB, Outcome, assert_a_million_takes_two_seconds, processor_s

Brace = Callable[..., Outcome]
POSTURE = ("--theta1", 1.0, "--theta2", 1.4)
ENVIRONMENT = {key: value for key, value in os.environ.items() if key != "BRACE_DEBUG"}


def shell(command: str, **variables: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        command.replace("BRACE", f"{sys.executable} -m brace"),
        shell=True, executable="/bin/bash", capture_output=True, text=True, timeout=60,
        env={**ENVIRONMENT, **variables},
    )  # fmt: skip


@pytest.mark.parametrize("by_file", [False, True])
def test_a_limb_stiff_across_has_no_k_in_space(brace: Brace, tmp_path: Path, by_file: bool) -> None:
    model, source = tmp_path / "stiff.toml", tmp_path / "in.csv"
    model.write_text(LIMB)
    source.write_text("theta0_rad,theta1_rad,theta2_rad\n0,1,1.4\n")
    asked = ("--csv", source, "--out", tmp_path / "o.csv") if by_file else ("--theta0", 0, *POSTURE)
    outcome = brace("k", "--model", model, *asked)
    assert outcome.code == 3 and "stiff.toml:" in outcome.err
    assert "[joint.coxa] compliance_rad_per_n_mm" in outcome.err and "lateral_mm_per_n" in outcome.err


@pytest.mark.parametrize("force", [(), ("--fz", 5)])
@pytest.mark.parametrize("by_file", [False, True])
def test_fixed_point_is_refused_in_space(
    brace: Brace, paper_limb: Path, tmp_path: Path, by_file: bool, force: tuple[object, ...]
) -> None:
    source = tmp_path / "in.csv"
    source.write_text("theta0_rad,theta1_rad,theta2_rad\n0,1,1.4\n")
    asked = ("--csv", source, "--out", tmp_path / "o.csv") if by_file else ("--theta0", 0, *POSTURE)
    outcome = brace("k", "--model", paper_limb, *asked, *force, "--arith", "fixed")
    assert outcome.code == 2 and not (tmp_path / "o.csv").exists()
    assert "fixed point works in the plane" in outcome.err and "try: --arith f32" in outcome.err


def test_streams_that_take_nothing(paper_limb: Path, tmp_path: Path) -> None:
    k = f"BRACE k --model {paper_limb} --theta1 1 --theta2 1"
    for command in (
        f"{k} >&-",
        f"{k} --json >/dev/full",
        f"{k} >/dev/full",
        f"BRACE map --model {paper_limb} --postures 100 --out {tmp_path}/m --json >/dev/full",
    ):
        done = shell(command)
        assert done.returncode == 1 and done.stderr.startswith("brace: standard output: "), done.stderr
        assert "internal" not in done.stderr and "Exception" not in done.stderr and "try:" in done.stderr
    assert shell("BRACE --help >/dev/full").returncode == 1
    silent = shell("BRACE k --model nowhere.toml --theta1 1 --theta2 1 2>&-")
    assert silent.returncode == 3 and silent.stdout == ""


def test_names_that_a_stream_cannot_show(tmp_path: Path) -> None:
    model = tmp_path / "limb.toml"
    model.write_text(LIMB.replace('"test"', '"Käfer"'), encoding="utf-8")
    done = shell(f"BRACE k --model {model} --theta1 1 --theta2 1", PYTHONIOENCODING="ascii")
    assert done.returncode == 0 and "K\\xe4fer" in done.stdout


def test_names_do_not_steer_the_terminal(brace: Brace, tmp_path: Path) -> None:
    model = tmp_path / "limb.toml"
    model.write_text(LIMB.replace('"test"', '"\\u001b[31mred"'))
    assert "\x1b" not in brace("k", "--model", model, *POSTURE).out
    clear = "\x1b[2J"
    for outcome in (
        brace("k", "--model", f"{clear}.toml", *POSTURE),
        brace("k", "--model", model, "--theta1", clear),
    ):
        assert outcome.code in (2, 3) and "\x1b" not in outcome.err and "\\x1b" in outcome.err


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        ("format = 1\n" + ".".join("a" * 3000) + " = 1\n", 2, "too deeply"),
        ("format = 1\n\nx = " + "[" * 5000 + "]" * 5000 + "\n", 3, "too deeply"),
        ("format = 1\nx = " + "[" * 40 + "]" * 40 + "\n", 2, "too deeply"),
        ("format = 1\n[geometry]\nfemur_mm = " + "9" * 5000 + "\n", 3, "digits"),
        (LIMB.replace("femur_mm = 185.0\n", ""), 3, "femur_mm"),
        ("format = 1\n", 1, "femur_mm"),
        (LIMB.replace("format = 1\n", ""), 1, "format"),
        (LIMB.replace("[geometry]", "[[geometry]]"), 3, "[geometry] is a table"),
        (re.sub(r"(per_n|per_n_mm) = .*", r"\1 = 0.0", LIMB), 7, "nothing in this limb yields"),
        ("format = 1\n[geometry]\nfemur_mm = 100\ntibia_mm = 100\n[link.tibia]\nbending_mm_per_n = 0.2\n", 6,
         "[joint.femur] compliance_rad_per_n_mm"),
        (LIMB.replace("coxa_mm = 57.0\n", "") + "[link.coxa]\nmoment_transfer = true\n", 22, "geometry.coxa_mm"),
    ],
)  # fmt: skip
def test_bad_models_name_their_line(brace: Brace, tmp_path: Path, text: str, line: int, words: str) -> None:
    model = tmp_path / "limb.toml"
    model.write_text(text)
    outcome = brace("k", "--model", model, *POSTURE)
    assert outcome.code == 3 and words in outcome.err, outcome.err[:500]
    assert f"limb.toml:{line}: " in outcome.err, outcome.err[:500]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--theta1", "1,0", "--theta2", 1), "try: --theta1 1.0"),
        (("--theta1", "\u22121.5", "--theta2", 1), "try: --theta1 -1.5"),
        (("--theta1", "\u20131,5", "--theta2", 1), "typographic one (U+2013)"),
        (("--theta1", "nan", "--theta2", 1), "not a finite number"),
        (("--thetal", 1, "--theta2", 1), "did you mean --theta1?"),
        (("--theta1", 1, "--theta2", 1, "--jsn"), "did you mean --json?"),
        (("--theta1", 1, "--theta2", 1, "extra"), "one argument too many"),
        (("--r", 300, "--phi", -23), "--phi -0.401426 if -23 are degrees"),
        (("--theta1", 1), "--theta1 alone is half a posture"),
        (("--phi", 1), "add --r MM"),
        (("--theta1", 1, "--phi", 1), "two ways to give the posture"),
        ((), "no posture is given"),
        (("--theta1", 1, "--theta2", 3.15), "beyond the folded knee"),
        (("--theta1", 90, "--theta2", 1), "degrees"),
        (("--csv", "a", "--out", ""), "an empty name"),
        (("--csv", "a\0b", "--out", "c"), "a name with a zero byte"),
        (("--theta1",), "--theta1: a value is missing"),
        (("--theta1", 1, "--theta2", 1, "--arith", "fixd"), "did you mean fixed?"),
    ],
)
def test_options_say_why_and_what_to_try(
    brace: Brace, paper_limb: Path, arguments: tuple[object, ...], words: str
) -> None:
    outcome = brace("k", "--model", paper_limb, *arguments)
    assert outcome.code == 2 and words in outcome.err, outcome.err
    assert "why:" in outcome.err and "try:" in outcome.err


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--theta1",), "--theta1: a value is missing"),
        (("--arith", "fixd"), "--arith: 'fixd' is no choice"),
        (("--theta1", "57degs"), "--theta1: '57degs' is not a number"),
        (("--theta1", 1, "--modell", "x"), "unknown option --modell"),
    ],
)
def test_messages_do_not_depend_on_how_argparse_words_its_own(
    brace: Brace, monkeypatch: pytest.MonkeyPatch, arguments: tuple[object, ...], words: str
) -> None:
    """Python's versions word them differently. Here every text that argparse prints is another."""
    monkeypatch.setattr(argparse, "_", lambda text: f"reworded {text}")
    outcome = brace("k", *arguments)
    assert outcome.code == 2 and words in outcome.err, outcome.err


@pytest.mark.parametrize(
    ("text", "angle_rad"), [("57deg", 0.994838), ("-20 deg", -0.349066), ("0.5rad", 0.5), ("0.5", 0.5)]
)
def test_an_angle_may_say_its_unit(brace: Brace, paper_limb: Path, text: str, angle_rad: float) -> None:
    outcome = brace("k", "--model", paper_limb, "--theta1", text, "--theta2", "63\u00b0")
    assert outcome.code == 0 and f"theta1 = {angle_rad} rad, theta2 = 1.09956 rad;" in outcome.out, outcome.err


def test_misspelt_words_elsewhere(brace: Brace, paper_limb: Path, paper_table: Path, tmp_path: Path) -> None:
    assert "did you mean --model?" in brace("k", "--modle", paper_limb).err
    assert "did you mean identify?" in brace("identfy").err
    degrees = brace("map", "--model", paper_limb, "--theta2", 0, 180, "--out", tmp_path / "m")
    assert degrees.code == 2 and "degrees" in degrees.err and "3.14159" in degrees.err
    only = brace("identify", paper_table, "--model", paper_limb, "--only", "name", "--out", tmp_path / "o.toml")
    assert only.code == 2 and "--only name" in only.err and "--fit" not in only.err
    (tmp_path / "unterminated.toml").write_text("")
    assert "did you mean" not in brace("k", "--model", tmp_path / "nothere.toml", *POSTURE).err
    (tmp_path / "limb.toml").write_text(LIMB)
    assert "limb.toml?" in brace("k", "--model", tmp_path / "lim.toml", *POSTURE).err
    rig = tmp_path / "rig.toml"
    rig.write_text('format = 1\n[rig]\naxes = "x"\n[[configuration]]\ntheta1_rad = 0.5\ntheta2_rad = 1.0\n')
    refused = brace("simulate", "--model", paper_limb, "--rig", rig, "--out", tmp_path / "d")
    assert refused.code == 3 and 'a list such as ["x", "z"]' in refused.err


def test_files_in_the_wrong_order(brace: Brace, paper_limb: Path, paper_table: Path, tmp_path: Path) -> None:
    rig = tmp_path / "rig.toml"
    rig.write_text('format = 1\ntitle = "t"\n[[configuration]]\ntheta1_rad = 0.5\ntheta2_rad = 1.0\n')
    out = ("--out", tmp_path / "out")
    for arguments, words in (
        (("simulate", "--model", rig, "--rig", paper_limb), "a rig file, where a limb model is wanted"),
        (("simulate", "--model", paper_limb, "--rig", paper_limb), "a limb model, where a rig file is wanted"),
        (("map", "--model", paper_table / "meta.toml"), "a dataset's meta.toml, where a limb model is wanted"),
        (("identify", paper_limb, "--model", paper_table), "a dataset's folder comes first"),
    ):
        outcome = brace(*arguments, *out)
        assert outcome.code == 3 and words in outcome.err and "try:" in outcome.err, outcome.err
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("command", ["map", "simulate", "diagnose", "demo", "identify", "predict", "k"])
def test_a_folder_in_which_nothing_may_be_written_is_told_before_the_work(
    brace: Brace, paper_limb: Path, paper_table: Path, tmp_path: Path, command: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By os.access, asked of the folder that is there: who runs the tests as root may write anywhere."""
    closed = tmp_path / "closed"
    closed.mkdir()
    may = os.access
    monkeypatch.setattr(os, "access", lambda path, mode: Path(path) != closed and may(path, mode))
    rig = paper_limb.parent / "paper-rig.toml"
    postures = tmp_path / "postures.csv"
    postures.write_text("theta1_rad,theta2_rad\n1,1.4\n")
    given = {"map": ["--model", paper_limb], "simulate": ["--model", paper_limb, "--rig", rig],
             "diagnose": [paper_table, "--model", paper_limb], "demo": [],
             "identify": [paper_table, "--model", paper_limb], "predict": [paper_table, "--model", paper_limb],
             "k": ["--model", paper_limb, "--csv", postures]}  # fmt: skip
    outcome = brace(command, *given[command], "--out", closed / "new")
    assert outcome.code == 2 and f"nothing may be written in {closed}" in outcome.err and not outcome.out, outcome.err
    assert not list(closed.iterdir())


def test_a_full_turn_is_the_same_posture(brace: Brace, paper_limb: Path) -> None:
    def k(*arguments: object) -> dict[str, Any]:
        return dict(json.loads(brace("k", "--model", paper_limb, *arguments, "--json").out))

    for name in ("k_xx_n_per_mm", "k_xz_n_per_mm", "lambda_max_n_per_mm"):
        turned = k("--r", 300, "--phi", 4)
        assert turned[name] == pytest.approx(k("--r", 300, "--phi", 4 - 2 * math.pi)[name], rel=1e-5)
        assert -math.pi <= turned["phi_rad"] <= math.pi
        turned = k("--theta1", 5.5, "--theta2", 1)
        assert turned[name] == pytest.approx(k("--theta1", 5.5 - 2 * math.pi, "--theta2", 1)[name], rel=1e-5)
    assert k("--theta1", 1, "--theta2", 3.1416)["knee"] == "up"  # pi to four decimals is the folded knee


def test_the_knee_is_named_by_its_true_angle(brace: Brace, tmp_path: Path) -> None:
    model = tmp_path / "limb.toml"
    model.write_text(LIMB.replace("= 1.6e-5\n", "= 1.6e-5\nzero_offset_rad = -0.2\n"))
    outcome = brace("k", "--model", model, "--theta1", 1, "--theta2", 0.1, "--json")
    assert json.loads(outcome.out)["knee"] == "down"


def test_little_is_imported_before_ctrl_c_is_caught() -> None:
    code = "import sys; before = set(sys.modules); import brace.cli; print(sorted(set(sys.modules) - before))"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert not set(re.findall(r"'([\w.]+)'", loaded)) & {"argparse", "re", "numpy", "collections.abc",
                                                         "brace.ground.errors"}, loaded


def test_ctrl_c_while_the_command_is_being_imported(tmp_path: Path) -> None:
    """The module that would be imported next interrupts instead, as Ctrl-C at that moment does."""
    (tmp_path / "argparse.py").write_text("import os, signal\nos.kill(os.getpid(), signal.SIGINT)\n")
    done = shell("BRACE --help", PYTHONPATH=str(tmp_path))
    assert done.returncode == 130 and done.stderr == "brace: interrupted; nothing was written\n"


@pytest.mark.minutes
def test_a_million_postures_of_any_limb_in_two_seconds_of_processor(tmp_path: Path) -> None:
    model = tmp_path / "limb.toml"
    model.write_text(
        LIMB.replace("[link.tibia]", "moment_transfer = true\ntilt_rad = 0.1\n[link.tibia]\ntilt_rad = 0.2")
        + "[base]\nx_mm_per_n = 0.5\nz_mm_per_n = 0.1\n"
    )
    spent_s, out = processor_s("map", "--model", model, "--postures", 1_000_000, "--out", tmp_path / "m", "--json")
    assert json.loads(out)["path"] == "general"
    assert_a_million_takes_two_seconds(spent_s, model, tmp_path / "few")
