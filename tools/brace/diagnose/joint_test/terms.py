"""What may be missing in a joint: effects of the catalogue as terms of a fit."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from brace.effects import EFFECTS, Effect, JointTestBench, JointTestSize
from brace.effects.row import InJointTest, Turn
from brace.identify.parameters import Parameter
from brace.model import LimbModel
from brace.model.keys import KEY_BY_NAME

# effect: of the catalogue. record: the record's own, which stays in every fit that is exported. law: how an effect goes
# on in detail, which nothing is named for. shape: of no effect; what is left is then unknown.
Role = Literal["effect", "record", "law", "shape"]


@dataclass(frozen=True)
class Term:
    """One thing that may be missing: parameters that it frees, and values to start them from. `effect` is its row of
    the catalogue; other roles have none."""

    name: str
    where: str
    parameters: tuple[Parameter, ...]
    starts: tuple[Mapping[str, float], ...]
    effect: Effect | None = None
    role: Role = "effect"

    @property
    def label(self) -> str:
        return f"{self.name}@{self.where}"

    @property
    def shows(self) -> InJointTest | None:
        """How the effect shows in a joint test; None for a shape."""
        return self.effect.joint_test if self.effect is not None else None

    def ends_strained(self, parameter: Parameter) -> bool:
        """Whether the parameter stands for something else at the upper end of its range."""
        leaf = parameter.key.rpartition(".")[2]
        numbers = self.effect.numbers if self.effect is not None else ()
        return any(number.leaf == leaf and number.strained for number in numbers)

    def by_leaf(self, values: Mapping[str, float]) -> dict[str, float]:
        """The term's own values by the last part of their keys, as its row of the catalogue asks for them."""
        return {parameter.key.rpartition(".")[2]: values[parameter.key] for parameter in self.parameters}


def effects_of(model: LimbModel, joint: str, bench: JointTestBench) -> list[Term]:
    """Effects of the catalogue that this joint test can show, in the catalogue's order."""
    return [_term(effect, effect.joint_test, model, joint, bench.size) for effect in EFFECTS
            if effect.joint_test is not None and effect.joint_test.seen(bench)]  # fmt: skip


def _term(effect: Effect, shows: InJointTest, model: LimbModel, joint: str, size: JointTestSize) -> Term:
    own = f"joint.{joint}"
    where = own if effect.places[0].startswith("joint.") else effect.places[0]

    def key(leaf: str) -> str:
        """What is no number of the effect is the record's own, and keeps its name."""
        return f"{where}.{leaf}" if f"{where}.{leaf}" in KEY_BY_NAME else leaf

    def parameter(turn: Turn) -> Parameter:
        if turn.start is not None:
            return Parameter(turn.leaf, turn.start, turn.scale, turn.low, turn.high)
        entry = KEY_BY_NAME[key(turn.leaf)]
        low, high = max(entry.low, turn.low), min(entry.high, turn.high)
        return Parameter(entry.name, model.number(entry.name), turn.scale, low, high, turn.prior_sigma)

    return Term(
        effect.name,
        where,
        tuple(parameter(turn) for turn in shows.turns(size)),
        tuple({key(leaf): value for leaf, value in start.items()} for start in shows.starts(size)),
        effect,
    )
