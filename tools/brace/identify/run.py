"""The whole of `brace identify`: record in, report out. The steps, in order: settle faults, fit, ask what is
known, name what cannot be told apart, split joints from structure."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

from brace.dataset import Dataset
from brace.identify import parameters as choose
from brace.identify.classes import CANDIDATES, TABLE_CANDIDATES, Confusion, confusions
from brace.identify.combinations import combination_estimates
from brace.identify.families import FamilyFit, compare_families, scattered_starts
from brace.identify.faults import settle
from brace.identify.fit import Fit, Problem, fit
from brace.identify.information import Estimate, Information, information
from brace.identify.joint_test import JointProblem
from brace.identify.loading import LoadingProblem
from brace.identify.noise_after_base import with_noise_after, without_repeats
from brace.identify.slopes import slope_table
from brace.identify.split import Split, split
from brace.identify.table import TableProblem, Weight
from brace.identify import turning
from brace.model import LimbModel

_NOT_IN_TABLES = ("sensor.", "geometry.")  # a table's K is as coarse as its print; these stay as calibrated
Advance = Callable[[int], None]


@dataclass(frozen=True)
class Options:
    """How to fit: `mode` is "prior" or "free" ("" lets the kind of record decide)."""

    mode: str = ""
    extra_keys: tuple[str, ...] = ()
    only_keys: tuple[str, ...] = ()
    faults: str = "repair"
    knee: str = "up"
    weight: Weight = Weight()


@dataclass(frozen=True)
class Identification:
    """Everything that a report says."""

    dataset: Dataset
    start: LimbModel
    mode: str
    information: Information
    problem: Problem
    combinations: dict[str, Estimate] = field(default_factory=dict)
    classes: list[Confusion] = field(default_factory=list)
    split: Split | None = None
    families: list[FamilyFit] = field(default_factory=list)
    slopes: list[dict[str, Any]] = field(default_factory=list)
    done_to_data: list[str] = field(default_factory=list)

    @property
    def fit(self) -> Fit:
        return self.information.fit

    @property
    def model(self) -> LimbModel:
        """The fitted limb."""
        return self.fit.model


def identify(
    dataset: Dataset, start: LimbModel, options: Options, advance: Advance = lambda _done: None
) -> Identification:
    """Fits the record; the kind of record decides how."""
    settled, done = settle(dataset, options.faults)
    if settled.kind == "joint_test":
        return _joint_test(dataset, settled, start, done, options)
    if settled.kind == "loading":
        return _loading(dataset, turning.settled(settled, start), start, done, options, advance)
    return _table(dataset, settled, start, done, options, advance)


def _chosen(start: LimbModel, mode: str, options: Options, *, turns: bool = False) -> choose.ParameterSet:
    if options.only_keys:
        return choose.free(start, options.only_keys)
    if mode == "prior":
        return choose.with_priors(start, options.extra_keys, turns=turns)
    return choose.free_compliances(start, options.extra_keys)


def _loading(
    dataset: Dataset, settled: Dataset, start: LimbModel, done: list[str], options: Options, advance: Advance
) -> Identification:
    mode = options.mode or "prior"
    problem = _with_known_noise(LoadingProblem(settled), start)
    best = fit(problem, _chosen(start, mode, options, turns=not settled.small_displacements))
    advance(2)
    known = information(best)
    classes = confusions(problem, best.model, {}, _candidates(CANDIDATES, options))
    advance(5)
    return Identification(
        dataset,
        start,
        mode,
        known,
        problem,
        combination_estimates(known),
        classes,
        split(problem, best, lambda done_steps: advance(5 + done_steps)),
        [],
        slope_table(settled),
        done,
    )


def _with_known_noise(problem: LoadingProblem, start: LimbModel) -> LoadingProblem:
    """The noise of a record without repeats is what its refitted base does not follow, as in a diagnosis."""
    record = problem.record
    base = choose.with_priors(start, turns=not problem.dataset.small_displacements)
    if not without_repeats(record) or not len(base):
        return problem
    return LoadingProblem(problem.dataset, with_noise_after(record, record, -fit(problem, base).residual))


def _table(
    dataset: Dataset, settled: Dataset, start: LimbModel, done: list[str], options: Options, advance: Advance
) -> Identification:
    mode = options.mode or "free"
    problem = TableProblem(settled, start, options.weight, options.knee)
    chosen = _chosen(start, mode, options)
    chosen = choose.ParameterSet(
        start,
        tuple(
            parameter
            for parameter in chosen.parameters
            if not parameter.key.startswith(_NOT_IN_TABLES) and not parameter.key.endswith("zero_offset_rad")
        ),
    )
    if problem.poses.needs_height:
        chosen = choose.ParameterSet(start, (*chosen.parameters, problem.height_parameter()))
    best = fit(problem, chosen, scattered_starts(chosen))
    advance(1)
    known = information(best)
    families = compare_families(problem, start, lambda done_steps: advance(1 + done_steps))
    classes = confusions(problem, best.model, best.nuisances, _candidates(TABLE_CANDIDATES, options))
    shares = split(problem, best, lambda done_steps: advance(8 + done_steps))
    return Identification(
        dataset,
        start,
        mode,
        known,
        problem,
        combination_estimates(known),
        classes,
        shares,
        families,
        [],
        done,
    )


def _joint_test(
    dataset: Dataset, settled: Dataset, start: LimbModel, done: list[str], options: Options
) -> Identification:
    problem = JointProblem(settled)
    chosen = problem.parameters(start)
    best = problem.settled(fit(problem, chosen, problem.starts(chosen)))
    return Identification(dataset, start, "free", information(best), problem, done_to_data=done)


def _candidates(standard: Sequence[str], options: Options) -> list[str]:
    return list(dict.fromkeys((*standard, *options.extra_keys, *options.only_keys)))
