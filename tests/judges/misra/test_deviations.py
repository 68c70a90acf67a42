"""The judge of MISRA's findings: a finding without an entry is reported, and an entry without a finding."""

from __future__ import annotations

from pathlib import Path

import misra
import pytest


def finding(rule: str, file: str, text: str) -> misra.Finding:
    return misra.Finding(rule, file, 1, text)


def test_the_list_is_in_order() -> None:
    deviations = misra.read_deviations()
    assert len({(entry.rule, entry.files, entry.line) for entry in deviations}) == len(deviations)


@pytest.mark.parametrize(
    "text",
    [
        "uint8_t narrow = wide;",  # 10.3, an implicit narrowing
        "for (float x = 0.0f; x < 1.0f; x += 0.1f) {",  # 14.1
        "char *copy = malloc(4);",  # 21.3, the heap
        "goto out;",  # 15.1
        "return *pointer_to_a_dead_local;",  # 18.6
    ],
)
def test_what_nobody_argued_for_is_reported(text: str) -> None:
    rules = ("9.1", "10.3", "13.6", "14.1", "15.1", "17.3", "17.4", "18.6", "21.3", "22.2")
    planted = [finding(rule, "firmware/core/src/planar/planar.c", text) for rule in rules]
    assert misra.uncovered(planted, misra.read_deviations()) == planted


def test_an_entry_is_as_narrow_as_it_says() -> None:
    entry = misra.Deviation("10.4", "required", ("firmware/app/*",), r"\bBRACE_OK\b", "a reason of some length")
    there = finding("10.4", "firmware/app/src/app.c", "if (status == BRACE_OK) {")
    assert entry.covers(there)
    assert not entry.covers(finding("10.4", "firmware/core/src/a.c", "if (status == BRACE_OK) {"))
    assert not entry.covers(finding("10.4", "firmware/app/src/app.c", "if (status == other) {"))
    assert not entry.covers(finding("10.1", "firmware/app/src/app.c", "if (status == BRACE_OK) {"))
    assert misra.idle([], [entry]) == [entry]
    assert misra.idle([there], [entry]) == []


@pytest.mark.parametrize(
    "entry",
    [
        'rule = "10.4"\ncategory = "required"\nwhy = "everywhere, because it is easier"',
        'rule = "9.1"\ncategory = "mandatory"\nline = "x"\nwhy = "a mandatory rule has no deviation"',
        'rule = "15.5"\ncategory = "advisory"\nwhy = "so"',
    ],
)
def test_what_may_not_be_an_entry(tmp_path: Path, entry: str) -> None:
    path = tmp_path / "deviations.toml"
    path.write_text("[[deviation]]\n" + entry + "\n")
    with pytest.raises(SystemExit):
        misra.read_deviations(path)


def test_output_is_read(tmp_path: Path) -> None:
    (tmp_path / "a.c").write_text("int a;\nint b;\n")
    output = "a.c:2: misra-c2012-8.4\na.c:2: misra-c2012-8.4\na.c:1: variableScope\n\n"
    assert misra.parse(output, tmp_path) == [misra.Finding("8.4", "a.c", 2, "int b;")]


def test_a_text_that_has_moved_lets_nothing_be_kept(tmp_path: Path) -> None:
    header = tmp_path / "firmware" / "core" / "limb.h"
    header.parent.mkdir(parents=True)
    header.write_text("void f(void);\n")
    kept = misra.kept_results(tmp_path)
    (kept / "limb.a1").write_text("analysed")
    assert (misra.kept_results(tmp_path) / "limb.a1").is_file()
    header.write_text("/* f does nothing */\nvoid f(void);\n")
    assert not (misra.kept_results(tmp_path) / "limb.a1").exists()
