"""K before and after a diagnosis, as the first screen says it."""

from __future__ import annotations

import math

import numpy as np

from brace.diagnose import plain_words as words
from brace.diagnose.diagnosis import Diagnosis, StiffnessAt
from brace.diagnose.digits import number, percent, with_sigma
from brace.diagnose.export import changed
from brace.diagnose.limb_change import limb_change
from brace.diagnose.stiffness_change import apart, k_at
from brace.model import LimbModel
from brace.stiffness.at_rest import planar_limb

AXES = ("xx", "xz", "zz")
SAME_K = 0.01  # relative, Frobenius: as where the members of a class are said to give one K
JOINTS = ("joint.coxa", "joint.femur", "joint.tibia")


def what_k_becomes(believed: LimbModel | None, found: Diagnosis) -> tuple[str, str, str]:
    """The question, the answer in short, K's entries a line each, and what stands below it."""
    question = "What K becomes"
    if found.joint is not None:
        return question, "By the joint below", "; ".join(words.joint_sizes(found.joint))
    if believed is not None and not changed(believed, found.model):
        why = {"none": "nothing is missing", "ambiguous": "the explanations below give different K"}
        return question, "As believed", f"limb.toml is unchanged: {why.get(found.verdict, 'nothing was added')}"
    if found.stiffness is None:
        return question, "See limb.toml", "this record names no angles at which K could be compared"
    before, after = found.stiffness.believed, found.stiffness.exported
    plays = [words.place(joint) for joint in JOINTS if found.model.number(f"{joint}.gap_rad") > 0.0]
    of = " and the ".join(plays)
    play = f" While the play of the {of} is open, the limb is softer (flag GAP_OPEN)." if plays else ""
    size = float(apart(entries(after), entries(before)))
    if size < SAME_K:
        taken_up = "with the play taken up, " if plays else ""
        return question, "As believed, within 1 %", f"{taken_up}at every posture of the record.{play}"
    sigma = k_sigma(found.model, after)
    shown = "\n".join(
        f"{axes} {before_after(float(was), float(now), plus)}"
        for axes, was, now, plus in zip(AXES, entries(before), entries(after), sigma or (0.0,) * 3, strict=True)
    )
    trust = " ± is one sigma, by limb.toml’s [uncertainty]." if sigma else ""
    taken_up = ", with the play taken up" if plays else ""
    whose = _whose(believed, found, size)
    more = (
        f"As believed → as limb.toml has it now, without load{taken_up}, at theta1 {before.theta1_rad:.3f}, theta2 "
        f"{before.theta2_rad:.3f} rad, where it changes most: by {percent(size)}.{whose}{trust}{play}"
    )
    return f"{question} [N/mm]", shown, more


def before_after(was: float, now: float, sigma: float) -> str:
    """`10.34 → 10.92 ± 0.40`: both with the digits of the uncertainty; 0: there is none."""
    if not sigma > 0.0:
        return f"{number(was)} → {number(now)}"
    return f"{with_sigma(was, sigma).partition(' ')[0]} → {with_sigma(now, sigma)}"


def _whose(believed: LimbModel | None, found: Diagnosis, size: float) -> str:
    """Which part of K's change the named effects make, and which the numbers that were refitted besides."""
    if believed is None or found.stiffness is None:
        return ""
    refit = "limb.toml’s numbers, which this record refits within their trust"
    if not found.effects:
        return f" The cause is {refit}."
    keys = {key for effect in found.effects for key in effect.parameters}
    keys |= {change.key for effect in found.effects if (change := limb_change(found.model, effect)) is not None}
    named = believed.with_values({key: found.model.values[key] for key in keys if key in found.model.values})
    at = found.stiffness.believed
    k = k_at(named, np.array([[at.theta1_rad, at.theta2_rad]]))[0]
    alone, rest = float(apart(k, entries(at))), float(apart(entries(found.stiffness.exported), k))
    if not math.isfinite(alone) or rest < SAME_K:
        return ""
    names = " and ".join(words.named(effect) for effect in found.effects)
    if alone < 0.1 * size:
        return f" The cause is not {names}, but {refit}."
    return f" Alone, {names} would change it by {percent(alone)}; the rest comes from {refit}."


def entries(k: StiffnessAt) -> np.ndarray:
    """xx, xz, zz [N/mm]."""
    return np.array([k.k_xx_n_per_mm, k.k_xz_n_per_mm, k.k_zz_n_per_mm])


def k_sigma(model: LimbModel, at: StiffnessAt) -> tuple[float, ...]:
    """One sigma of xx, xz, zz from the model's [uncertainty] [N/mm]; empty where nothing is uncertain, or K unknown."""
    limb = planar_limb(model)
    theta1_rad, theta2_rad = limb.true_angles(np.array(at.theta1_rad), np.array(at.theta2_rad))
    sigma = limb.sigma(float(theta1_rad), float(theta2_rad))
    found = tuple(sigma.get(f"sigma_k_{axes}_n_per_mm", 0.0) for axes in AXES)
    return found if any(found) and all(map(math.isfinite, found)) else ()
