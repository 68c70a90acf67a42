"""Runs the blind benchmark: makes the cases, seals the answers, diagnoses every case, judges, and writes a page
of tables and figures below build/. The page of docs/ has the main table by hand.

usage: run.py [--engine | --finite] [--development] [--cases N] [--seed S] [--only N] [--minutes M] [--processes P]
              [--out FOLDER]
N is a number or a plan, as generate.py says.
An interrupted run goes on where it was; a changed tool starts anew. --only and --minutes take the cases in the order of
their names, which is random and the same in every run; the report says how many of the plan they were."""

from __future__ import annotations

import one_thread  # noqa: F401, I001  before numpy is loaded

import argparse
import importlib.util
import json
import math
import multiprocessing
import os
import sys
import time
from collections.abc import Callable, Iterable
from concurrent.futures import FIRST_COMPLETED, ProcessPoolExecutor, wait
from itertools import islice
from pathlib import Path
from typing import Any

import best
import diagnoser
import follow_up
import report
from generate import cases_of, default_folder, generate, generator_hash, seal_of, total
from scoring import STRONG, Judged, gap_n, judge
from worlds import SIMULATOR, options_of_world, world_called

SAME_BYTES_CASES = 16
SEEDS_CASES = 25
SEEDS = (1, 2, 3, 4)
THREE_FILES = ("diagnosis.json", "limb.toml", "report.html")


def read(path: Path) -> dict[str, Any]:
    """A JSON file, or nothing."""
    if not path.exists():
        return {}
    content: dict[str, Any] = json.loads(path.read_text())
    return content


def _gap_counts(root: Path, name: str) -> bool:
    """Whether the gap on unseen poses is scored: of single effects and pairs."""
    return read(root / "answers" / name / "truth.json").get("kind") in ("single", "pair")


def _main_job(job: tuple[str, str, str, bool]) -> str:
    """First diagnosis of a case, and what the believed and the corrected model predict for unseen poses."""
    root, results, name, with_report = Path(job[0]), Path(job[1]), job[2], job[3]
    out, case = results / "main" / name, root / "cases" / name
    if (out / "done").exists():
        return name
    diagnoser.diagnose(case, out, report=with_report)
    unseen = root / "answers" / name / "holdout"
    if _gap_counts(root, name) and (out / "diagnosis.json").exists():
        try:
            diagnoser.predict(unseen, case / "limb.toml", out / "holdout_before.csv")
            diagnoser.predict(unseen, out / "limb.toml", out / "holdout_after.csv")
        except Exception as error:  # an exported model that cannot be played is the tool's fault
            (out / "holdout_after.csv").unlink(missing_ok=True)
            (out / "unplayable").write_text(str(error))
    world_called(read(root / "answers" / name / "truth.json").get("world", "simulator")).judge_besides(root, name, out)
    (out / "done").touch()
    return name


def _seed_job(job: tuple[str, str, str, int]) -> str:
    root, results, name, seed = Path(job[0]), Path(job[1]), job[2], job[3]
    out = results / (f"seed{seed}" if seed else "again") / name
    if not (out / "done").exists():
        diagnoser.diagnose(root / "cases" / name, out, seed, report=not seed)
        (out / "done").touch()
    return name


def _next_job(job: tuple[str, str, str]) -> str:
    root, results, name = Path(job[0]), Path(job[1]), job[2]
    out = results / "next" / name
    if (out / "done").exists():
        return name
    rig = (read(results / "main" / name / "diagnosis.json").get("next_experiment") or {}).get("rig_toml", "")
    try:
        follow_up.play(root / "answers" / name, rig, root / "cases" / name, out / "together", out / "alone")
        diagnoser.diagnose(out / "together", out, report=False)
        if read(out / "diagnosis.json").get("verdict", "data_fault") == "data_fault":  # takes no empty cells
            diagnoser.diagnose(out / "alone", out, report=False)
    except Exception as error:
        out.mkdir(parents=True, exist_ok=True)
        (out / "run.json").write_text(json.dumps({"unplayed": f"{type(error).__name__}: {error}"}))
    (out / "done").touch()
    return name


def _best_job(job: tuple[str, str]) -> str:
    best.gaps(Path(job[0]), job[1])
    return job[1]


def in_turn(
    what: str, work: Callable[[Any], str], jobs: list[Any], processes: int, until_s: float = math.inf
) -> list[str]:
    """Runs jobs on some processes and says how far it is; an error when one of the processes is lost. Returns what was
    done: from `until_s` on, of time.monotonic(), it begins no more."""
    if not jobs:
        return []
    begun, finished = time.monotonic(), []
    with ProcessPoolExecutor(processes, multiprocessing.get_context("spawn")) as pool:
        left = iter(jobs)
        running = {pool.submit(work, job) for job in islice(left, 2 * processes)}
        while running:
            done, running = wait(running, return_when=FIRST_COMPLETED)
            finished += [job.result() for job in done]
            if time.monotonic() < until_s:
                running |= {pool.submit(work, job) for job in islice(left, len(done))}
            spent, count = time.monotonic() - begun, len(finished)
            still_s = spent / count * (len(jobs) - count)
            print(
                f"\r{what}: {count}/{len(jobs)}, {spent:.0f} s, about {still_s:.0f} s left   ",
                end="" if running else "\n", file=sys.stderr, flush=True,
            )  # fmt: skip
    return finished


def judge_all(root: Path, results: Path, names: Iterable[str]) -> list[Judged]:
    """Judges every case's first diagnosis."""
    out = []
    for name in names:
        truth, folder = read(root / "answers" / name / "truth.json"), results / "main" / name
        j = judge(truth, read(folder / "diagnosis.json"))
        run = read(folder / "run.json")
        if run.get("report"):
            j.seconds, j.cpu_seconds = float(run.get("seconds", 0.0)), float(run.get("cpu_seconds", 0.0))
        stiff = read(folder / "k_under_load.json")
        j.stiffer = (stiff["believed"], stiff["exported"]) if stiff else None
        j.note = str(run.get("crashed", run.get("refused", "")))
        unseen = root / "answers" / name / "holdout" / "data.csv"
        if j.kind in ("single", "pair") and j.exported and (folder / "holdout_before.csv").exists():
            j.gap_before_n = gap_n(unseen, folder / "holdout_before.csv")
            if j.gap_before_n > report.VISIBLE_GAP_N:
                after = folder / "holdout_after.csv"
                j.closed = 1.0 - gap_n(unseen, after) / j.gap_before_n if after.exists() else -1.0
                best = read(root / "best" / f"{name}.json")
                j.closable = 1.0 - best["best"] / best["believed"] if best else None
        out.append(j)
    return out


def after_next(root: Path, results: Path, judged: list[Judged]) -> dict[str, Any]:
    """Exactly right after the tool's own next experiment, over single effects of s = 12 and more: those for which
    it proposes none are counted as they stand."""
    rows = []
    for j in judged:
        if j.kind != "single" or j.s < STRONG:
            continue
        folder, before = results / "next" / j.id, j.flags["exact"] and j.flags["where"] and j.verdict == "effect"
        run, found = read(folder / "run.json"), read(folder / "diagnosis.json")
        proposed = read(results / "main" / j.id / "diagnosis.json").get("next_experiment") or {}
        played = bool(found)
        right = before
        exact = j.flags["exact"]
        if played:
            k = judge(read(root / "answers" / j.id / "truth.json"), found)
            right, exact = k.flags["exact"] and k.flags["where"] and k.verdict == "effect", k.flags["exact"]
        rows.append(
            {
                "id": j.id,
                "was": j.verdict,
                "played": played,
                "exact_before": j.flags["exact"],
                "exact_after": exact,
                "right_before": before,
                "right_after": right,
                "promised": proposed.get("power") if j.truth[0] in proposed.get("separates", ()) else None,
                "why_not": run.get("unplayed", run.get("crashed", "")),
            }
        )
    return {"cases": rows}


def steadiness(results: Path, names: list[str], seeds_names: list[str]) -> dict[str, Any]:
    """Same bytes twice; same verdict and effects with five seeds."""
    same = [
        all(
            (results / "main" / n / f).exists() == (results / "again" / n / f).exists()
            and (
                not (results / "main" / n / f).exists()
                or (results / "main" / n / f).read_bytes() == (results / "again" / n / f).read_bytes()
            )
            for f in THREE_FILES
        )
        for n in names
    ]

    def said(folder: Path) -> tuple[Any, ...]:
        found = read(folder / "diagnosis.json")
        return found.get("verdict"), tuple(sorted(f"{e['name']}@{e['where']}" for e in found.get("effects", [])))

    steady = []
    for n in seeds_names:
        first = said(results / "main" / n)
        steady += [said(results / f"seed{s}" / n) == first for s in SEEDS]
    return {"same_bytes": (sum(same), len(same)), "same_verdict": (sum(steady), len(steady))}


def beside_baselines(
    root: Path, results: Path, names: list[str], judged: list[Judged], processes: int
) -> dict[str, Any]:
    """Other ways to choose, on the same cases; nothing where their libraries are not there."""
    if any(importlib.util.find_spec(library) is None for library in ("sklearn", "pysindy")):
        print("no baselines: scikit-learn and pysindy are not installed (pip install 'tools[blind]')", file=sys.stderr)
        return {}
    from baselines import compare, run_case

    in_turn("baselines", run_case.job, [(str(root), str(results), n) for n in names], processes)
    return compare.comparison(root, results, judged)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options_of_world(parser)
    parser.add_argument("--development", action="store_true", help="the development seed")
    parser.add_argument("--cases", type=cases_of, help="how many, or a plan")
    parser.add_argument("--only", type=int, help="of the plan, make and diagnose only the first so many")
    parser.add_argument("--minutes", type=float, default=math.inf, help="begin no diagnosis after so many")
    parser.add_argument("--seed", type=int, help="another seed")
    parser.add_argument("--processes", type=int, default=min(2, os.cpu_count() or 1))
    parser.add_argument("--out", type=Path, help="folder of page and figures; default: that of the results, below build/")
    parser.add_argument("--quick", action="store_true", help="no next experiments, no repeats, no other seeds")
    options = parser.parse_args()
    world = world_called(options.world)
    seed, cases = world.seed_and_cases(options.seed, options.cases, options.development)
    try:
        diagnoser.require()
    except Exception as error:
        print(f"blind: the tool cannot run: {error}; try: ./dev setup", file=sys.stderr)
        return 4
    root, version = default_folder(seed, cases, world), diagnoser.version()
    if seed == world.test_seed:
        print("the test set: its figures are for reporting, not for tuning", file=sys.stderr)
    seal = generate(seed, cases, root, options.processes, world=world, first=options.only)
    print(f"answers sealed before the run: sha256 {seal}", file=sys.stderr)
    results = root / f"results-{version}-{generator_hash(world)[:6]}"
    results.mkdir(exist_ok=True)
    names = sorted(path.name for path in (root / "cases").iterdir())

    begun = time.monotonic()
    jobs = [(str(root), str(results), n, k < world.reported_cases) for k, n in enumerate(names)]
    names = sorted(in_turn("diagnosing", _main_job, jobs, options.processes, begun + 60.0 * options.minutes))
    followed_up = names if world.follows_up else []
    missing = [(str(root), n) for n in followed_up if _gap_counts(root, n) and not (root / "best" / f"{n}.json").exists()]
    in_turn("what could be closed", _best_job, missing, options.processes)
    judged = judge_all(root, results, names)
    again, seeds_names = [], []
    if world.follows_up and not options.quick:
        again, seeds_names = names[:SAME_BYTES_CASES], names[SAME_BYTES_CASES : SAME_BYTES_CASES + SEEDS_CASES]
        proposed = [
            j.id for j in judged
            if j.kind == "single" and j.s >= STRONG
            and (read(results / "main" / j.id / "diagnosis.json").get("next_experiment") or {}).get("rig_toml")
        ]  # fmt: skip
        in_turn("next experiments", _next_job, [(str(root), str(results), n) for n in proposed], options.processes)
        repeats = [(str(root), str(results), n, 0) for n in again]
        repeats += [(str(root), str(results), n, s) for n in seeds_names for s in SEEDS]
        in_turn("again, other seeds", _seed_job, repeats, options.processes)
    beside = beside_baselines(root, results, names, judged, options.processes) if world.follows_up else {}
    if seal_of(root) != seal:
        raise RuntimeError("the seal changed during the run")
    made = {
        "world": world.name,
        "seed": seed,
        "cases": len(names),
        "planned": total(cases),
        "unmade": len(list((root / "unmade").iterdir())) if (root / "unmade").exists() else 0,
        "set": {world.development_seed: "development", world.test_seed: "test"}.get(seed, "other"),
        "seal_sha256": seal,
        "generator_sha256": generator_hash(world),
        "tool": version,
    }
    command = "./dev blind" + (f" --{world.name}" if world is not SIMULATOR else "")
    command += " --development" if options.development else ""
    command += f" --cases {options.cases}" if options.cases else ""
    command += f" --seed {options.seed}" if options.seed is not None else ""
    command += f" --only {options.only}" if options.only else ""
    command += f" --minutes {options.minutes:g}" if math.isfinite(options.minutes) else ""
    if world.report:
        found = world.report(judged, made, command)
    else:
        after, steady = after_next(root, results, judged), steadiness(results, again, seeds_names)
        figures = report.figures(judged, after, steady, made)
        figures["lines"] += beside.get("lines", [])
        figures |= {key: value for key, value in beside.items() if key != "lines"}
        found = report.table(figures), report.page(figures, judged, command), report.as_json(figures)
    table, text, content = found
    out = options.out or results
    out.mkdir(parents=True, exist_ok=True)
    (out / f"{world.page}.md").write_text(text)
    (out / f"{world.page}.json").write_text(json.dumps(content, indent=1) + "\n")
    (results / "judged.json").write_text(json.dumps(report.cases_as_json(judged), indent=1) + "\n")
    print(table)
    places = f"page in {out / world.page}.md, every case in {results / 'judged.json'}"
    print(f"\n{time.monotonic() - begun:.0f} s; {places}", file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main())
