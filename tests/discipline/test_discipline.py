"""The firmware keeps its discipline; and the checks see what breaks it: every sample's marked lines, and no others."""
from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from pycparser import c_ast

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import calls  # noqa: E402
import firmware_rules  # noqa: E402
import loops  # noqa: E402
import objects  # noqa: E402
from sources import CROSS, ROOT, Finding, Source, build_objects, firmware_sources  # noqa: E402

BUILD = Path(os.environ.get("BRACE_M4F_BUILD", ROOT / "build" / "m4f")).resolve()
MARK = re.compile(r"/\* BAD: (.*?) \*/")
CORTEX_M4F = ["-mcpu=cortex-m4", "-mthumb", "-mfloat-abi=hard", "-mfpu=fpv4-sp-d16"]


def marked(path: Path) -> set[tuple[int, str]]:
    """What a sample says of its own lines."""
    return {(i, match[1]) for i, line in enumerate(path.read_text().splitlines(), 1) if (match := MARK.search(line))}


def seen(findings: list[Finding]) -> set[tuple[int, str]]:
    return {(f.line, f.rule) for f in findings}


def compiled(sample: Path, folder: Path, *more: str) -> Path:
    """A sample's object."""
    out = folder / f"{sample.stem}.o"
    subprocess.run([CROSS + "gcc", *CORTEX_M4F, "-O2", "-fno-builtin", *more, "-c", str(sample), "-o", str(out)],
                   check=True)
    return out


def test_bad_loops_are_found() -> None:
    path = HERE / "samples" / "loops_bad.c"
    assert seen(loops.check(Source(path))) == marked(path)


def test_good_loops_are_not() -> None:
    assert loops.check(Source(HERE / "samples" / "loops_good.c")) == []


@pytest.mark.parametrize(("was", "becomes"), [
    (" [0, 64]", ""), ("MOST ? wanted : MOST", "MOST ? MOST : wanted"), ("polls--;", "polls -= 0u;"),
    ("sum(bytes, MOST)", "sum(bytes, wanted)"),
    ("/= 10u", "/= ready"), ("pass == MOST", "pass == (int)ready"), ("bytes + count;", "bytes + wanted;"),
    ("end > 256u", "end > ready"), ("uint8_t few", "uint32_t few"), ("at most 4", "some"),
    ("i < 1000u && ready", "ready")])
def test_a_good_loop_made_worse_is_found(tmp_path: Path, was: str, becomes: str) -> None:
    text = (HERE / "samples" / "loops_good.c").read_text()
    assert was in text
    worse = tmp_path / "worse.c"
    worse.write_text(text.replace(was, becomes))
    assert loops.check(Source(worse)) != []


def test_a_loop_for_ever_needs_its_place_and_its_reason(tmp_path: Path) -> None:
    for comment, where, expected in (("for ever: the controller", ROOT / "firmware" / "boards", 0),
                                     ("because", ROOT / "firmware" / "boards", 1),
                                     ("for ever: the controller", ROOT / "firmware" / "app" / "src", 1)):
        source = Source(tmp_path / "endless.c")
        source.path.write_text(f"void f(void)\n{{\n    for (;;) {{ /* {comment} */\n    }}\n}}\n")
        tree, text = source.tree, source.text
        source.path = where / "endless.c"  # as if it were there
        for node in (at for at in tree.ext if isinstance(at, c_ast.FuncDef)):
            assert len(list(loops.Function(source, node).findings())) == expected, text


def test_recursion_and_unlisted_pointers_are_found() -> None:
    path = HERE / "samples" / "calls_bad.c"
    graph = calls.graph_of([Source(path)])
    assert seen(calls.recursion_findings(graph) + calls.pointer_findings(graph)) == marked(path)


def test_heap_and_stdio_are_found(tmp_path: Path) -> None:
    path = HERE / "samples" / "library_bad.c"
    assert seen(objects.library_findings([(path, compiled(path, tmp_path))])) == marked(path)


def test_stack_of_unknown_size_is_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = HERE / "samples" / "stack_bad.c"
    compiled(path, tmp_path, "-fstack-usage")
    monkeypatch.setattr(calls, "FOLDERS_WITH_FIGURES", (HERE,))
    assert seen(calls.frames(tmp_path)[1]) == marked(path)


def test_floating_point_in_an_interrupt_is_found(tmp_path: Path) -> None:
    path = HERE / "samples" / "interrupt_bad.c"
    image = tmp_path / "image.elf"
    subprocess.run([CROSS + "gcc", *CORTEX_M4F, "-nostdlib", "-Wl,-e,reset_handler", "-Wl,--section-start=.vectors=0x0",
                    str(compiled(path, tmp_path, "-fno-builtin")), "-o", str(image)], check=True)
    graph = calls.graph_of([Source(path)])
    where = {calls.short(key): (node.path, node.line) for key, node in graph.nodes.items()}
    assert seen(objects.interrupt_findings(objects.Image(image), where)) == marked(path)


def test_floating_point_without_an_fpu_is_found(tmp_path: Path) -> None:
    """There it is a call of the compiler's library."""
    path = HERE / "samples" / "interrupt_bad.c"
    image = tmp_path / "image.elf"
    subprocess.run([CROSS + "gcc", "-mcpu=cortex-m0plus", "-mthumb", "-O2", "-nostartfiles", "-Wl,-e,reset_handler",
                    "-Wl,--section-start=.vectors=0x0", str(path), "-o", str(image)], check=True)
    found = objects.interrupt_findings(objects.Image(image), {})
    assert any(f.rule == objects.FLOATING_POINT and "scale" in f.why for f in found)


@pytest.fixture(scope="module")
def report() -> firmware_rules.Report:
    if not (BUILD / "compile_commands.json").is_file():
        pytest.skip("no Cortex-M4F build; ./dev setup makes one")
    return firmware_rules.run(BUILD)


def test_the_firmware_keeps_its_discipline(report: firmware_rules.Report) -> None:
    assert not report.findings, "\n" + "\n".join(map(str, report.findings))


def test_nothing_was_left_out(report: firmware_rules.Report) -> None:
    """All sources are read; all that this build compiles have an object; images have a known depth of stack."""
    assert report.sources == sum(1 for folder in ("firmware", "hal") for _ in (ROOT / folder).rglob("*.c"))
    by_build = [source for source in firmware_sources(BUILD) if source.compiler != "gcc"]
    assert {source.path for source in by_build} == {source for source, _ in build_objects(BUILD)}
    assert report.loops > 100 and report.functions > 500
    assert len(report.depths) >= 3
    for depth in report.depths:
        print(f"{depth.image}: stack at most {depth.worst_bytes} B of {depth.room_bytes} B: {' -> '.join(depth.chain)}")
        assert 0 < depth.tick_bytes <= depth.main_bytes < depth.room_bytes
