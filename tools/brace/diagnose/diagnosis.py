"""What a diagnosis says: the contents of diagnosis.json, and what the report draws besides."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np

from brace.dataset import DataFault
from brace.ground.errors import EXIT_BAD_FILE, EXIT_OK
from brace.model import LimbModel

Verdict = Literal["effect", "none", "ambiguous", "unknown", "data_fault"]


@dataclass(frozen=True)
class Interval:
    """A fitted value in the key's own unit with its 90 % interval; infinite ends where the record says nothing."""

    value: float
    low: float
    high: float


@dataclass(frozen=True)
class NamedEffect:
    """An effect of the catalogue at its place. `confidence` [0, 1] is the probability that it is named right;
    `parameters` are keys of limb.toml; `gap_share` [0, 1] is its share of what was removed of the gap."""

    name: str
    where: str
    confidence: float
    parameters: Mapping[str, Interval]
    gap_share: float

    @property
    def label(self) -> str:
        """`backlash@joint.tibia`, as classes list it."""
        return f"{self.name}@{self.where}"


@dataclass(frozen=True)
class Localised:
    """A disagreement said in words ('only when unloading, near zero force'), its family-wise p, its rms size [N]
    (joint tests: [N mm]). `share` [0, 1] is what it takes of the misfit beyond those before it; None: not counted."""

    where: str
    p: float
    size: float
    share: float | None = None


@dataclass(frozen=True)
class Unexplained:
    """What is left after the last step: rms in the gap's unit, whether it still has structure, where and what shape."""

    rms: float
    structured: bool
    description: str


@dataclass(frozen=True)
class GapPair:
    """rms of measured less model, on what was fitted and on what took no part in choosing or fitting (None: nothing
    could be held out)."""

    fitted: float
    held_out: float | None


@dataclass(frozen=True)
class GapStep:
    """The gap after one thing more was added to the model. `pull_sigma`: how far the calibrated numbers of that model
    are from their calibration, all together; None: not known."""

    added: str
    gap: GapPair
    pull_sigma: float | None = None


@dataclass(frozen=True)
class Gap:
    """The gap in `unit` ("n", "n_mm" for joint tests, "n_per_mm" for tables)."""

    unit: str
    noise_floor: float
    before: GapPair
    after: GapPair
    steps: tuple[GapStep, ...] = ()


@dataclass(frozen=True)
class HeldOut:
    """A part of the record, predicted by the model fitted to the rest of it. `by` is amplitude, direction, time or
    posture, `words` say which readings they are. `off` is the rms of measured less predicted there in the gap's unit,
    `expected` what noise and the fit's uncertainty would leave of it; `p` how often a model that holds is as far off as
    this one or further; `largest` the largest load among these readings."""

    by: str
    words: str
    off: float
    expected: float
    p: float
    holds: bool
    largest: float


@dataclass(frozen=True)
class NextExperiment:
    """What to measure next: in words, which labels it separates, with which power [0, 1], how long it takes, and the
    text of a rig file that plays it ("" where it is no rig's)."""

    action: str
    separates: tuple[str, ...]
    power: float
    minutes: float
    rig_toml: str = ""


@dataclass(frozen=True)
class Candidate:
    """One hypothesis that was tried: labels joined by ' + ', its gain (twice the log-likelihood over the refitted
    base), its share of the posterior."""

    label: str
    gain: float
    posterior: float


@dataclass(frozen=True)
class StiffnessAt:
    """K without load at commanded angles [rad], [N/mm]."""

    theta1_rad: float
    theta2_rad: float
    k_xx_n_per_mm: float
    k_xz_n_per_mm: float
    k_zz_n_per_mm: float


@dataclass(frozen=True)
class StiffnessChange:
    """K of the model as believed and as it is exported, at the posture of the record where they differ most."""

    believed: StiffnessAt
    exported: StiffnessAt


@dataclass(frozen=True)
class Alternative:
    """One of the explanations that the record leaves open: `label` (joined by ' + ' where it takes several effects) as
    `--take` asks for it, its probability, and the K that its limb gives where the explanations differ most in it."""

    label: str
    probability: float
    k: StiffnessAt


@dataclass(frozen=True)
class Residuals:
    """Measured less model, rows x channels, in the channels' units; `held_out` marks rows that took no part."""

    channels: tuple[str, ...]
    before: np.ndarray
    after: np.ndarray
    held_out: np.ndarray


@dataclass(frozen=True)
class JointSizes:
    """What a joint test shows of its joint: by key of limb.toml, with 90 % intervals, which hold for the torques up to
    `torque_n_mm` on each side and include the spread between `gear_positions`."""

    parameters: Mapping[str, Interval]
    torque_n_mm: float
    gear_positions: int


@dataclass(frozen=True)
class Diagnosis:
    """All that a diagnosis found. `model` is the limb with the effects in it (the believed one where nothing may be
    exported). `members` are the explanations that stand where one name does not; `took` is the one that `--take`
    named. `cautions` are sentences that must be read before anything of it is believed."""

    verdict: Verdict
    sentence: str
    model: LimbModel
    gap: Gap | None = None
    effects: tuple[NamedEffect, ...] = ()
    indistinguishable: tuple[tuple[str, ...], ...] = ()
    could_be: tuple[str, ...] = ()
    localised: tuple[Localised, ...] = ()
    unexplained: Unexplained | None = None
    next_experiment: NextExperiment | None = None
    data_faults: tuple[DataFault, ...] = ()
    candidates: tuple[Candidate, ...] = ()
    residuals: Residuals | None = None
    notes: tuple[str, ...] = ()
    seed: int = 0
    details: Mapping[str, Any] = field(default_factory=dict)
    members: tuple[Alternative, ...] = ()
    joint: JointSizes | None = None
    held_out: tuple[HeldOut, ...] = ()
    took: str = ""
    stiffness: StiffnessChange | None = None
    cautions: tuple[str, ...] = ()

    @property
    def exit_code(self) -> int:
        """Of the command: a script must not go on with a faulty record."""
        return EXIT_BAD_FILE if self.verdict == "data_fault" else EXIT_OK
