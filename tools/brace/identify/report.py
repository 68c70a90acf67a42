"""An identification in words, as JSON, and as comments on the fitted model."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from brace import __version__
from brace.identify.combinations import MEANING
from brace.identify.information import Estimate
from brace.identify.joint_test import JointProblem
from brace.identify.loading import LoadingProblem
from brace.identify.parameters import ANGLE_ZERO, TIP_HEIGHT, TORQUE_OFFSET
from brace.identify.run import Identification

PAPER_STRUCTURE_SHARE = 0.30
OUTSIDE_TRUST_SIGMAS = 3.0


def as_json(result: Identification) -> dict[str, Any]:
    """The --json report; null stands for infinite."""
    parameters = {}
    for parameter, estimate in zip(result.fit.parameters.parameters, result.information.estimates()):
        parameters[parameter.key] = {
            "value": estimate.value,
            "start": parameter.start,
            "sigma": estimate.sigma,
            "low": estimate.low,
            "high": estimate.high,
            "unit": parameter.unit,
            "identifiable": estimate.identifiable,
            "at_bound": estimate.at_bound or None,
            "prior_sigma": parameter.prior_sigma,
        }
    report: dict[str, Any] = {
        "format": 1,
        "dataset": str(result.dataset.folder),
        "kind": result.dataset.kind,
        "mode": result.mode,
        "rows": result.dataset.rows,
        "parameters": parameters,
        "combinations": {
            name: {**_interval(estimate), "meaning": MEANING[name]}
            for name, estimate in result.combinations.items()
        },
        "outside_trust": [{"key": key, "sigmas": sigmas} for key, sigmas in outside_trust(result)],
        "correlations": [list(pair) for pair in result.information.correlations()],
        "indistinguishable": [list(confusion.members) for confusion in result.classes],
        "classes": [
            {
                "members": list(confusion.members),
                "left_over": confusion.left_over,
                "told_apart_by": confusion.told_apart_by,
            }
            for confusion in result.classes
        ],
        "condition_number": result.information.condition,
        "residual": _residual(result),
        "data_faults": [fault.as_json() for fault in result.dataset.faults],
        "done_to_data": result.done_to_data,
    }
    if result.split:
        share = result.split
        report["split"] = {
            "structure_share": share.structure_share,
            "joint_share": 1 - share.structure_share,
            "structure_share_low": share.allowed[0],
            "structure_share_high": share.allowed[1],
            "paper_structure_share": PAPER_STRUCTURE_SHARE,
            "profile": [list(point) for point in share.profile],
        }
    if result.families:
        report["families"] = [
            {
                "family": item.family.name,
                "chi2_per_entry": item.chi2_per_entry,
                "tip_height_mm": item.tip_height_mm,
                "parameters": dict(zip(item.fit.parameters.keys, item.fit.x.tolist())),
            }
            for item in result.families
        ]
    if result.slopes:
        report["slopes"] = result.slopes
    report["versions"] = {"brace": __version__}
    return report


def outside_trust(result: Identification) -> list[tuple[str, float]]:
    """Parameters that the record pulls more than three sigmas away from what the calibration trusts them to."""
    found = []
    for parameter, value in zip(result.fit.parameters.parameters, result.fit.x):
        sigmas = (value - parameter.start) / parameter.prior_sigma
        if abs(sigmas) > OUTSIDE_TRUST_SIGMAS:
            found.append((parameter.key, float(sigmas)))
    return sorted(found, key=lambda item: -abs(item[1]))


def _interval(estimate: Estimate) -> dict[str, Any]:
    return {
        "value": estimate.value,
        "sigma": estimate.sigma,
        "low": estimate.low,
        "high": estimate.high,
        "identifiable": estimate.identifiable,
    }


def _residual(result: Identification) -> dict[str, Any]:
    fit, problem = result.fit, result.problem
    residual: dict[str, Any] = {
        "chi2": fit.chi2,
        "readings": fit.readings,
        "chi2_per_reading": fit.chi2 / fit.readings,
        "interval_inflation": math.sqrt(fit.inflation),
    }
    if isinstance(problem, LoadingProblem):
        residual |= {
            "unit": "n",
            "rms_n": problem.force_gap_n(fit.model),
            "rms_start_n": problem.force_gap_n(result.start),
            "noise_floor_n": problem.noise_n,
            "noise_source": problem.noise_source,
        }
    elif isinstance(problem, JointProblem):
        rms = math.sqrt(fit.chi2 / fit.readings) * problem.noise_n_mm
        residual |= {
            "unit": "n_mm",
            "rms_n_mm": rms,
            "noise_floor_n_mm": problem.noise_n_mm,
            "rms_share_of_signal": rms / problem.signal_n_mm(),
        }
    else:
        residual |= {"unit": "weight", "weight": "0.3 N/mm + 10 % unless given"}
    return residual


def as_text(result: Identification) -> str:
    """The report for people."""
    return "\n".join(_lines(result))


def _lines(result: Identification) -> Iterator[str]:
    held = "within the trust of [uncertainty]" if result.mode == "prior" else "compliances free"
    yield f"{result.dataset.folder}: {result.dataset.kind}, {result.dataset.rows} rows; fitted {held}"
    yield from (f"  {text}" for text in _residual_words(result))
    yield "parameters, 90 % intervals:"
    for parameter, estimate in zip(result.fit.parameters.parameters, result.information.estimates()):
        yield f"  {parameter.key:38} {_value(estimate):46} {parameter.unit:12} start {parameter.start:.5g}"
    if result.combinations:
        yield "what the tip does show:"
        for name, estimate in result.combinations.items():
            yield f"  {name:18} {_value(estimate):46} {MEANING[name]}"
    for key, sigmas in outside_trust(result):
        side = "above" if sigmas > 0.0 else "below"
        yield (
            f"  {key} is {abs(sigmas):.1f} sigma {side} what limb.toml trusts it to ([uncertainty]): the limb may have "
            "an effect that the model lacks; try brace diagnose"
        )
    for one, other, value in result.information.correlations():
        yield f"  errors go together ({value:+.3f}): {one}, {other}"
    if result.classes:
        yield "cannot be told apart in this record:"
        for confusion in result.classes:
            yield f"  {{{', '.join(confusion.members)}}}; separated by {confusion.told_apart_by}"
    if result.families:
        yield "kinds of limb, fitted alike (1 would be a fit within the weight):"
        for item in result.families:
            height = f", z = {item.tip_height_mm:.0f} mm" if item.tip_height_mm is not None else ""
            yield f"  {item.family.name:42} chi2/entry {item.chi2_per_entry:.2f}{height}"
        if min(item.chi2_per_entry for item in result.families) > 1.0:
            yield "  no kind reaches 1: this table cannot settle which is right"
        if TIP_HEIGHT in result.fit.parameters.keys:
            yield "  z, one constant tip height, is an inference: the table does not print the tip's direction"
    if result.split:
        share, (low, high) = result.split.structure_share, result.split.allowed
        yield (
            f"share of the structure in the tip's compliance: {share:.0%} in this fit; the data alone allow "
            f"{low:.0%} to {high:.0%} (base rigid, no other change; the paper says {PAPER_STRUCTURE_SHARE:.0%})"
        )


def _residual_words(result: Identification) -> Iterator[str]:
    values = _residual(result)
    if "rms_n" in values:
        yield (
            f"force gap {values['rms_start_n']:.3f} N at the start, {values['rms_n']:.3f} N fitted; noise floor "
            f"{values['noise_floor_n']:.3f} N from {values['noise_source']}"
        )
    elif "rms_n_mm" in values:
        yield (
            f"torque gap {values['rms_n_mm']:.4g} N mm, {values['rms_share_of_signal']:.1%} of the signal's standard "
            f"deviation; noise floor {values['noise_floor_n_mm']:.3g} N mm"
        )
    else:
        yield f"chi2 per entry {values['chi2_per_reading']:.2f}"
    if values["interval_inflation"] > 1.1:
        yield f"the model does not reach the noise: intervals are widened {values['interval_inflation']:.2f} times"


def _value(estimate: Estimate) -> str:
    if not estimate.identifiable:
        return f"not identifiable; signs allow [{estimate.low:.4g}, {estimate.high:.4g}]"
    bound = ", at its bound" if estimate.at_bound else ""
    return f"{estimate.value:.5g} [{estimate.low:.5g}, {estimate.high:.5g}]{bound}"


def header(result: Identification) -> list[str]:
    """Comment lines for the fitted model."""
    lines = [
        f"Identified by brace {__version__} from dataset '{result.dataset.folder.name}' "
        f"({result.dataset.kind}, {result.dataset.rows} rows), mode {result.mode}.",
        *_residual_words(result),
    ]
    lines += [f"data: {text}" for text in result.done_to_data]
    unknown = [key for key, lost in zip(result.fit.parameters.keys, result.information.unknown()) if lost]
    if unknown:
        lines.append("not identifiable from this record, kept near the start: " + ", ".join(unknown))
    lines += ["cannot be told apart: " + ", ".join(confusion.members) for confusion in result.classes]
    height = result.fit.nuisances.get(TIP_HEIGHT)
    if height is not None:
        lines.append(f"tip height z = {height:.1f} mm for all rows (an inference)")
    zero = result.fit.nuisances.get(ANGLE_ZERO)
    if zero is not None:
        lines.append(
            f"the record's own, not the limb's: zero of the angle {zero:+.6g} rad, offset of the torque "
            f"{result.fit.nuisances[TORQUE_OFFSET]:+.6g} N mm (`brace predict` fits them anew to each record)"
        )
    return [" ".join(line.split()) for line in lines]
