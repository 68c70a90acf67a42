"""The baselines: each finds what is plainly there, the shortcuts they take are exact, the pairing counts right."""

from __future__ import annotations

import dataclasses
import itertools
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from baselines import compare, forward, gaussian_process, lasso, methods, thresholded
from baselines.answer import answer, refitted
from baselines.gaussian_process import Discrepancy
from baselines.play import Unseen, fitted_numbers
from baselines.signatures import BLOCKS, Array, Column, Signatures, prepared, signatures_of, triangle
from generate import drawn, schedule, write_case
from scoring import Judged, judge
from seeds import SUBSET_SEED

ROWS, COLUMNS = 400, 12


def given(rng: np.random.Generator, left: Array, matrix: Array, labels: list[str] | None = None) -> Signatures:
    """As if these rows were a record's."""
    names = labels or [f"effect{i}@place" for i in range(matrix.shape[1])]
    columns = tuple(Column(name, (f"key{i}",), (0.0,), (1.0,), (), 1.0, False) for i, name in enumerate(names))
    whole = np.column_stack([matrix, left])
    group = rng.integers(BLOCKS, size=len(left))
    blocks = [triangle(whole[group == g]) for g in range(BLOCKS)]
    everything = np.arange(matrix.shape[1])
    return Signatures(columns, triangle(whole), everything, (*blocks, np.zeros((1, whole.shape[1]))), len(left))


def library(rng: np.random.Generator, columns: int = COLUMNS) -> Array:
    """Random columns of norm 1."""
    matrix = rng.standard_normal((ROWS, columns))
    return np.asarray(matrix / np.linalg.norm(matrix, axis=0))


def said(found: dict[str, Any]) -> list[str]:
    return [f"{e['name']}@{e['where']}" for e in found["effects"]]


@pytest.mark.parametrize("name", list(methods.NAMING))
def test_plain_cases(name: str) -> None:
    """One effect and two at 15 sigma are named, at the setting that is used; noise alone hardly ever is."""
    pytest.importorskip("sklearn")
    pytest.importorskip("pysindy")
    knobs, choose = methods.tuned_knobs(name), methods.NAMING[name].choose
    right, alarms = 0, 0
    for seed in range(10):
        rng = np.random.default_rng(seed)
        matrix, noise = library(rng), rng.standard_normal(ROWS)
        size = np.array([15.0, -15.0])
        one = choose(given(rng, noise + 15.0 * matrix[:, 3], matrix), knobs).found
        two = choose(given(rng, noise + matrix[:, [3, 5]] @ size, matrix), knobs).found
        right += said(one) == ["effect3@place"] and sorted(said(two)) == ["effect3@place", "effect5@place"]
        alarms += choose(given(rng, noise, matrix), knobs).found["verdict"] != "none"
    assert right >= 9
    assert alarms <= 1


def test_forward_is_least_squares() -> None:
    """Of every pair of columns none beats the two that forward selection takes where columns are all but orthogonal."""
    rng = np.random.default_rng(5)
    matrix = library(rng)
    sig = given(rng, rng.standard_normal(ROWS) + matrix[:, [2, 7]] @ [9.0, 11.0], matrix)
    chosen = forward.forward_bic(sig, {**forward.SPACE.textbook, "most": 2}).chosen
    best = min(itertools.combinations(range(COLUMNS), 2), key=lambda pair: refitted(sig, pair)[1])
    assert chosen == best == (2, 7)
    assert refitted(sig, chosen)[1] == pytest.approx(
        float(np.linalg.lstsq(matrix[:, [2, 7]], _rows(sig, matrix), rcond=None)[1][0]), rel=1e-9
    )


def _rows(sig: Signatures, matrix: Array) -> Array:
    """The left-over on all rows again, up to what no column sees."""
    q, r = np.linalg.qr(matrix)
    sign = np.sign(np.diag(r)) * np.sign(np.diag(sig.root)[:-1])
    inside = q @ (sign * sig.left[:-1])
    other = np.random.default_rng(0).standard_normal(ROWS)
    other -= q @ (q.T @ other)
    return np.asarray(inside + other / np.linalg.norm(other) * sig.left[-1])


@pytest.mark.parametrize("criterion", ["aic", "bic"])
def test_lasso_on_the_root_is_lasso_on_all_rows(criterion: str) -> None:
    """scikit-learn's own class on every row chooses the same columns as on the triangular root."""
    sklearn = pytest.importorskip("sklearn.linear_model")
    differ = 0
    for seed in range(20):
        rng = np.random.default_rng(seed)
        matrix = library(rng)
        left = rng.standard_normal(ROWS) + matrix[:, :3] @ [3.0, 4.0, 6.0]
        direct = sklearn.LassoLarsIC(criterion=criterion, fit_intercept=False, noise_variance=1.0).fit(matrix, left)
        knobs = {**lasso.SPACE.textbook, "criterion": criterion, "signed": False}
        differ += lasso.lasso_ic(given(rng, left, matrix), knobs).chosen != tuple(np.flatnonzero(direct.coef_))
    assert differ == 0


def test_stlsq_on_the_root_is_stlsq_on_all_rows() -> None:
    """The same for PySINDy's optimiser."""
    optimizers = pytest.importorskip("pysindy.optimizers")
    for seed in range(5):
        rng = np.random.default_rng(seed)
        matrix = library(rng)
        left = rng.standard_normal(ROWS) + matrix[:, :3] @ [3.0, 4.0, 6.0]
        direct = optimizers.STLSQ(threshold=2.5, alpha=0.05, unbias=False).fit(matrix, left[:, None])
        knobs = {**thresholded.SPACE.textbook, "threshold": 2.5}
        assert thresholded.stlsq(given(rng, left, matrix), knobs).chosen == tuple(np.flatnonzero(direct.coef_[0]))


@pytest.mark.parametrize("threshold", [0.5, 2.0, 4.0, 50.0])
def test_quick_stlsq_is_stlsq(threshold: float) -> None:
    """The ensemble's own rounds end at PySINDy's coefficients."""
    pytest.importorskip("pysindy")
    for seed in range(5):
        rng = np.random.default_rng(seed)
        matrix = library(rng)
        left = rng.standard_normal(ROWS) + matrix[:, :3] @ [3.0, 4.0, 6.0]
        slow, fast = (one(matrix, left, threshold, 0.3) for one in (thresholded._stlsq, thresholded.quick_stlsq))
        assert np.allclose(slow, fast, atol=1e-9)


def test_answer() -> None:
    """Order by gain, impossible signs out, look-alikes beside, unknown where much is left, the weak dropped."""
    rng = np.random.default_rng(3)
    matrix = library(rng, 5)
    matrix[:, 4] = matrix[:, 0] + 0.2 * matrix[:, 4]
    matrix[:, 4] /= np.linalg.norm(matrix[:, 4])
    left = rng.standard_normal(ROWS) + matrix[:, [0, 1, 2]] @ [8.0, 14.0, -9.0]
    sig = given(rng, left, matrix, ["a@x", "b@x", "c@x", "d@x", "e@y"])
    assert said(answer(sig, [0, 1, 2], 0.0, True).found) == ["b@x", "c@x", "a@x"]
    assert answer(sig, [0, 1, 2], 0.0, True).found["indistinguishable"] == [["a@x", "e@y"]]
    sided = dataclasses.replace(sig, columns=tuple(dataclasses.replace(c, one_sided=True) for c in sig.columns))
    assert said(answer(sided, [0, 1, 2], 0.0, True).found) == ["b@x", "a@x"]
    assert said(answer(sided, [0, 1, 2], 0.0, False).found) == ["b@x", "c@x", "a@x"]
    assert said(answer(sig, [0, 1, 2, 3], 0.0, False, least_gain=4.0).found) == ["b@x", "c@x", "a@x"]
    weak = math.sqrt(refitted(sig, [1, 2])[1] - refitted(sig, [0, 1, 2])[1])
    assert "a@x" in said(answer(sig, [0, 1, 2], 0.0, False, least_gain=0.99 * weak).found)
    assert "a@x" not in said(answer(sig, [0, 1, 2], 0.0, False, least_gain=1.01 * weak).found)
    assert answer(sig, [], 1e-6, False).found["verdict"] == "unknown"
    assert answer(sig, [0, 1, 2], 1e-6, False).found["verdict"] == "effect"
    assert answer(sig, [], 0.0, False).found["verdict"] == "none"


def test_mcnemar() -> None:
    """Against hand-worked sums of binomial tails."""
    assert compare.mcnemar_p(8, 0) == pytest.approx(2.0 / 256.0)
    assert compare.mcnemar_p(1, 6) == pytest.approx(2.0 * 8.0 / 128.0)
    assert compare.mcnemar_p(5, 5) == compare.mcnemar_p(0, 0) == 1.0


def test_pairing() -> None:
    """Right alone by us, right alone by them; alarms count when silent; other cases do not; names must match."""

    def cases(*verdicts: str) -> list[Judged]:
        out = []
        for i, verdict in enumerate(verdicts):
            kind = "none" if i else "outside"
            effects = [{"name": "slip", "where": "outside"}] if kind == "outside" else []
            truth = {"id": str(i), "kind": kind, "effects": effects, "detectability": 20, "cls": []}
            out.append(judge(truth, {"verdict": verdict, "effects": []}))
        return out

    quiet = next(line for line in compare.LINES if line.must == "false alarms")
    us = cases("unknown", "none", "none", "none", "unknown", "none")
    them = cases("none", "unknown", "none", "unknown", "none", "unknown")
    found = compare.paired(quiet, "them", us, them)
    assert (found.ours, found.theirs, found.of) == (3, 1, 5)
    assert not found.better
    many = compare.paired(quiet, "them", cases("none", *["none"] * 8), cases("none", *["unknown"] * 8))
    assert many.better and many.p < 0.01
    with pytest.raises(ValueError, match="compared"):
        compare.paired(quiet, "them", us, them[::-1])


def test_gaussian_process() -> None:
    """A smooth force that the limb lacks is learned and closed elsewhere; noise alone makes little of nothing."""
    pytest.importorskip("sklearn")
    rng = np.random.default_rng(1)

    def at(count: int) -> Array:
        points = rng.uniform(-1.0, 1.0, (count, 5))
        points[:, 4] = np.sign(points[:, 4])
        return np.asarray(points)

    def force(points: Array) -> Array:
        return np.stack([points[:, 2] * (1.0 + points[:, 0]), 0.5 * points[:, 3]], axis=1)

    seen, unseen, sigma = at(300), at(100), 0.05
    left = force(seen) / sigma + rng.standard_normal((300, 2))
    truth = force(unseen)
    case = Discrepancy(
        seen, left, np.full((300, 2), sigma), unseen, np.zeros((100, 2)), truth, float(np.sqrt(np.mean(truth**2)))
    )
    assert gaussian_process.closed(case, methods.tuned_knobs(methods.PROCESS)) > 0.7


@pytest.fixture(scope="module")
def record(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, Any]]:
    """A record with backlash or friction at 12 sigma or more, and its truth."""
    root, cases = tmp_path_factory.mktemp("baselines"), 200
    for index, (kind, _) in enumerate(schedule(SUBSET_SEED, cases)):
        if kind != "single":
            continue
        truth = drawn(SUBSET_SEED, index, cases)[0]["truth"]
        if truth["detectability"] > 11.5 and truth["effects"][0]["name"] in ("backlash", "coulomb_friction"):
            write_case(SUBSET_SEED, index, cases, root)
            break
    case = next((root / "cases").iterdir())
    found: dict[str, Any] = json.loads((root / "answers" / case.name / "truth.json").read_text())
    return case, found


def test_signatures_of_a_record(record: tuple[Path, dict[str, Any]]) -> None:
    """The left-over is the refitted base's chi squared; columns are of norm 1, none twice; every group of runs is
    there; the truth's own column explains most of what is left."""
    case, truth = record
    sig, ready = signatures_of(case), prepared(case)
    assert sig is not None
    cost = float(sig.left @ sig.left)
    assert cost == pytest.approx(ready[3].cost, rel=2e-3)
    assert np.linalg.norm(sig.matrix, axis=0) == pytest.approx(1.0, abs=1e-6)
    few = [*sig.screened, -1]
    summed = sum(block.T @ block for block in sig.blocks)
    assert np.allclose(summed, (sig.root.T @ sig.root)[np.ix_(few, few)], atol=1e-6 * cost)
    hidden = truth["effects"][0]
    label = f"{hidden['name']}@{hidden['where']}"
    own = [i for i, one in enumerate(sig.columns) if one.label == label]
    s = float(truth["detectability"])
    assert max(float(sig.matrix[:, i] @ sig.left) for i in own) > 0.7 * s
    assert math.sqrt(max(cost - refitted(sig, own)[1], 0.0)) > 0.8 * s


def test_unseen_poses_are_closed(record: tuple[Path, dict[str, Any]]) -> None:
    """Forward selection's effect, fitted on the plant, leaves less there than the believed limb."""
    case, truth = record
    sig, ready = signatures_of(case), prepared(case)
    assert sig is not None
    hidden = truth["effects"][0]
    label = f"{hidden['name']}@{hidden['where']}"
    own = [int(i) for i in sig.screened if sig.columns[i].label == label]
    unseen = Unseen(case.parents[1] / "answers" / case.name / "holdout")
    before = unseen.gap_n(unseen.played(ready[2].numbers))
    after = unseen.gap_n(unseen.played(fitted_numbers(ready, sig, answer(sig, own, 0.0, True))))
    assert after < 0.5 * before
