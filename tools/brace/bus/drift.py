"""What the check of model against measurement knows, and how take-ups went, in the dictionary's words."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from brace.wire.code import CodeTable
from brace.wire.codes import DRIFT_CAUSE, DRIFT_COULD_BE, DRIFT_NEXT_STEP, DRIFT_STATE, TAKE_UP_OUTCOME
from brace.wire.layout import Value

ALARM_EVIDENCE = 20.0  # the dictionary: drift_evidence
MANY_READINGS = 65535  # drift_since_readings: as many or more
TAKE_UPS = ("coxa", "femur", "tibia")


@dataclass(frozen=True)
class Drift:
    """Names are the dictionary's, in small letters."""

    state: str
    cause: str
    could_be: tuple[str, ...]
    evidence: Value  # the alarm is at ALARM_EVIDENCE
    loss_ratio: Value  # of its stiffness; negative: stiffer
    loss_sigma_ratio: Value
    since_readings: int
    readings: int
    next_step: str

    def as_json(self) -> dict[str, object]:
        """Names with units."""
        return {
            "state": self.state,
            "cause": self.cause,
            "could_be": list(self.could_be),
            "evidence": self.evidence,
            "alarm_evidence": ALARM_EVIDENCE,
            "loss_ratio": self.loss_ratio,
            "loss_sigma_ratio": self.loss_sigma_ratio,
            "since_readings": self.since_readings,
            "readings": self.readings,
            "next_step": self.next_step,
        }

    def lines(self) -> list[str]:
        """For a person: what, why, how sure, what next."""
        lines = [f"drift: {self.state}: {_text(DRIFT_STATE, self.state)}"]
        if self.cause != "none":
            lines.append(f"  likeliest cause: {cause_text(self.cause)}")
            others = [name for name in self.could_be if name != self.cause]
            if others:
                lines.append(f"  could also be: {', '.join(others)}")
            lines.append(f"  {', '.join(self._strength())}")
        else:
            lines.append(f"  {self.readings} readings so far")
        lines.append(f"  next: {_text(DRIFT_NEXT_STEP, self.next_step)}")
        return lines

    def _strength(self) -> list[str]:
        parts = []
        if self.evidence is not None:
            parts.append(f"evidence {self.evidence:.1f}, the alarm is at {ALARM_EVIDENCE:g}")
        if self.loss_ratio is not None:
            way = "stiffness lost" if self.loss_ratio >= 0 else "stiffness gained"
            sigma = "" if self.loss_sigma_ratio is None else f" +- {100 * self.loss_sigma_ratio:.1f} % (one sigma)"
            parts.append(f"{way} {100 * abs(self.loss_ratio):.1f} %{sigma}")
        since = f"{MANY_READINGS} or more" if self.since_readings >= MANY_READINGS else str(self.since_readings)
        return [*parts, f"began {since} readings ago, of {self.readings}"]


def drift_of(values: Mapping[str, Value], prefix: str = "", ratio: str = "") -> Drift:
    """From the fields of an answer, or from measured values, whose names have a prefix and end in their unit."""
    numbers = {name: int(values[prefix + name] or 0) for name in ("state", "cause", "could_be", "next_step")}
    return Drift(
        DRIFT_STATE.word_of(numbers["state"]),
        DRIFT_CAUSE.word_of(numbers["cause"]),
        tuple(name.lower() for name in DRIFT_COULD_BE.names_of_bits(numbers["could_be"])),
        values[f"{prefix}evidence"],
        values[f"{prefix}loss{ratio}"],
        values[f"{prefix}loss_sigma{ratio}"],
        int(values[f"{prefix}since_readings"] or 0),
        int(values[f"{prefix}readings"] or 0),
        DRIFT_NEXT_STEP.word_of(numbers["next_step"]),
    )


def cause_text(cause: str) -> str:
    """A cause and what it means."""
    return f"{cause}: {_text(DRIFT_CAUSE, cause)}"


def take_up_of(number: int) -> str:
    """A take-up's outcome by its number."""
    return TAKE_UP_OUTCOME.word_of(number)


def take_up_lines(take_ups: Mapping[str, str]) -> list[str]:
    """What a person should know of the joints whose take-up was asked for."""
    asked = {joint: outcome for joint, outcome in take_ups.items() if outcome != "none"}
    return [f"take-up {joint}: {outcome}: {_text(TAKE_UP_OUTCOME, outcome)}" for joint, outcome in asked.items()]


def _text(table: CodeTable, name: str) -> str:
    return next((code.text for code in table.codes if code.name.lower() == name), "a code without a meaning here")
