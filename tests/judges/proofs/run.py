"""Prove the claims of proofs.toml, show that each proof can fail, and write docs/proofs.md.

usage: run.py [--only NAME ...] [--jobs N] [--seconds-most S] [--afresh] [--list]

What was proven of the same text with the same bounds is kept in build/proofs and not proven again.
"""

from __future__ import annotations

import argparse
import concurrent.futures
import hashlib
import os
import pathlib
import pickle
import re
import shutil
import subprocess
import sys
import tomllib
from dataclasses import dataclass, field

import cbmc
import counted
import report

HERE = pathlib.Path(__file__).resolve().parent
BUILD = cbmc.ROOT / "build" / "proofs"
COMPILER = os.environ.get("BRACE_PROOFS_CC", "arm-none-eabi-gcc")


@dataclass(frozen=True)
class Broken:
    """A mistake put into the code that the proof has to find."""

    old: str
    new: str
    seconds_most: float


@dataclass(frozen=True)
class Proof:
    """One claim, as proofs.toml has it."""

    name: str
    claim: str
    brief: str = field(repr=False)  # claim and bound in a few words, for the page; the kept record does not contain them
    brief_bound: str = field(repr=False)
    functions: tuple[str, ...]
    bound: str
    stands_on: tuple[str, ...]  # what is replaced by a stand-in, and the proof that allows it
    sources: tuple[str, ...]
    unwind: int
    unwindset: dict[str, int]
    conversions: bool
    counted: bool  # run on this machine, input by input or with ranges of numbers, instead of by CBMC
    options: tuple[str, ...]
    broken: tuple[Broken, ...]


def read_proofs() -> list[Proof]:
    """proofs.toml; every proof has a broken twin."""
    table = tomllib.loads((HERE / "proofs.toml").read_text())
    proofs = []
    for item in table["proof"]:
        broken = tuple(Broken(twin["old"], twin["new"], 900.0) for twin in item["broken"])
        if not broken:
            raise SystemExit(
                f"proofs.toml: {item['name']}: no broken twin, so nothing shows that it can fail"
            )
        proofs.append(
            Proof(
                item["name"],
                " ".join(item["claim"].split()),
                item["brief"][0],
                item["brief"][1],
                tuple(item["functions"]),
                " ".join(item["bound"].split()),
                tuple(item.get("stands_on", ())),
                tuple(item["sources"]),
                item["unwind"],
                dict(item.get("unwindset", {})),
                bool(item.get("conversions", False)),
                bool(item.get("counted", False)),
                tuple(item.get("options", ())),
                broken,
            )
        )
    return proofs


def program(proof: Proof, into: pathlib.Path) -> cbmc.Program:
    """The proof's files, preprocessed."""
    shutil.rmtree(into, ignore_errors=True)
    into.mkdir(parents=True)
    if proof.counted:
        return cbmc.Program((counted.preprocess(counted.source_of(proof.name), into),), proof.unwind)
    sources = [HERE / "harness" / f"{proof.name}.c", *(cbmc.ROOT / source for source in proof.sources)]
    files = tuple(cbmc.preprocess(COMPILER, source, into) for source in sources)
    return cbmc.Program(files, proof.unwind, proof.unwindset, proof.conversions, proof.options)


def breaks(whole: cbmc.Program, twin: Broken, into: pathlib.Path) -> cbmc.Program:
    """A copy of the program with the mistake in."""
    shutil.rmtree(into, ignore_errors=True)
    into.mkdir(parents=True)
    files, places = [], 0
    pattern = re.compile(r"\s+".join(re.escape(word) for word in twin.old.split()))
    for file in whole.files:
        text, count = pattern.subn(lambda _: twin.new, file.read_text())
        places += count
        copy = into / file.name
        copy.write_text(text)
        files.append(copy)
    if places == 0:
        raise SystemExit(
            f"proofs.toml: {into.parent.name}: the code has no {twin.old!r} any more to be broken"
        )
    return cbmc.Program(tuple(files), whole.unwind, whole.unwindset, whole.conversions, whole.options)


def key_of(proof: Proof, whole: cbmc.Program, version: str) -> str:
    """Of everything that the outcome follows from."""
    text = hashlib.sha256(repr((proof, cbmc.CHECKS, version)).encode())
    for file in whole.files:
        text.update(file.read_bytes())
    return text.hexdigest()


def prove(proof: Proof, tool: str, version: str, seconds_most: float, afresh: bool) -> report.Outcome:
    """The claim, then its broken twins; or what is known of them."""
    earlier = None if afresh else known(proof, version)
    if earlier is not None:
        return earlier
    whole = program(proof, BUILD / proof.name / "whole")
    outcome = prove_now(proof, whole, tool, seconds_most)
    if outcome.good:
        (BUILD / proof.name / "outcome").write_bytes(pickle.dumps((key_of(proof, whole, version), outcome)))
    return outcome


def known(proof: Proof, version: str) -> report.Outcome | None:
    """What is known of it from an earlier run, of the text as it is now."""
    whole = program(proof, BUILD / proof.name / "whole")
    kept = BUILD / proof.name / "outcome"
    key, outcome = pickle.loads(kept.read_bytes()) if kept.is_file() else ("", None)
    return outcome if key == key_of(proof, whole, version) and isinstance(outcome, report.Outcome) else None


def prove_now(proof: Proof, whole: cbmc.Program, tool: str, seconds_most: float) -> report.Outcome:
    """The same, from CBMC."""
    if proof.counted:
        verdict = counted.check(whole.files[0], seconds_most)
    else:
        verdict = cbmc.check(tool, whole, seconds_most)
    if verdict.failures and not proof.counted:
        verdict = cbmc.Verdict(
            False,
            verdict.properties,
            verdict.seconds,
            verdict.failures,
            cbmc.refute(tool, whole, seconds_most).trace,
        )
    twins = []
    for number, twin in enumerate(proof.broken):
        copy = breaks(whole, twin, BUILD / proof.name / f"broken{number}")
        found = counted.check(copy.files[0], seconds_most) if proof.counted else cbmc.refute(tool, copy, seconds_most)
        twins.append((f"{twin.old} → {twin.new}", found))
    return report.Outcome(
        proof.name, proof.claim, proof.functions, proof.bound, proof.stands_on, verdict, tuple(twins)
    )


def find_cbmc() -> tuple[str, str]:
    """The command and its version."""
    found = subprocess.run(
        [cbmc.ROOT / "tests" / "fetch" / "cbmc"], capture_output=True, text=True, check=False
    )
    if found.returncode != 0:
        print(found.stderr.strip(), file=sys.stderr)
        raise SystemExit(found.returncode)
    tool = found.stdout.strip()
    version = subprocess.run([tool, "--version"], capture_output=True, text=True, check=True).stdout.split()[
        0
    ]
    return tool, version


def git(*arguments: str) -> str:
    """What git prints, in the project's folder."""
    done = subprocess.run(["git", *arguments], cwd=cbmc.ROOT, capture_output=True, text=True, check=False)
    return done.stdout.strip()


def text_has_changed(proof: Proof, commit: str) -> bool:
    """Is a file that this proof reads another one than at the commit?"""
    marks = "".join(file.read_text() for file in program(proof, BUILD / proof.name / "whole").files)
    read = set(re.findall(r'^# \d+ "((?:firmware|hal|tests)/[^"]+)"', marks, re.MULTILINE))
    differs = ["git", "diff", "--quiet", commit, "--", *sorted(read)]
    return subprocess.run(differs, cwd=cbmc.ROOT, capture_output=True, check=False).returncode != 0


def write_page(proofs: list[Proof], outcomes: dict[str, report.Outcome], version: str) -> None:
    """The record of each run, and docs/proofs.md: what was run now; the others as they were, if of an earlier text."""
    path = cbmc.ROOT / "docs" / "proofs.md"
    kept = report.rows_of(path.read_text() if path.is_file() else "")
    rows = []
    for proof in proofs:
        outcome, row = outcomes.get(proof.name), kept.get(proof.name)
        if outcome is not None:
            (BUILD / f"{proof.name}.txt").write_text(report.record(outcome))
            row = report.Row.of(outcome, git("rev-parse", "--short=8", "HEAD"))
        if row is not None:
            changed = outcome is None and text_has_changed(proof, row.commit)
            rows.append(report.line_of_page(row, proof.brief, proof.brief_bound, changed))
    whole = BUILD / path.name
    whole.write_text(report.page(rows, version))
    whole.replace(path)


def main() -> int:
    parser = argparse.ArgumentParser(
        description="prove the claims of tests/judges/proofs/proofs.toml; writes docs/proofs.md"
    )
    parser.add_argument(
        "--only", nargs="+", metavar="NAME", help="these proofs; the other rows of docs/proofs.md stay as they are"
    )
    parser.add_argument(
        "--jobs", type=int, default=os.cpu_count() or 1, help="at a time (default: one a core)"
    )
    parser.add_argument(
        "--seconds-most", type=float, default=900.0, help="for one run of CBMC (default: %(default)s)"
    )
    parser.add_argument("--afresh", action="store_true", help="prove again what was proven of the same text")
    parser.add_argument("--list", action="store_true", help="name the claims and prove nothing")
    asked = parser.parse_args()
    proofs = read_proofs()
    unknown = set(asked.only or ()) - {proof.name for proof in proofs}
    if unknown:
        parser.error(
            f"no such proof: {', '.join(sorted(unknown))}; there are {', '.join(p.name for p in proofs)}"
        )
    if asked.list:
        for proof in proofs:
            print(f"{proof.name:22} {proof.claim}")
        return 0
    tool, version = find_cbmc()
    chosen = [proof for proof in proofs if not asked.only or proof.name in asked.only]
    outcomes = {}
    print(report.HEAD)
    with concurrent.futures.ThreadPoolExecutor(asked.jobs) as pool:
        waiting = {
            pool.submit(prove, proof, tool, version, asked.seconds_most, asked.afresh): proof.name
            for proof in chosen
        }
        for done in concurrent.futures.as_completed(waiting):
            outcomes[waiting[done]] = done.result()
            print(report.line(done.result()), flush=True)
    results = [outcomes[proof.name] for proof in chosen]
    for text in filter(None, map(report.trouble, results)):
        print(text)
    good = sum(outcome.good for outcome in results)
    write_page(proofs, outcomes, version)
    print(f"{good} passed, {len(results) - good} failed")
    return 0 if good == len(results) else 1


if __name__ == "__main__":
    try:
        sys.exit(main())
    except cbmc.ToolError as error:
        print(f"proofs: {error}", file=sys.stderr)
        sys.exit(4)
    except KeyboardInterrupt:
        sys.exit(130)
