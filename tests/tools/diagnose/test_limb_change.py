"""A change of the limb is said as the limb changed, and damage asks for a look at the limb before anything else."""

from __future__ import annotations

from pathlib import Path

import pytest
from handmade import GAP_KEY

from brace.diagnose.diagnosis import Diagnosis, Interval, NamedEffect
from brace.diagnose.limb_change import in_words, inspections, limb_change
from brace.diagnose.report.facts import _refitted
from brace.diagnose.summary import lines
from brace.model import LimbModel, load_limb

LIMB = Path(__file__).resolve().parents[3] / "tools" / "brace" / "data" / "paper-limb.toml"
BENDING, FACTOR, AT = "link.tibia.bending_mm_per_n", "change.bending_factor", "change.at_s"


def _changed(factor: float) -> tuple[LimbModel, Diagnosis]:
    """The tibia is `factor` times softer from some moment between 1736 and 1768 s on."""
    believed = load_limb(LIMB)
    values: dict[str, float | str] = {BENDING: 0.25 * factor, FACTOR: 1.0 / factor, AT: 1766.0, "change.link": "tibia"}
    model = believed.with_values({**values, "geometry.femur_mm": 185.1})
    sizes = {FACTOR: Interval(1.0 / factor, 0.9 / factor, 1.1 / factor), AT: Interval(1766.0, 1736.0, 1768.0)}
    return believed, Diagnosis(
        "effect", "Missing.", model, effects=(NamedEffect("link_change", "link.tibia", 0.98, sizes, 1.0),)
    )


@pytest.mark.parametrize(
    ("factor", "words"), [(2.5, "2.5 times (2.27 to 2.78) softer"), (0.4, "2.5 times (2.25 to 2.75) stiffer")]
)
def test_the_direction_is_that_of_the_limb(factor: float, words: str) -> None:
    """limb.toml has the compliance before over the one now, so a factor below one is a limb that became softer."""
    _, found = _changed(factor)
    now = 0.25 * factor
    assert in_words(found.model, found) == [
        f"The tibia became {words} in bending: 0.25 -> {now:.3g} mm/N, between 1736 and 1768 s of the record."
    ]


def test_what_changed_is_not_among_what_was_refitted() -> None:
    believed, found = _changed(2.5)
    assert [key for key, *_ in _refitted(believed, found)] == ["geometry.femur_mm"]


def test_a_model_without_the_change_says_no_value() -> None:
    believed, found = _changed(2.5)
    assert limb_change(believed, found.effects[0]) is None


def test_damage_is_inspected_first() -> None:
    believed, found = _changed(2.5)
    (said,) = inspections(believed, found)
    assert said.startswith("Inspect the tibia for a crack or a loose joint before loading it further")
    assert any(line.startswith("  first      inspect the tibia") for line in lines(found, believed))


def test_only_play_that_has_grown_is_wear() -> None:
    """A model without play may never have been asked; one with less of it was."""
    play = NamedEffect("backlash", "joint.tibia", 0.98, {GAP_KEY: Interval(0.006, 0.005, 0.007)}, 1.0)
    limb = load_limb(LIMB)
    for believed, is_worn in ((0.0, False), (0.003, True), (0.009, False)):
        found = Diagnosis("effect", "Missing.", limb.with_values({GAP_KEY: 0.006}), effects=(play,))
        said = inspections(limb.with_values({GAP_KEY: believed}), found)
        assert bool(said) == is_worn and (not said or "knee joint for worn teeth" in said[0])
