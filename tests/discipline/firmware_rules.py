"""The firmware's discipline: no heap, no stdio, no recursion, a bound on every loop, no floating point in interrupt
handlers, every call through a pointer known; and how deep the stack can get.

    python tests/discipline/firmware_rules.py [BUILD]     BUILD: a Cortex-M4F build, build/m4f if not given

Sources are all .c under firmware/ and hal/, found by looking; objects and images those of the build. Every finding
names file, line and rule. Exit codes: 0 none, 1 some, 4 no build.
"""
from __future__ import annotations

import gc
import sys
from dataclasses import dataclass
from pathlib import Path

import calls
import loops
import objects
from sources import ROOT, Finding, Unreadable, build_objects, firmware_sources

EXCEPTION_FRAME_BYTES = 108  # what the processor stacks with the FPU in use, aligned
TICK = "brace_app_tick"


@dataclass(frozen=True)
class Depth:
    """Worst-case stack of an image: the main thread, and on it the deepest handler with its exception frame."""

    image: str
    main_bytes: int
    handler_bytes: int
    tick_bytes: int
    room_bytes: int
    chain: tuple[str, ...]

    @property
    def worst_bytes(self) -> int:
        """One handler on the thread, and the fault handler on that."""
        return self.main_bytes + self.handler_bytes


@dataclass(frozen=True)
class Report:
    """Everything one run found."""

    findings: list[Finding]
    depths: list[Depth]
    sources: int
    objects: int
    functions: int
    loops: int


def _depth(graph: calls.Graph, sizes: dict[str, int], image: objects.Image) -> Depth:
    def there(key: str) -> bool:
        return calls.short(key) in image.functions

    def down(root: str) -> tuple[int, list[str]]:
        return calls.deepest(graph, sizes, root, there, image.library_stack_bytes)

    main, chain = down("main")
    tick, _ = down(TICK)
    handlers = [down(_key(graph, name, image)) for name in image.handlers() if name != "fault_handler"]
    # every handler has one priority: at most one of them at a time. The fault handler has a stack of its own.
    handler = EXCEPTION_FRAME_BYTES + max((bytes_ for bytes_, _ in handlers), default=0)
    return Depth(image.path.stem, main, handler, tick, image.symbols["_stack_size"][0], tuple(chain))


def _key(graph: calls.Graph, name: str, image: objects.Image) -> str:
    """A handler's key in the graph; a static one by its name alone."""
    bare = name.split(".")[0]
    return bare if bare in graph.nodes else next((k for k in graph.nodes if calls.short(k) == bare), bare)


def run(build: Path) -> Report:
    """All rules over all sources, objects and images. Raises Unreadable."""
    gc.disable()  # the trees of all sources are kept: going through them for what is not needed finds nothing
    try:
        return _run(build)
    finally:
        gc.enable()


def _run(build: Path) -> Report:
    sources = list(firmware_sources(build))
    findings = [finding for source in sources for finding in loops.check(source)]
    graph = calls.graph_of(sources)
    findings += calls.recursion_findings(graph) + calls.pointer_findings(graph)
    sizes, unbounded = calls.frames(build)
    findings += unbounded
    compiled = build_objects(build)
    findings += objects.library_findings(compiled)
    where = {calls.short(key): (node.path, node.line) for key, node in graph.nodes.items()}
    depths = []
    for image in objects.controller_images(build):
        def pointed(name: str, image: objects.Image = image) -> set[str]:
            node = graph.nodes.get(_key(graph, name, image))
            names = {calls.short(t) for place, _ in (node.through if node else ())
                     for t in graph.targets.get(place, ())}
            return names & set(image.functions)

        findings += objects.interrupt_findings(image, where, pointed) + objects.forbidden_in_image(image)
        findings += [Finding(node.path, node.line, calls.STACK, f"{node.key}: no figure; compile it with -fstack-usage")
                     for node in graph.nodes.values() if node.key in image.functions and node.key not in sizes]
        depths.append(_depth(graph, sizes, image))
        if depths[-1].worst_bytes > depths[-1].room_bytes:
            findings.append(Finding(image.path, 0, calls.STACK, f"{depths[-1].worst_bytes} B needed of "
                                    f"{depths[-1].room_bytes} B: {' -> '.join(depths[-1].chain)}"))
    if not depths:
        raise Unreadable(f"{build}: no controller image; build it whole first (./dev setup)")
    exempt = objects.exemptions()
    findings = [f for f in dict.fromkeys(findings) if (f.path, f.rule) not in exempt]
    counted = sum(isinstance(at, loops.LOOPS) for s in sources for f in s.functions if f.coord.file == str(s.path)
                  for at in loops.walk(f.body))
    return Report(findings, depths, len(sources), len(compiled), len(graph.nodes), counted)


def as_text(report: Report) -> str:
    """For a terminal."""
    lines = [f"{report.sources} sources, {report.objects} objects, {report.functions} functions, {report.loops} loops"]
    for d in report.depths:
        lines += [f"{d.image}: stack at most {d.worst_bytes} B of {d.room_bytes} B (main {d.main_bytes}, "
                  f"a tick {d.tick_bytes}, an interrupt on top {d.handler_bytes})", "  " + " -> ".join(d.chain)]
    return "\n".join([*lines, *map(str, report.findings), f"{len(report.findings)} findings"])


def main() -> int:
    """Run and print; the exit code."""
    build = Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "build" / "m4f").resolve()
    if not (build / "compile_commands.json").is_file():
        print(f"discipline: no build in {build}; try ./dev setup", file=sys.stderr)
        return 4
    try:
        report = run(build)
    except Unreadable as error:
        print(f"discipline: {error}", file=sys.stderr)
        return 1
    print(as_text(report))
    return 1 if report.findings else 0


if __name__ == "__main__":
    raise SystemExit(main())
