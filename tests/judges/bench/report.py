"""The bench's result as text for a person, Markdown and JSON: one set of tables, three ways of writing it."""

from dataclasses import dataclass

from extra import Extra, Table
from limits import Check
from measure import Measured
from throughput import Rate
from versions import GROUPS


@dataclass(frozen=True)
class Bench:
    """Everything one run found out."""

    measured: list[Measured]
    rates: list[Rate]
    weights: dict[str, int]  # name with unit -> value: flash, RAM and stack of the core
    map_s: float  # processor time of brace map over a million postures
    modules: dict[str, int]  # source of the core -> bytes of flash on the Cortex-M4F
    checks: list[Check]
    tools: dict[str, str]  # program -> version
    extras: tuple[Extra, ...] = ()

    @property
    def all_checks(self) -> list[Check]:
        """Also the extras'."""
        return [*self.checks, *(check for extra in self.extras for check in extra.checks)]


def _power(value: float) -> str:
    return f"{value:.1e}".replace("e-0", "e-")


def _baseline(measured: list[Measured], group: str) -> int | None:
    """Median of our first version of a group: what the others are divided by."""
    return next((m.median for m in measured if m.version.group == group and m.version.ours), None)


def _row(m: Measured, baseline: int | None) -> list[str]:
    counts = f"{m.minimum:,} / {m.median:,} / {m.maximum:,}"
    ratio = f"{m.median / baseline:.2f}" if baseline else "-"
    cycles = f"{m.cycles.manual:,} ({m.cycles.careful:,})" if m.cycles else "-"
    mca = f"{m.cycles.mca:,}" if m.cycles else "-"
    errors = [_power(m.error.k), _power(m.error.eigenvalues[0]), _power(m.error.axis_rad)] if m.error else ["-"] * 3
    return [m.version.name, counts, ratio, cycles, mca, f"{m.flash_bytes:,}", f"{m.stack_bytes:,}", *errors]


HEADS = ["version", "instructions min / median / max", "ratio", "cycles by the manual (careful)", "llvm-mca",
         "flash [B]", "stack [B]", "K error", "lambda_min error", "axis error [rad]"]


def tables(bench: Bench) -> list[Table]:
    """All tables of a run."""
    out: list[Table] = []
    for group in GROUPS:
        baseline = _baseline(bench.measured, group)
        rows = [_row(m, baseline) for m in bench.measured if m.version.group == group]
        if rows:
            out.append((f"{group[0].upper()}{group[1:]}", HEADS, rows))
    slowest = min((r.postures_per_s for r in bench.rates), default=1.0)
    out.append(("Host throughput in batches, one core", ["version", "million postures per second", "ratio", "K error",
                                                         "lambda_min error"],
                [[r.name, f"{r.postures_per_s / 1e6:.1f}", f"{r.postures_per_s / slowest:.1f}", _power(r.error.k),
                  _power(r.error.eigenvalues[0])] for r in bench.rates]))
    out.append(("The core's flash, RAM and stack, by the compiler", ["what", "bytes"],
                [[name, f"{value:,}"] for name, value in bench.weights.items()]))
    out.append(("The core's sources on the Cortex-M4F", ["source", "flash [B]"],
                [[name, f"{value:,}"] for name, value in bench.modules.items()]))
    for extra in bench.extras:
        out += extra.tables
    out.append(("Limits", ["limit", "measured", "required", ""],
                [[c.name, c.measured, c.required, c.verdict] for c in bench.all_checks]))
    return out


NOTES = """\
The same 200 postures for all (theta1 -1 to 1.5, theta2 0.2 to 2.9 rad, fixed seed), the paper's limb with moment \
transfer and joint springs, the same outputs: K, both eigenvalues, the stiff axis. GCC -O2 unless a row says \
otherwise; peers with GCC's own contraction of multiply and add. Instructions are counted in the emulator from a \
function's entry to its return, callees included. Ratio: median over that of the first row. Cycles: for the call of \
median count (parameter change: the longest), by the Cortex-M4 manual's timings without overlap of loads and stores, \
and in brackets with its one cycle for a floating-point result used by the next instruction; then llvm-mca's estimate \
of the same sequence. Neither is silicon. Flash: what the function pulls in, library and constants included; for the \
planar and spatial paths the parameter change too. Stack: ours by the compiler's figures, peers' as far down as it was \
written. Errors: the largest against the double-precision reference, K as a fraction of lambda_max. The peers' model \
has no \
tilt, which is to their favour."""


def as_text(bench: Bench) -> str:
    """For a terminal."""
    return "\n\n".join(f"{title}\n{_aligned(heads, rows)}" for title, heads, rows in tables(bench))


def _aligned(heads: list[str], rows: list[list[str]]) -> str:
    widths = [max(len(row[i]) for row in [heads, *rows]) for i in range(len(heads))]
    def line(cells: list[str]) -> str:
        first, *rest = [cell.rjust(width) for cell, width in zip(cells, widths, strict=True)]
        return "  ".join([cells[0].ljust(widths[0]), *rest]).rstrip() if first else ""
    return "\n".join([line(heads), "  ".join("-" * width for width in widths), *map(line, rows)])


def as_markdown(bench: Bench) -> str:
    """All tables as a page."""
    parts = ["# What a K costs", NOTES]
    notes = {extra.tables[0][0]: extra.note for extra in bench.extras}
    for title, heads, rows in tables(bench):
        if title in notes:
            parts.append(notes[title])
        ruler = "|".join(["---", *["---:"] * (len(heads) - 1)])
        body = "\n".join("| " + " | ".join(cells) + " |" for cells in rows)
        parts.append(f"## {title}\n\n| {' | '.join(heads)} |\n|{ruler}|\n{body}")
    parts.append("Made with " + ", ".join(f"{name} {version}" for name, version in bench.tools.items()) + ".")
    return "\n\n".join(parts) + "\n"


def as_data(bench: Bench) -> dict[str, object]:
    """All figures, for a program."""
    return {
        "format": 1,
        "versions": [{
            "group": m.version.group, "name": m.version.name, "ours": m.version.ours,
            "instructions_min": m.minimum, "instructions_median": m.median, "instructions_max": m.maximum,
            "one_path": m.one_path, "ratio_to_ours": _ratio(m, bench.measured),
            "cycles_manual": m.cycles.manual if m.cycles else None,
            "cycles_careful": m.cycles.careful if m.cycles else None, "cycles_mca": m.cycles.mca if m.cycles else None,
            "flash_bytes": m.flash_bytes, "static_ram_bytes": m.static_ram_bytes, "stack_bytes": m.stack_bytes,
            "error_k_of_lambda_max": m.error.k if m.error else None,
            "error_eigenvalues_rel": list(m.error.eigenvalues) if m.error else None,
            "error_axis_rad": m.error.axis_rad if m.error else None,
        } for m in bench.measured],
        "host": [{"name": r.name, "postures_per_s": r.postures_per_s, "error_k_of_lambda_max": r.error.k,
                  "error_eigenvalues_rel": list(r.error.eigenvalues)} for r in bench.rates],
        "map_million_postures_s": round(bench.map_s, 3),
        "core_bytes": bench.weights,
        "core_source_flash_bytes": bench.modules,
        "limits": [{"name": c.name, "measured": c.measured, "required": c.required, "verdict": c.verdict}
                   for c in bench.all_checks],
        **{extra.key: extra.data for extra in bench.extras},
        "tools": bench.tools,
    }


def _ratio(m: Measured, measured: list[Measured]) -> float | None:
    baseline = _baseline(measured, m.version.group)
    return round(m.median / baseline, 3) if baseline else None
