"""All steps of a table's diagnosis in order. A table alone names almost nothing, and the verdict says so."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from brace.dataset import DataFault, Dataset
from brace.dataset.check_table import half_units
from brace.diagnose.diagnosis import (
    Candidate,
    Diagnosis,
    Gap,
    GapPair,
    GapStep,
    Interval,
    NamedEffect,
    NextExperiment,
    Residuals,
    Unexplained,
    Verdict,
)
from brace.diagnose.options import Advance, Options
from brace.diagnose.stiffness_table.alternatives import (
    BASE,
    BELIEVED,
    LINKS,
    SPRINGS,
    Judged,
    judge,
    missing_from,
)
from brace.diagnose.stiffness_table.localise import localise
from brace.effects import BY_NAME
from brace.ground.errors import BadFileError, UsageError
from brace.identify.faults import settle
from brace.identify.parameters import LINK_COMPLIANCES, TIP_HEIGHT
from brace.identify.table import TableProblem, Weight
from brace.model import LimbModel

WEIGHT = Weight()  # of an entry: what printing, sensor and set-up leave, 0.3 N/mm + 10 %
AGREES = 1.5  # squared misfit per entry, in that weight, up to which the believed limb is no surprise
WORTH = 10.0  # twice the log-likelihood that an alternative must gain over the believed limb
SURPRISING_RATIO = 10.0  # one sigma of what a link's bending may be off
SURPRISING_TILT_RAD = 0.2
SUREST = 0.8  # no member of a class is surer than this
_RIG = Path(__file__).resolve().parents[2] / "data" / "paper-rig.toml"


def diagnose_table(
    dataset: Dataset, believed: LimbModel | None, options: Options, advance: Advance
) -> Diagnosis:
    """What a table of K says beyond `believed`."""
    if believed is None:
        raise UsageError(
            "a stiffness table needs a model",
            where=str(dataset.folder),
            why="its matrices are compared with a limb's",
            next_step="--model limb.toml",
        )
    faults = tuple(dataset.faults)
    try:
        if options.faults == "stop":
            dataset.require_sound()
        settled, done = settle(dataset, "repair")
    except BadFileError:
        return _faulty(dataset, believed, faults, options)
    problem = TableProblem(settled, believed, WEIGHT)
    missing = missing_from(believed)
    steps, taken = 5 * (len(missing) + 1), 0

    def step() -> None:
        nonlocal taken
        taken += 1
        advance(0.9 * min(taken / steps, 1.0), "comparing kinds of limb")

    base = judge(problem, believed, BELIEVED, step)
    if base is None:
        return _faulty(dataset, believed, faults, options)
    judged = [one for one in (judge(problem, believed, each, step) for each in missing) if one is not None]
    return _diagnosed(dataset, settled, problem, believed, base, judged, done, faults, options)


def _faulty(
    dataset: Dataset, believed: LimbModel, faults: tuple[DataFault, ...], options: Options
) -> Diagnosis:
    blocking = [fault for fault in faults if fault.blocking] or list(faults)
    said = blocking[0].sentence(Path(dataset.csv_path.name)) if blocking else "no limb has such matrices"
    more = f" (and {len(blocking) - 1} more)" if len(blocking) > 1 else ""
    return Diagnosis(
        "data_fault",
        f"The table is faulty, so nothing is said about the limb: {said}{more}.",
        believed,
        data_faults=faults,
        seed=options.seed,
    )


def _diagnosed(
    dataset: Dataset,
    settled: Dataset,
    problem: TableProblem,
    believed: LimbModel,
    base: Judged,
    judged: Sequence[Judged],
    done: Sequence[str],
    faults: tuple[DataFault, ...],
    options: Options,
) -> Diagnosis:
    random = np.random.default_rng(options.seed)
    misfit = base.fit.chi2 / problem.count
    reach = settled["r_mm"] if "r_mm" in settled else np.arange(len(problem.k), dtype=float)
    spots = localise(base.off_n_per_mm, problem.sigma, reach, random)
    spread = max(1.0, min([misfit, *(one.fit.chi2 / problem.count for one in judged)]))
    worth = {id(one): _worth(base, one, spread, problem.count) for one in judged}
    better = [one for one in judged if worth[id(one)] > WORTH and one.left_out_rms < base.left_out_rms]
    better.sort(key=lambda one: -worth[id(one)])
    verdict: Verdict = "none" if misfit <= AGREES and not better else ("ambiguous" if better else "unknown")
    if verdict == "none" and any(fault.blocking and fault.suggestion is not None for fault in faults):
        verdict = "data_fault"
    best = min(better, key=lambda one: one.left_out_misfit) if better else base
    effects = _members(better, best, believed) if better else ()
    noise = float(np.sqrt(np.mean(half_units(settled.columns, settled.decimals) ** 2 / 3.0)))
    after = GapPair(best.rms, best.left_out_rms)
    before = GapPair(base.rms, base.left_out_rms)
    gap_steps = (GapStep(best.alternative.name, after),) if better else ()
    gap = Gap("n_per_mm", noise, before, after, gap_steps)
    could_be = (
        _could_be(better) if better else tuple(label for one in judged for label in one.alternative.labels)
    )
    could_be = tuple(dict.fromkeys(could_be)) if verdict in ("ambiguous", "unknown") else ()
    return Diagnosis(
        verdict,
        _sentence(verdict, better, before, after, misfit, faults),
        best.fit.model if better else believed,
        gap,
        effects,
        (could_be,) if verdict == "ambiguous" else (),
        could_be,
        spots,
        Unexplained(best.rms, best.fit.chi2 / problem.count > AGREES, _left(best, problem.count)),
        _next(could_be) if verdict in ("ambiguous", "unknown") else None,
        faults,
        tuple(
            Candidate(one.alternative.name, worth[id(one)], share)
            for one, share in zip(judged, _shares(judged, believed))
        ),
        Residuals(
            ("k_xx", "k_xz", "k_zz"),
            base.off_n_per_mm,
            best.off_n_per_mm,
            np.zeros(len(problem.k), dtype=bool),
        ),
        _notes(problem, best, done),
        options.seed,
        {"misfit_per_entry": {one.alternative.name: one.fit.chi2 / problem.count for one in (base, *judged)}},
    )


def _worth(base: Judged, one: Judged, spread: float, entries: int) -> float:
    """Twice the log-likelihood gained, in units of what the best kind of limb leaves, less what its freedom
    gains."""
    more = len(one.fit.parameters) - len(base.fit.parameters)
    return (base.fit.chi2 - one.fit.chi2) / spread - more * float(np.log(entries))


def _shares(judged: Sequence[Judged], believed: LimbModel) -> list[float]:
    """How likely each kind of limb is, by the rows that its fit had not seen. Each row is one piece of evidence of
    unknown scale, because the weight of an entry is assumed and not measured. A kind of limb that needs links far from
    the believed ones is less likely."""
    if not judged:
        return []
    misses = np.log([max(one.left_out_misfit, 1e-6) for one in judged])
    surprise = np.array([_surprise(one.fit.model, believed) for one in judged])
    worth = -0.5 * len(judged[0].off_n_per_mm) * misses - 0.5 * surprise
    shares = np.exp(worth - worth.max())
    return [float(share) for share in shares / shares.sum()]


def _surprise(model: LimbModel, believed: LimbModel) -> float:
    """Squared sigmas by which bending and tilt of the links are off."""
    total = 0.0
    for link in ("link.femur", "link.tibia"):
        was, now = believed.number(f"{link}.bending_mm_per_n"), model.number(f"{link}.bending_mm_per_n")
        if was > 0.0:
            total += min(abs(np.log(max(now, 1e-12) / was) / np.log(SURPRISING_RATIO)), 3.0) ** 2
        tilt = model.number(f"{link}.tilt_rad") - believed.number(f"{link}.tilt_rad")
        total += min(abs(tilt) / SURPRISING_TILT_RAD, 3.0) ** 2
    return float(total)


def _could_be(better: Sequence[Judged]) -> tuple[str, ...]:
    """Everything that a better kind of limb would mean, and what leaves the same trace in K at the tip."""
    labels = [label for one in better for label in one.alternative.labels]
    if SPRINGS[0] in labels:
        labels += BASE  # a base that turns has the femur joint's lever
    if SPRINGS[1] in labels:
        labels += LINKS[1:]  # the tibia's bending has the knee's lever
    return tuple(labels)


def _members(better: Sequence[Judged], best: Judged, believed: LimbModel) -> tuple[NamedEffect, ...]:
    """One entry for every effect that a better kind of limb has; no certainty about any."""
    shares = _shares(better, believed)
    chance: dict[str, float] = {}
    source: dict[str, Judged] = {}
    for one, share in zip(better, shares):
        for label in one.alternative.labels:
            chance[label] = chance.get(label, 0.0) + share / len(one.alternative.labels)
            source.setdefault(label, one)
    removed = [
        NamedEffect(*_split(label), min(SUREST, chance[label]), _intervals(label, source[label]), 0.0)
        for label in chance
    ]
    explained = {effect.label for effect in removed} & set(best.alternative.labels)
    listed = [
        replace(effect, gap_share=1.0 / len(explained) if effect.label in explained else 0.0)
        for effect in removed
    ]
    return tuple(sorted(listed, key=lambda one: -one.confidence))


def _split(label: str) -> tuple[str, str]:
    name, _, where = label.partition("@")
    return name, where


def _intervals(label: str, judged: Judged) -> dict[str, Interval]:
    """90 % intervals from the fits without each part of the rows (jackknife). A parameter that is a choice, and not a
    size, has none."""
    name, where = _split(label)
    keys = [number.key(where) for number in BY_NAME[name].numbers]
    found = {}
    for key in keys:
        if key in judged.fit.parameters.keys:
            place = judged.fit.parameters.keys.index(key)
            value = float(judged.fit.x[place])
            parts = np.array([part.x[place] for part in judged.folds])
            count = max(len(parts), 2)
            error = float(np.sqrt((count - 1) / count * np.sum((parts - parts.mean()) ** 2)))
            low, high = (judged.fit.parameters.array(end)[place] for end in ("low", "high"))
            found[key] = Interval(
                value, float(max(value - 2.35 * error, low)), float(min(value + 2.35 * error, high))
            )
        elif key.endswith("moment_transfer") and judged.fit.model.number(key) > 0.0:
            found[key] = Interval(judged.fit.model.number(key), 0.0, 1.0)
    return found


def _left(best: Judged, entries: int) -> str:
    each = best.fit.chi2 / entries
    if each <= AGREES:
        return f"what is left is within the weight of an entry ({each:.2g} of its square)"
    return (
        f"no kind of limb that was tried reaches the weight of an entry: {each:.2g} times its square is left,"
        " so the table cannot settle which one is right"
    )


def _sentence(
    verdict: Verdict,
    better: Sequence[Judged],
    before: GapPair,
    after: GapPair,
    misfit: float,
    faults: Sequence[DataFault],
) -> str:
    mended = sum(1 for fault in faults if fault.suggestion is not None)
    first = f"{mended} fault{'s' if mended != 1 else ''} of the table with a correction. " if mended else ""
    if verdict == "ambiguous":
        kinds = ", ".join(one.alternative.name for one in better[:-1])
        kinds += (" or " if kinds else "") + better[-1].alternative.name
        return (
            f"{first}The believed limb misses the table by {before.fitted:.3g} N/mm; {kinds} would each"
            f" lessen that (to {after.fitted:.3g} N/mm at best), and a table of K alone cannot show which."
        )
    if verdict == "unknown":
        return (
            f"{first}The believed limb misses the table by {before.fitted:.3g} N/mm, and no kind of limb that"
            " is known here fits rows that it has not seen better."
        )
    if verdict == "data_fault":
        return (
            f"{first}With them corrected the believed limb agrees with the table ({before.fitted:.3g} N/mm)."
        )
    return (
        f"The believed limb agrees with the table: {before.fitted:.3g} N/mm, {misfit:.2g} of what an entry is"
        " trusted to."
    )


def _notes(problem: TableProblem, best: Judged, done: Sequence[str]) -> tuple[str, ...]:
    notes = [f"data: {text}" for text in done]
    notes.append(
        f"an entry of K is trusted to {WEIGHT.absolute_n_per_mm:g} N/mm + {WEIGHT.relative:.0%}; held out"
        " means: each row predicted by a fit that did not see it"
    )
    height = best.fit.nuisances.get(TIP_HEIGHT)
    if height is not None and problem.poses.needs_height:
        notes.append(
            f"the table gives no direction of the tip: one height of z = {height:.0f} mm for all rows is"
            " fitted, an inference"
        )
    if any(key in LINK_COMPLIANCES for key in best.fit.parameters.keys):
        notes.append("in the exported limb the links are fitted too: one member of the class, not the cause")
    return tuple(notes)


def _next(could_be: Sequence[str]) -> NextExperiment:
    return NextExperiment(
        "record the loading cycles behind the table, with the tip's direction, encoders behind the gearboxes"
        " and a dial gauge on the base, folded, half open and nearly straight: encoders separate joints from"
        " links, the gauge the base from both, the sign of the coupling between the two levers moment"
        " transfer",
        tuple(could_be[:4]),
        0.95,
        45.0,
        _RIG.read_text(encoding="utf-8").replace("[sensor]\n", "[sensor]\nencoders = true\nbase_gauge = true\n"),
    )
