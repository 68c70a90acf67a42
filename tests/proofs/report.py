"""What the proofs say, as lines for a terminal and as docs/proofs.md."""

from __future__ import annotations

from dataclasses import dataclass

import cbmc

HEAD = f"{'proof':22} {'properties':>10} {'seconds':>8}  {'verdict':10} broken on purpose"

INTRODUCTION = """# What is proven

`./dev proofs` writes this page. Each claim below holds for **every** input within its bound, not for samples of it:
[CBMC](https://github.com/diffblue/cbmc) {version} turns the firmware's own C, as a Cortex-M4F's compiler reads it (32-bit
integers and pointers), into one formula and finds no input that breaks it. Beside each claim it checks every array index,
pointer, shift, division and signed overflow on the way, and that no loop goes further than the bound says.

`fixed_lengths` and `loaded_turns` are no formulas: there the firmware's text runs through all inputs, one after the
other. Nor is `loaded_softened`: there it runs with ranges (`tests/proofs/harness/ranged.h`).

A proof that cannot fail proves nothing: every one is run again on code with a mistake put in, and has to find it. The
mistakes stand at the end. What a proof takes from elsewhere stands under *stands on*: a function that has its own proof is
replaced by what that proof promises, and the outside (memory, ports, drives) by something that may answer anything.

CBMC's own checks know where an object ends, not where an array inside a struct does: there the claims name the bounds
themselves, and what none of them names is not noticed before it leaves the struct (the sanitized tests and fuzzers look
there too).

Not proven here: what the floating-point results are worth (property tests and the reference judge that), time (the bench
counts instructions), interrupts, and what compilers make of the C.
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


def _code(text: str) -> str:
    fence = "``" if "`" in text else "`"
    return f"{fence}{' '.join(text.split())}{fence}".replace("|", "\\|")


def _start(text: str) -> str:
    """The first lines of what a harness says, in one: what there is, and where it begins."""
    return "; ".join(text.splitlines()[:3]).replace("|", "\\|")


COLUMNS = "| claim | functions | for | stands on | properties | seconds | verdict | run at |"


def kept_rows(earlier: str, name: str) -> list[str]:
    """The row of a proof in an earlier page, and those of its mistakes."""
    return [line for line in earlier.splitlines() if line.startswith((f"| **{name}**:", f"| {name} |"))]


def page(
    order: list[str], outcomes: dict[str, Outcome], version: str, commit: str, earlier: str, earlier_commit: str
) -> str:
    """docs/proofs.md. order: names of all proofs; commit: of the text that the outcomes are of; earlier: the page as it
    was at its own commit, from which the rows of proofs come that have not been run since."""
    lines = [INTRODUCTION.format(version=version)]
    lines += [COLUMNS, "|---|---|---|---|---|---|---|---|"]
    has_commits = COLUMNS in earlier
    for name in order:
        outcome = outcomes.get(name)
        if outcome is None:
            row = next((line for line in kept_rows(earlier, name) if line.startswith("| **")), "")
            lines += [row if has_commits or not row else f"{row} {earlier_commit} |"] if row else []
            continue
        functions = ", ".join(_code(name) for name in outcome.functions)
        lines.append(
            f"| **{outcome.name}**: {outcome.claim} | {functions} | {outcome.bound} | "
            f"{'; '.join(outcome.stands_on) or '-'} | {outcome.verdict.properties} | "
            f"{outcome.verdict.seconds:.0f} | {word(outcome.verdict)} | {commit} |"
        )
    lines += [
        "",
        f"{len(order)} claims. *Run at* names the commit of the text that a claim was proven of; a claim whose text "
        "has changed since then is to be run again. Seconds are by the clock, on a machine that had other work.",
        "",
    ]
    lines += ["| proof | mistake put in | found as |", "|---|---|---|"]
    for name in order:
        outcome = outcomes.get(name)
        if outcome is None:
            lines += [line for line in kept_rows(earlier, name) if not line.startswith("| **")]
            continue
        for change, twin in outcome.twins:
            said = _start(twin.failures[0]) if twin.failures else f"**not found** {twin.trouble}"
            lines.append(f"| {outcome.name} | {_code(change)} | {said} |")
    return "\n".join(lines) + "\n"
