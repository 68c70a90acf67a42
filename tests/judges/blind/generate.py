"""Makes blind cases: cases/ID/{data.csv,meta.toml,limb.toml}, and apart from them answers/ID/{truth.json,holdout/}.

usage: generate.py [--engine | --finite] [--development] [--cases N] [--seed S] [--out FOLDER]
N is a number, shared out among the kinds as SHARES has it, or a plan: `none=1000,pair=400,single@12=216`.
Every case follows from the seed and its number alone; sealed.sha256 seals them before any diagnosis."""

from __future__ import annotations

import one_thread  # noqa: F401, I001  before numpy is loaded

import argparse
import hashlib
import json
import math
import multiprocessing
import os
import pickle
import shutil
import sys
import time
from collections.abc import Iterable
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path
from typing import Any

import numpy as np

import effects
import spoil
from designs import Design, Rng, Trust, true_limb
from detect import SAME_CLASS, Bench
from files import RANGE_N, limb_text, meta_text, noisy, table_of, write_dataset
from plant import BUILD, IN_LIMB_TOML, INDEX, LINKS, Array
from worlds import SIMULATOR, World, options_of_world, world_called

Cases = int | str  # a number, or a plan
DETECTABILITIES = (3.0, 5.0, 8.0, 12.0, 25.0)
SHARES = {"single": 0.40, "none": 0.30, "pair": 0.12, "triple": 0.03, "outside": 0.09, "data_fault": 0.06}
OUTSIDE_S = (16.0, 25.0, 50.0)
LEFT_BY_CATALOGUE = 8.0  # sigma: what the best single entry of the catalogue must leave of an outsider


def counts_of(cases: Cases) -> dict[str, int]:
    """Cases of each kind, of a number or of a plan. A kind may have its detectability behind an @."""
    if isinstance(cases, str):
        parts = (part.split("=") for part in cases.split(","))
        return {kind: int(count) for kind, count in parts}
    counts = {kind: round(share * cases) for kind, share in SHARES.items()}
    counts["single"] += cases - sum(counts.values())
    return counts


def cases_of(text: str) -> Cases:
    """What a command line says."""
    return int(text) if text.isdigit() else text


def total(cases: Cases) -> int:
    """How many cases a number or a plan means."""
    return sum(counts_of(cases).values())


def schedule(seed: int, cases: Cases) -> list[tuple[str, int]]:
    """Kind and running number within the kind of each case, shuffled: a case's number says nothing."""
    counts = counts_of(cases)
    plan = [(kind, i) for kind, count in counts.items() for i in range(count)]
    order = np.random.default_rng([seed, 1]).permutation(len(plan))
    return [plan[i] for i in order]


INGREDIENTS = "ingredients.pickle"  # in a case's answer: drawing a case anew takes as long as making it
KEPT_PARTS = ("believed", "trust", "shown", "held", "limb")


class Retry(Exception):
    """This draw cannot be made as wanted: draw again."""


class Unmade(Exception):
    """No draw of a case came out as wanted."""


def _parameters(p: Array) -> dict[str, Any]:
    """As limb.toml has them: a link that changed is the link of after the record, and the factor is that of before."""
    out: dict[str, Any] = {key: float(p[INDEX[key]]) for key in IN_LIMB_TOML}
    out["change.link"] = LINKS[int(out["change.link"])]
    out[f"link.{out['change.link']}.bending_mm_per_n"] *= out["change.bending_factor"]
    out["change.bending_factor"] = 1.0 / out["change.bending_factor"]
    return {key: value for key, value in out.items() if not (isinstance(value, float) and math.isinf(value))}


def _classes(world: World, bench: Bench, target: Array, own: str) -> tuple[list[str], dict[str, float]]:
    cosines = bench.cosines(target) if world.classes else {}
    near = {label for label, value in cosines.items() if value > SAME_CLASS} | {own}
    top = dict(sorted(cosines.items(), key=lambda item: -item[1])[:5])
    return sorted(near), {label: round(value, 4) for label, value in top.items()}


def _true_limb_first(
    world: World, rng: Rng, names: Iterable[str], believed: Array, given: Trust, shown: Design
) -> Bench | None:
    """Whether a reading ever reaches a saturation's level hangs on the largest force of the very limb that is played:
    with one among the effects, s is worked out on the true limb. None without."""
    return world.bench(shown, true_limb(rng, believed, given), given) if "sensor_saturation" in names else None


def make_single(world: World, rng: Rng, number: int, wanted: float | None = None) -> dict[str, Any]:
    """One hidden effect: the catalogue in turn, as detectable as wanted, or at each detectability in turn."""
    name, where = effects.CATALOGUE[number % len(effects.CATALOGUE)]
    turn = number // len(effects.CATALOGUE)
    wanted = wanted or DETECTABILITIES[(number + turn) % len(DETECTABILITIES)]
    believed, given, shown, held, left_out = world.setting(rng, [name])
    bench = world.bench(shown, believed, given)
    of_truth = _true_limb_first(world, rng, [name], believed, given, shown)
    bench = of_truth or bench
    hidden = effects.draw(rng, name, where, believed, bench.whole_s, bench.peak_n)
    if name == "moment_transfer" and wanted >= 12.0 and rng.random() < world.whole_beams:
        size, s = 1.0, bench.s_of(hidden.applied(believed, 1.0))  # as it is, whatever that makes it
        if s < world.least_whole_beam_s:
            raise Retry(f"a whole beam reaches {s:.1f}")
        wanted = s
    else:
        size, s = bench.sized(hidden, wanted)
    if not 0.6 * wanted <= s <= 1.1 * wanted or size > hidden.largest:
        raise Retry(f"{hidden.label} reaches {s:.1f} of {wanted}")
    cls, top = _classes(world, bench, bench.record(hidden.applied(bench.believed, size)), hidden.label)
    truth = hidden.applied(of_truth.believed if of_truth else true_limb(rng, believed, given), size)
    truth, besides = world.besides(rng, truth, [name])
    return {
        "believed": believed,
        "left_out": left_out,
        "trust": given,
        "shown": shown,
        "held": held,
        "limb": truth,
        "outsider": None,
        "truth": {
            "kind": "single",
            "effects": [{"name": name, "where": where}],
            "detectability": round(s, 2),
            "wanted": wanted,
            "cls": cls,
            "cosines": top,
            "keys": hidden.free(),
            **besides,
        },
    }


def make_none(world: World, rng: Rng) -> dict[str, Any]:
    """Nothing hidden."""
    believed, given, shown, held, left_out = world.setting(rng, [])
    return {
        "believed": believed,
        "left_out": left_out,
        "trust": given,
        "shown": shown,
        "held": held,
        "limb": true_limb(rng, believed, given),
        "outsider": None,
        "truth": {"kind": "none", "effects": [], "detectability": 0, "cls": []},
    }


def make_many(world: World, rng: Rng, count: int) -> dict[str, Any]:
    """Several effects, each at 12 sigma after refitting the base and the others."""
    wanted = 12.0
    believed, given, shown, held, left_out = world.setting(rng, [])
    chosen = [effects.CATALOGUE[i] for i in rng.choice(len(effects.CATALOGUE), count, replace=False)]
    names = [name for name, _ in chosen]
    if len(set(names)) < count:
        raise Retry("the same name twice")
    believed = world.lacking(believed, names)
    bench = world.bench(shown, believed, given)
    of_truth = _true_limb_first(world, rng, names, believed, given, shown)
    bench = of_truth or bench
    found = [effects.draw(rng, name, where, believed, bench.whole_s, bench.peak_n) for name, where in chosen]
    # one that overwrites another's parameter is no pair
    keys = [key for one in found for key in one.free()]
    if len(set(keys)) < len(keys):
        raise Retry("shared parameters")
    sizes = []
    for one in found:
        size, s = bench.sized(one, wanted)
        if s < 0.9 * wanted:
            raise Retry(f"{one.label} reaches {s:.1f}")
        sizes.append(size)

    def built(skip: int = -1) -> Array:
        p = bench.believed.copy()
        for i, (one, size) in enumerate(zip(found, sizes, strict=True)):
            if i != skip:
                p = one.applied(p, size)
        return p

    reached = [0.0] * count
    for _ in range(8):
        target = bench.record(built())
        for i in range(count):
            others = [key for j, one in enumerate(found) if j != i for key in one.free()]
            reached[i] = math.sqrt(bench.fit(target, built(i), others)[0])
        if all(abs(s - wanted) < 0.06 * wanted for s in reached):
            break
        for i, s in enumerate(reached):
            sizes[i] *= min(max(wanted / max(s, 1e-3), 0.3), 3.0)
            if sizes[i] > found[i].largest:
                raise Retry(f"{found[i].label} is hidden by the others")
    if any(abs(s - wanted) > 0.15 * wanted for s in reached):
        raise Retry("the sizes do not settle")
    alike = []
    for i, one in enumerate(found):  # what each could be taken for, by itself
        alike.append(_classes(world, bench, bench.record(one.applied(bench.believed, sizes[i])), one.label)[0])
    truth = of_truth.believed if of_truth else true_limb(rng, believed, given)
    for one, size in zip(found, sizes, strict=True):
        truth = one.applied(truth, size)
    truth, besides = world.besides(rng, truth, names)
    return {
        "believed": believed,
        "left_out": left_out,
        "trust": given,
        "shown": shown,
        "held": held,
        "limb": truth,
        "outsider": None,
        "truth": {
            "kind": "pair" if count == 2 else "triple",
            "effects": [{"name": one.name, "where": one.where} for one in found],
            "detectability": round(min(reached), 2),
            "each": [round(s, 2) for s in reached],
            "cls": [],
            "cls_each": alike,
            "keys": keys,
            **besides,
        },
    }


def make_outside(world: World, rng: Rng, number: int) -> dict[str, Any]:
    """What the catalogue does not know, and what no single entry of it explains away."""
    name = world.outsiders[number % len(world.outsiders)]
    wanted = OUTSIDE_S[(number // len(world.outsiders)) % len(OUTSIDE_S)]
    believed, given, shown, held, left_out = world.setting(rng, [])
    bench = world.bench(shown, believed, given)
    one = world.draw_outsider(rng, name, believed, bench.whole_s, bench.peak_n, bench.deepest, shown.step_mm)

    def target(size: float) -> Array:
        return bench.in_sigmas(one.play(believed, shown.rows, size, world.play))

    class Sized:
        largest, smallest = one.largest, 1e-7 * one.largest

    for _ in range(3):
        size, s = bench.sized(Sized, wanted, lambda x: bench.s_of_record(target(x)))  # type: ignore[arg-type]
        if s < 0.9 * wanted:
            raise Retry(f"{name} reaches {s:.1f} of {wanted}")
        cosines = bench.cosines(target(size))
        nearest = max(cosines.values())
        if nearest > SAME_CLASS:
            raise Retry(f"{name} is of a class in the catalogue")
        left = s * math.sqrt(1.0 - nearest**2)
        if left >= LEFT_BY_CATALOGUE:
            break
        wanted *= 1.1 * LEFT_BY_CATALOGUE / left
    else:
        raise Retry(f"{name} looks like the catalogue")
    top = dict(sorted(cosines.items(), key=lambda item: -item[1])[:4])
    return {
        "believed": believed,
        "left_out": left_out,
        "trust": given,
        "shown": shown,
        "held": held,
        "limb": true_limb(rng, believed, given),
        "outsider": (one, size),
        "truth": {
            "kind": "outside",
            "effects": [{"name": name, "where": "outside"}],
            "detectability": round(s, 2),
            "left_by_catalogue": round(left, 2),
            "cls": [],
            "cosines": {k: round(v, 4) for k, v in top.items()},
        },
    }


def make_disguised(world: World, rng: Rng, number: int) -> dict[str, Any]:
    """What is outside the catalogue, but known to leave nearly the trace of entries of it: how nearly, in sigmas, the
    answer says (`left_by_catalogue`)."""
    name, alike = world.disguised[number % len(world.disguised)]
    believed, given, shown, held, left_out = world.setting(rng, [])
    bench = world.bench(shown, believed, given)
    one = world.draw_outsider(rng, name, believed, bench.whole_s, bench.peak_n, bench.deepest, shown.step_mm)
    size = one.largest * rng.uniform(0.3, 1.0)
    target = bench.in_sigmas(one.play(believed, shown.rows, size, world.play))
    entries = effects.candidates(believed, shown.rows, bench.peak_n, bench.deepest)
    keys = [key for entry in entries if entry.label in alike for key in entry.keys]
    chi2, at, _ = bench.fit(target, believed)
    alone = max(bench.cosines(target).values(), default=0.0)  # what the best single entry makes up
    left = min(chi2 * (1.0 - min(alone, 1.0) ** 2), bench.fit(target, at, keys, rounds=25)[0])
    return {
        "believed": believed,
        "left_out": left_out,
        "trust": given,
        "shown": shown,
        "held": held,
        "limb": true_limb(rng, believed, given),
        "outsider": (one, size),
        "truth": {
            "kind": "disguised",
            "effects": [{"name": name, "where": "outside"}],
            "detectability": round(math.sqrt(max(0.0, chi2)), 2),
            "left_by_catalogue": round(math.sqrt(max(0.0, left)), 2),
            "cls": [],
            "alike": list(alike),
        },
    }


def make_fault(world: World, rng: Rng, number: int) -> dict[str, Any]:
    """A healthy record, spoiled."""
    case = make_none(world, rng)
    kinds = list(spoil.KINDS)
    case["spoil"] = kinds[number % len(kinds)]
    case["truth"] = {
        "kind": "data_fault",
        "effects": [],
        "detectability": 0,
        "cls": [],
        "fault": case["spoil"],
    }
    return case


def build(kind: str, number: int, rng: Rng, world: World = SIMULATOR) -> dict[str, Any]:
    """One case of a kind."""
    kind, _, level = kind.partition("@")
    if kind == "single":
        return make_single(world, rng, number, float(level) if level else None)
    if kind in ("pair", "triple"):
        return make_many(world, rng, 2 if kind == "pair" else 3)
    if kind == "none":
        return make_none(world, rng)
    return {"outside": make_outside, "disguised": make_disguised, "data_fault": make_fault}[kind](world, rng, number)


def identity(seed: int, index: int) -> str:
    """A case's name."""
    return f"b{hashlib.sha256(f'{seed}/{index}'.encode()).hexdigest()[:6]}"


def drawn(
    seed: int, index: int, cases: Cases, world: World = SIMULATOR
) -> tuple[dict[str, Any], Rng, list[str]]:
    """A case's ingredients, its noise-free readings among them, and the generator to go on with; also why earlier draws
    were given up."""
    kind, number = schedule(seed, cases)[index]
    given_up: list[str] = []
    for attempt in range(60):
        rng = np.random.default_rng([seed, 2, index, attempt])
        try:
            case = build(kind, number, rng, world)
            case["clean"] = clean_readings(case, case["shown"].rows, world)
            forces_n = case["clean"][:, :2]
            if np.max(np.abs(forces_n)) > RANGE_N:
                raise Retry("a force is beyond the sensor's range")
            return case, rng, given_up
        except (Retry, np.linalg.LinAlgError, ArithmeticError, ValueError) as why:
            given_up.append(str(why))
    raise Unmade(f"case {index} ({kind} {number}) cannot be made: {given_up[-3:]}")


def ingredients(answer: Path) -> dict[str, Any]:
    """Limb, designs and trust of a case without an outsider, from the folder of its answer."""
    found: dict[str, Any] = pickle.loads((answer / INGREDIENTS).read_bytes())
    return {**found, "outsider": None}


def clean_readings(case: dict[str, Any], rows: Array, world: World = SIMULATOR) -> Array:
    """Noise-free readings of the case's true limb."""
    if case["outsider"] is not None:
        one, size = case["outsider"]
        result: Array = one.play(case["limb"], rows, size, world.play)
        return result
    return world.play(case["limb"], rows)


def write_case(seed: int, index: int, cases: Cases, out: Path, world: World = SIMULATOR) -> list[str]:
    """Writes one case and its answer; returns why draws were given up."""
    case, rng, given_up = drawn(seed, index, cases, world)
    name = identity(seed, index)
    shown, held, truth = case["shown"], case["held"], case["truth"]
    table = table_of(shown, noisy(rng, shown, case["clean"]))
    if "spoil" in case:
        truth["fields"] = spoil.KINDS[case["spoil"]](rng, table)
    folder, answer = out / "cases" / name, out / "answers" / name
    write_dataset(folder, meta_text(shown, f"case {name}"), table)
    (folder / "limb.toml").write_text(limb_text(case["believed"], case["trust"], f"case {name}", case["left_out"]))
    answer.mkdir(parents=True, exist_ok=True)
    if truth["kind"] != "data_fault":
        readings = held.seen(clean_readings(case, held.rows, world)[:, held.columns])
        meta = meta_text(held, f"holdout {name}", displacements=world.displacements)
        write_dataset(answer / "holdout", meta, table_of(held, readings))
    if case["outsider"] is None:
        (answer / INGREDIENTS).write_bytes(pickle.dumps({part: case[part] for part in KEPT_PARTS}))
    truth = {
        "id": name,
        **truth,
        "seed": seed,
        "index": index,
        "of": cases,
        "world": world.name,
        "rows": len(table["run"]),
        "readings": list(shown.readings),
        "noise": vars(shown.noise),
    }
    if truth["kind"] in ("single", "pair", "triple"):
        truth["true_parameters"] = _parameters(case["limb"])
    (answer / "truth.json").write_text(json.dumps(truth, indent=1) + "\n")
    return given_up


def _job(job: tuple[int, int, Cases, str, str]) -> tuple[int, list[str]]:
    seed, index, cases, out, world = job
    try:
        return index, write_case(seed, index, cases, Path(out), world_called(world))
    except Unmade as why:  # left out, whatever is diagnosed
        unmade = Path(out) / "unmade"
        unmade.mkdir(exist_ok=True)
        (unmade / identity(seed, index)).write_text(f"{why}\n")
        return index, []


SEAL = "sealed.sha256"
PARTS = ("answers", "cases", "unmade")  # the last: why some cannot be made


def listing(out: Path) -> str:
    """The hash of every answer and every case."""
    paths = sorted(p for part in ("answers", "cases") for p in (out / part).rglob("*") if p.is_file())
    return "".join(f"{hashlib.sha256(p.read_bytes()).hexdigest()}  {p.relative_to(out)}\n" for p in paths)


def seal_of(out: Path) -> str:
    """One hash over all that was sealed; an error when something has changed since."""
    text = (out / SEAL).read_text()
    if listing(out) != text:
        raise RuntimeError(
            f"{out}: cases or answers are not those that were sealed; remove the folder to make them anew"
        )
    return hashlib.sha256(text.encode()).hexdigest()


def generate(
    seed: int, cases: Cases, out: Path, processes: int = 2, quiet: bool = False, world: World = SIMULATOR,
    first: int | None = None,
) -> str:  # fmt: skip
    """Makes a set, unless this generator made it before, and seals it; returns the seal. A set that comes out as it was
    stays in place. `first`: only so many, in the order of their names, which is random. An interrupted one goes on."""
    of = {"seed": seed, "cases": cases, "generator": generator_hash(world)}
    count = min(total(cases), first or total(cases))
    wanted = {**of, "first": count}
    stamp = out / "set.json"
    made = json.loads(stamp.read_text()) if stamp.exists() and (out / SEAL).exists() else {}
    if made == wanted:
        return seal_of(out)
    fresh = out / "being-made"
    if not (fresh / "set.json").exists() or json.loads((fresh / "set.json").read_text()) != of:
        shutil.rmtree(fresh, ignore_errors=True)
        if {**made, "first": count} == wanted:  # the same set, but of fewer or more
            for part in PARTS:
                if (out / part).exists():
                    shutil.copytree(out / part, fresh / part)
        fresh.mkdir(parents=True, exist_ok=True)
        (fresh / "set.json").write_text(json.dumps(of))
    order = sorted(range(total(cases)), key=lambda index: identity(seed, index))
    jobs = []
    for place, index in enumerate(order):
        name = identity(seed, index)
        if place >= count:
            for part in PARTS[:2]:
                shutil.rmtree(fresh / part / name, ignore_errors=True)
        # truth.json is the last file of a case
        elif not any(made.exists() for made in (fresh / "answers" / name / "truth.json", fresh / "unmade" / name)):
            jobs.append((seed, index, cases, str(fresh), world.name))
    begun, given_up = time.monotonic(), 0
    with ProcessPoolExecutor(processes, multiprocessing.get_context("spawn")) as pool:
        for done, job in enumerate(as_completed([pool.submit(_job, job) for job in jobs]), start=1):
            given_up += len(job.result()[1])
            if not quiet and (done % 20 == 0 or done == len(jobs)):
                spent = time.monotonic() - begun
                text = f"made {done}/{len(jobs)} cases, {spent:.0f} s, {given_up} draws given up "
                print(f"\r{text}", end="" if done < len(jobs) else "\n", file=sys.stderr, flush=True)
    if listing(fresh) != (listing(out) if (out / "cases").is_dir() else ""):
        for part in PARTS:
            shutil.rmtree(out / part, ignore_errors=True)
            if (fresh / part).exists():
                (fresh / part).rename(out / part)
        shutil.rmtree(out / "best", ignore_errors=True)
    shutil.rmtree(fresh)
    (out / SEAL).write_text(listing(out))
    stamp.write_text(json.dumps(wanted))
    return seal_of(out)


def generator_hash(world: World = SIMULATOR) -> str:
    """What made the cases."""
    here = Path(__file__).resolve().parent
    names = (
        "plant.py",
        "designs.py",
        "effects.py",
        "detect.py",
        "outsiders.py",
        "spoil.py",
        "files.py",
        "generate.py",
    )
    paths = [*(here / name for name in names), *world.sources]
    return hashlib.sha256(b"".join(path.read_bytes() for path in paths)).hexdigest()


def default_folder(seed: int, cases: Cases, world: World = SIMULATOR) -> Path:
    """Where a set is kept."""
    label = world.prefix + {world.development_seed: "dev", world.test_seed: "test"}.get(seed, "seed")
    plan = "" if isinstance(cases, int) else "-" + hashlib.sha256(cases.encode()).hexdigest()[:6]
    return BUILD / f"{label}-{seed}-{total(cases)}{plan}"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options_of_world(parser)
    parser.add_argument("--development", action="store_true", help="the development seed")
    parser.add_argument("--cases", type=cases_of, help="how many, or a plan")
    parser.add_argument("--seed", type=int, help="another seed")
    parser.add_argument("--out", type=Path, help="folder")
    parser.add_argument("--processes", type=int, default=min(2, os.cpu_count() or 1))
    options = parser.parse_args()
    world = world_called(options.world)
    seed, cases = world.seed_and_cases(options.seed, options.cases, options.development)
    out = options.out or default_folder(seed, cases, world)
    print(f"{out}: answers sealed {generate(seed, cases, out, options.processes, world=world)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
