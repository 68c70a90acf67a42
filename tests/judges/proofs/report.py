"""What the proofs say, as lines for a terminal and as docs/proofs.md."""

from __future__ import annotations

from dataclasses import dataclass

import cbmc

HEAD = f"{'proof':22} {'properties':>10} {'seconds':>8}  {'verdict':10} broken on purpose"

INTRODUCTION = """# What is proven

    ./dev proofs [--only NAME ...]

writes this page. Each claim holds for **every** input within its bound, not for samples of it:
[CBMC](https://github.com/diffblue/cbmc) {version} turns the firmware's own C, with a Cortex-M4's integers and pointers,
into a formula and finds no input that breaks it. It also checks each array index, pointer, shift, division and signed
overflow on the way, and that no loop goes further than its bound. Three claims (`fixed_lengths`, `loaded_turns`,
`loaded_softened`) are no formulas: there the firmware's text runs through all inputs, or with ranges of numbers.

A proof has to fail where the code is wrong: each one is run again on code with a mistake put in, and has to find it.
[proofs.toml](../tests/judges/proofs/proofs.toml) has the mistakes, and each claim in full with what it takes from elsewhere;
`build/proofs/NAME.txt` has the record of the run.

Not proven: what floating-point results are worth (property tests and the reference judge that), time (the bench counts
instructions), interrupts, what compilers make of the C. CBMC knows where an object ends, not where an array inside a
struct does: there the claims name the bounds.

| claim | holds for | verdict | mistakes found | commit |
|---|---|---|---|---|
"""

LAST_LINE = """
*Commit*: of the text that was run last. "Text changed since": a file that the proof reads is another one now; it is to
be run again.
"""


@dataclass(frozen=True)
class Outcome:
    """A claim and what came of it."""

    name: str
    claim: str
    functions: tuple[str, ...]
    bound: str
    stands_on: tuple[str, ...]
    verdict: cbmc.Verdict
    twins: tuple[tuple[str, cbmc.Verdict], ...]

    @property
    def good(self) -> bool:
        """Proven, and every mistake was found."""
        return self.verdict.holds and all(found(twin) for _, twin in self.twins)

    @property
    def seconds(self) -> float:
        """Of proof and twins together."""
        return self.verdict.seconds + sum(twin.seconds for _, twin in self.twins)


def found(twin: cbmc.Verdict) -> bool:
    """Was the mistake found? One that only makes CBMC give up is not."""
    return bool(twin.failures)


def word(verdict: cbmc.Verdict) -> str:
    """The verdict in a word."""
    return "proven" if verdict.holds else "undecided" if verdict.trouble else "REFUTED"


def line(outcome: Outcome) -> str:
    """One row of the terminal's table."""
    refuted = sum(found(twin) for _, twin in outcome.twins)
    return (
        f"{outcome.name:22} {outcome.verdict.properties:10} {outcome.seconds:8.1f}  {word(outcome.verdict):10} "
        f"{refuted} of {len(outcome.twins)} found"
    )


def trouble(outcome: Outcome) -> str:
    """What is wrong, where, and the inputs that show it; nothing if all is well."""
    lines = []
    if outcome.verdict.trouble:
        lines.append(f"{outcome.name}: {outcome.verdict.trouble}")
    for failure in outcome.verdict.failures:
        lines.append(f"{outcome.name}: {failure}")
    if outcome.verdict.trace:
        lines.append("    with")
        lines += [f"    {step.what} = {step.value}    ({step.where})" for step in outcome.verdict.trace[:60]]
    for change, twin in outcome.twins:
        if not found(twin):
            lines.append(f"{outcome.name}: the proof does not notice {change} {twin.trouble}".rstrip())
    return "\n".join(lines)


def record(outcome: Outcome) -> str:
    """All that a run has shown, to read beside the page."""
    lines = [
        f"{outcome.name}: {word(outcome.verdict)}, {outcome.verdict.properties} properties, {outcome.seconds:.0f} s",
        f"claim: {outcome.claim}",
        f"for: {outcome.bound}",
        f"functions: {', '.join(outcome.functions)}",
        *(f"stands on: {item}" for item in outcome.stands_on),
    ]
    for change, twin in outcome.twins:
        lines.append(f"mistake: {' '.join(change.split())}\n    {(twin.failures or ('NOT FOUND ' + twin.trouble,))[0]}")
    said = trouble(outcome)
    return "\n".join([*lines, *([said] if said else [])]) + "\n"


@dataclass(frozen=True)
class Row:
    """What the page keeps of a run."""

    name: str
    verdict: str
    mistakes: str
    commit: str

    @staticmethod
    def of(outcome: Outcome, commit: str) -> Row:
        refuted = sum(found(twin) for _, twin in outcome.twins)
        return Row(outcome.name, word(outcome.verdict), f"{refuted} of {len(outcome.twins)}", commit)


def line_of_page(row: Row, brief: str, bound: str, text_has_changed: bool) -> str:
    """A claim's line of the page."""
    of = f"{row.commit}, text changed since" if text_has_changed else row.commit
    return f"| `{row.name}`: {brief} | {bound} | {row.verdict} | {row.mistakes} | {of} |"


def rows_of(page: str) -> dict[str, Row]:
    """What a page says of each claim."""
    rows = {}
    for line in page.splitlines():
        if line.startswith("| `"):
            name, (verdict, mistakes, of) = line.split("`")[1], [cell.strip() for cell in line.split("|")[-4:-1]]
            rows[name] = Row(name, verdict, mistakes, of.split(",")[0])
    return rows


def page(lines: list[str], version: str) -> str:
    """docs/proofs.md."""
    return INTRODUCTION.format(version=version) + "\n".join(lines) + "\n" + LAST_LINE
