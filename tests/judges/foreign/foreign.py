"""Runs the foreign benchmark: makes the cases, seals the answers, diagnoses every case, judges, writes the page.

usage: foreign.py [--development] [--parts joint,loading,ringing,measured] [--only TEXT] [--cases N] [--no-baselines]
       [--seed S] [--whole] [--out FOLDER]
An interrupted run goes on where it was; a changed tool starts anew. --only: cases whose `group/kind` holds the text.
--cases: the first N in the order of their names, which the seed draws. Each part keeps its rows in foreign.json, and
the page is made of all that are there (kept.py): the parts may be run one after the other."""

from __future__ import annotations

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), *(str(HERE.parent / name) for name in ("blind", "engine")), str(HERE.parents[2] / "tools")]

import one_thread  # noqa: E402, F401, I001  before numpy is loaded

import argparse  # noqa: E402
import json  # noqa: E402
import time  # noqa: E402

import baselines_here  # noqa: E402
import diagnoser  # noqa: E402
import foreign_report  # noqa: E402
import kept  # noqa: E402
import measured  # noqa: E402
import plans  # noqa: E402
import sets  # noqa: E402
from run import in_turn, read  # noqa: E402
from verdicts import Word, judge  # noqa: E402


PARTS = ("joint", "loading", "ringing", "measured")


def job(job: tuple[str, str, str]) -> str:
    """One diagnosis."""
    root, results, name = Path(job[0]), Path(job[1]), job[2]
    out = results / "main" / name
    if not (out / "done").exists():
        diagnoser.diagnose(root / "cases" / name, out, report=False)
        (out / "done").touch()
    return name


def judged(root: Path, results: Path, names: list[str], main: str = "main") -> list[Word]:
    """Every case that has been diagnosed."""
    words = []
    for name in names:
        out = results / main / name
        truth = read(root / "answers" / name / "truth.json")
        words.append(judge(truth, read(out / "diagnosis.json"), read(out / "run.json")))
    return words


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--foreign", action="store_true", help="this benchmark; what ./dev blind passes on")
    parser.add_argument("--development", action="store_true", help="the development seed")
    parser.add_argument("--parts", default=",".join(PARTS), help="which of them")
    parser.add_argument("--only", default="", help="cases whose group/kind holds this text")
    parser.add_argument("--cases", type=int, help="so many of the plan, the first in the order of their names")
    parser.add_argument("--seed", type=int, help="another seed")
    parser.add_argument("--whole", action="store_true", help="of another seed as many cases as of the test's")
    parser.add_argument(
        "--no-baselines", action="store_true", help="not beside the tool: forward selection, five numbers"
    )
    parser.add_argument("--processes", type=int, default=1)
    parser.add_argument("--out", type=Path, help="folder of page and figures; default build/foreign for the test set, else that of the results")
    options = parser.parse_args()
    try:
        diagnoser.require()
    except Exception as error:
        print(f"blind: the tool cannot run: {error}; try: ./dev setup", file=sys.stderr)
        return 4
    seed = options.seed or (plans.DEVELOPMENT_SEED if options.development else plans.TEST_SEED)
    test = seed == plans.TEST_SEED
    plan = plans.TEST if test or options.whole else plans.DEVELOPMENT
    if test:
        print("the test set: its figures are for reporting, not for tuning", file=sys.stderr)
    label = "test" if test else "dev" if seed == plans.DEVELOPMENT_SEED else "seed"
    parts = options.parts.split(",")
    root = sets.BUILD / f"{label}-{seed}"
    wanted = [case for case in sets.cases(seed, plan)
              if case.part in parts and options.only in f"{case.group}/{case.kind}"]  # fmt: skip
    planned, wanted = wanted, wanted[: options.cases]
    seal = sets.make(wanted, root)
    results = root / f"results-{diagnoser.version()}-{sets.sources_hash()[:6]}"
    begun = time.monotonic()
    names = [case.name for case in wanted]
    in_turn("diagnosing", job, [(str(root), str(results), name) for name in names], options.processes)
    words = judged(root, results, names)
    beside: list[Word] = []
    if not options.no_baselines:
        rival = root / f"baselines-{baselines_here.version()}-{sets.sources_hash()[:6]}"
        rivalled = [case.name for case in wanted if case.part != "ringing"]
        jobs = [(str(root), str(rival), name) for name in rivalled]
        in_turn("baselines", baselines_here.job, jobs, options.processes)
        beside = judged(root, rival, rivalled)
    public, where = {}, measured.folder()
    if "measured" in parts and where is None:
        print("no measured sets: BRACE_REAL_DATA does not name a folder", file=sys.stderr)
    elif "measured" in parts and where is not None and not options.only:
        public = measured.all_of(where, results / "measured", lambda name: print(f"measured: {name}", file=sys.stderr))
    if sets.seal_of(root) != seal:
        raise RuntimeError("the seal changed during the run")
    command = "./dev blind --foreign" + (" --development" if options.development else "")
    command += f" --parts {options.parts}" if set(parts) != set(PARTS) else ""
    command += f" --only {options.only}" if options.only else ""
    command += f" --cases {options.cases}" if options.cases else ""
    how = {"command": command, "seed": seed, "tool": diagnoser.version()}
    sealed = {"set": {"dev": "development"}.get(label, label), "seal_sha256": seal, "generator": sets.sources_hash()}
    out = options.out or (sets.BUILD if test and not options.only else results)
    done = kept.read(out / "foreign.json")
    for part in ("joint", "loading", "ringing"):
        here = [w for w in words if w.truth["part"] == part]
        if here:
            size = {"cases": len(here), "of_plan": sum(case.part == part for case in planned)}
            done[part] = kept.part_of(here, [w for w in beside if w.truth["part"] == part], {**how, **sealed, **size})
    if public:
        done["measured"] = {"made": how, "public": public}
    table, page, figures = foreign_report.made(done)
    out.mkdir(parents=True, exist_ok=True)
    text = kept.text(figures)
    (out / "foreign.md").write_text(page)
    (out / "foreign.json").write_text(text)
    (results / "judged.json").write_text(json.dumps(foreign_report.by_case(words), indent=1) + "\n")
    print(table)
    print(
        f"\n{time.monotonic() - begun:.0f} s; page in {out / 'foreign.md'}, cases in {results / 'judged.json'}",
        file=sys.stderr,
    )
    return 0


if __name__ == "__main__":
    sys.exit(main())
