"""What one row of the catalogue says of an effect."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from brace.effects.record import JointTestBench, JointTestSize, LoadingPlace, LoadingSize
from brace.model.keys import KEY_BY_NAME

Limits = Callable[[LoadingPlace], tuple[float, float]]
Tries = Callable[[LoadingPlace], tuple[float, ...]]


def whole_range(at: LoadingPlace) -> tuple[float, float]:
    """A fit may go as far as limb.toml allows."""
    return at.range


def no_tries(_: LoadingPlace) -> tuple[float, ...]:
    """A fit starts from the believed value alone."""
    return ()


@dataclass(frozen=True)
class Number:
    """A number of limb.toml that an effect turns. Its unit and its range stand in the controller's dictionary.

    leaf         the last part of its key
    scale        a change of this size matters, in the number's own unit; a fit of a number that may be zero needs it
    limits       how far the fit of a loading record may turn it, where that is less than the dictionary's range
    tries        where that fit starts besides the believed value
    table        the table of limb.toml where the number stands, when that is not the place where the effect sits
    stepwise     the number is a time: readings jump as it passes them and stand still between
    still        turned a little from the zero effect it moves no reading, as a moment or a limit does
    trust        the key of [uncertainty] that says how well a calibration knows the number ("" when none does)
    strained     at the upper end of its range it stands for something else, so a joint test does not name it there
    plausible_times  so many times the believed value is three sigma of what a limb may have: more needs evidence to
                 match, where another cause explains the record as well
    """

    leaf: str
    scale: float
    limits: Limits = whole_range
    tries: Tries = no_tries
    table: str = ""
    stepwise: bool = False
    still: bool = False
    trust: str = ""
    strained: bool = False
    plausible_times: float = float("inf")

    def key(self, where: str) -> str:
        """`joint.tibia.gap_rad`."""
        return f"{self.table or where}.{self.leaf}"


@dataclass(frozen=True)
class Way:
    """One way for an effect to show in a loading record: the numbers that are fitted and those that are set.
    `stands_for` maps a fitted leaf to another that the record shows only in sum with it, and how much of the other
    makes the same readings. `seen`: whether a record of this size shows more of this way than of those before it.
    `multiplies` maps a leaf to the leaf of the place that changes by it: a fit turns the factor from the change on,
    over what was believed; limb.toml has what the place is today, and the factor by which it was another one before.
    `became`: what the place is called whose number shrank, and whose number grew."""

    fitted: tuple[str, ...]
    fixed: Callable[[str], Mapping[str, float]] = lambda where: {}  # leaf to value, by place
    stands_for: Mapping[str, tuple[str, float]] = field(default_factory=dict)
    seen: Callable[[LoadingSize], bool] = lambda size: True
    multiplies: Mapping[str, str] = field(default_factory=dict)
    became: tuple[str, str] = ("", "")


@dataclass(frozen=True)
class Turn:
    """How the fit of a joint test turns one number. `start` is given for what is no key of limb.toml. `prior_sigma`:
    the size that joints have; the number is drawn to its start where it is larger."""

    leaf: str
    scale: float
    low: float = float("-inf")
    high: float = float("inf")
    start: float | None = None
    prior_sigma: float = float("inf")


def always(_: object) -> bool:
    """Every record can show the effect."""
    return True


def moves_nothing(_values: Mapping[str, float], _size: JointTestSize, _compliance_rad_per_n_mm: float) -> float:
    """The effect takes nothing from knowing the joint's angle."""
    return 0.0


@dataclass(frozen=True)
class InJointTest:
    """How the effect shows where one joint is turned on the bench.

    turns          the numbers that a fit turns, and how
    starts         values by leaf that the fit starts from, one mapping a start
    seen           whether this record can show the effect
    spring_factor  each start is tried once more with the joint's compliance times this, by the values (by leaf) of
                   the start: for an effect that takes way or torque from the spring
    lost_rad       how far the effect moves the joint, by fitted values (by leaf) and compliance: of effects that are
                   equally sure, the one that takes most from knowing the angle is named first
    """

    turns: Callable[[JointTestSize], tuple[Turn, ...]]
    starts: Callable[[JointTestSize], tuple[Mapping[str, float], ...]]
    seen: Callable[[JointTestBench], bool] = always
    spring_factor: Callable[[Mapping[str, float], JointTestSize], float] | None = None
    lost_rad: Callable[[Mapping[str, float], JointTestSize, float], float] = moves_nothing


@dataclass(frozen=True)
class Effect:
    """One row.

    places        where the effect may sit: tables of limb.toml
    words         its name as a person says it, and `meaning`, what it does, in half a sentence
    law           what it does as a formula; host_sim/effects/<name>.h computes it
    told_by       what a record must show to distinguish it from other effects
    ways          how it may show in a loading record; the first one is the most likely
    loading_seen  whether a loading record of this size can show it
    follows_time  it follows time, temperature or the order of the runs
    inspect       what to look for at its place, because it is damage or wear ("" where it is neither)
    wears         sound limbs have it, too: only a limb that has more of it than its model is worn
    joint_test    how it shows in a joint test; None where a joint test cannot show it
    in_tables     a table of K can show it
    """

    name: str
    places: tuple[str, ...]
    words: str
    meaning: str
    law: str
    told_by: str
    numbers: tuple[Number, ...]
    ways: tuple[Way, ...]
    loading_seen: Callable[[LoadingSize, str], bool] = lambda size, where: True
    follows_time: bool = False
    inspect: str = ""
    wears: bool = False
    joint_test: InJointTest | None = None
    in_tables: bool = False

    @property
    def labels(self) -> tuple[str, ...]:
        """`backlash@joint.femur`, one for each place."""
        return tuple(f"{self.name}@{where}" for where in self.places)

    @property
    def keys(self) -> tuple[str, ...]:
        """Its keys of limb.toml at all its places."""
        return tuple(dict.fromkeys(number.key(where) for where in self.places for number in self.numbers))

    def number(self, leaf: str) -> Number:
        """A number by the last part of its key."""
        return next(number for number in self.numbers if number.leaf == leaf)

    def key(self, leaf: str, where: str) -> str:
        """The key of a leaf at a place."""
        return self.number(leaf).key(where)

    def check(self) -> None:
        """Refuses a row whose keys the dictionary does not have."""
        missing = [key for key in self.keys if key not in KEY_BY_NAME]
        if missing:
            raise ValueError(
                f"effect {self.name}: limb.toml has no key {missing[0]}; "
                "firmware/interface/dictionary.toml must list it first"
            )
