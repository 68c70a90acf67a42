"""The judge: what counts as right, as named, as impossible."""

from __future__ import annotations

from typing import Any

import pytest
from joints import WHERE
from verdicts import Word, judge
from words import OUTSIDERS, TROUBLES


def truth(**more: Any) -> dict[str, Any]:
    """A joint test with play."""
    usual = {"part": "joint", "effects": [{"name": "backlash", "where": WHERE}], "cls": [], "trouble": "",
             "outside": "", "swing_rad": 0.03, "size": {}}  # fmt: skip
    return usual | more


def said(*names: str, verdict: str = "effect", **more: Any) -> dict[str, Any]:
    """A diagnosis that names effects with 0.95."""
    effects = [{"name": n.split("@")[0], "where": n.split("@")[1], "confidence": 0.95, "parameters": {}} for n in names]
    return {"verdict": verdict, "effects": effects, **more}


def judged(about: dict[str, Any], found: dict[str, Any]) -> Word:
    return judge(about, found, {})


def test_names() -> None:
    """Right, wrong, and right by its class."""
    assert not judged(truth(), said(f"backlash@{WHERE}")).wrong(0.9)
    assert judged(truth(), said(f"backlash@{WHERE}")).found
    word = judged(truth(), said(f"backlash@{WHERE}", "creep@creep"))
    assert word.wrong(0.9) == ["creep@creep 0.95"]
    by_class = said("base_compliance@base", indistinguishable=[["base_compliance@base", "rig_compliance@rig"]])
    word = judged(truth(part="loading", effects=[], trouble="rig_compliance", trouble_s=30.0), by_class)
    assert not word.wrong(0.9)
    assert word.told
    assert not word.claims[0].right
    assert not word.wrongly_named
    alone = judged(
        truth(part="loading", effects=[], trouble="rig_compliance", trouble_s=30.0), said("base_compliance@base")
    )
    assert alone.wrong(0.9)
    assert alone.wrongly_named
    assert alone.told is False


def test_a_member_of_two_names() -> None:
    """A class is named by either of two names that stand in it together; a name outside it is still wrong."""
    pair = ["rig_rotation@rig", f"sensor_rotation@sensor + joint_zero_offset@{WHERE}"]
    about = truth(part="loading", effects=[], trouble="rig_rotation", trouble_s=30.0)
    by_class = said("rig_rotation@rig", "sensor_rotation@sensor", indistinguishable=[pair])
    assert not judged(about, by_class).wrongly_named
    besides = said("rig_rotation@rig", "sensor_gain@sensor", indistinguishable=[pair])
    assert judged(about, besides).wrong(0.9) == ["sensor_gain@sensor 0.95"]


def test_a_gap_larger_than_the_swing() -> None:
    """Is wrong, though play is there."""
    found = said(f"backlash@{WHERE}")
    found["effects"][0]["parameters"] = {f"{WHERE}.gap_rad": {"value": 0.04, "low": 0.03, "high": 0.05}}
    assert judged(truth(), found).wrong(0.9)


@pytest.mark.parametrize("trouble", sorted(TROUBLES))
def test_troubles(trouble: str) -> None:
    """A wrong effect is none of the words; one of the words is; silence only where the table says so."""
    about = truth(effects=[], trouble=trouble)
    assert judged(about, said(f"joint_hardening@{WHERE}")).told is False
    for name in TROUBLES[trouble].names:
        assert judged(about, said(f"{name}@sensor")).told
    assert judged(about, said(verdict="none")).told is TROUBLES[trouble].silence


@pytest.mark.parametrize("outside", sorted(OUTSIDERS))
def test_outsiders(outside: str) -> None:
    """Unknown names them, hardening misnames them; a right name beside them does not name them."""
    about = truth(effects=[], outside=outside)
    assert judged(about, said(verdict="unknown")).told
    assert judged(about, said(f"joint_hardening@{WHERE}")).misnamed
    for name in OUTSIDERS[outside].also:
        word = judged(about, said(f"{name}@{WHERE}"))
        assert not word.misnamed
        assert not word.told


def test_units_and_weak_troubles() -> None:
    """Nothing is right before the units are; a trouble below 8 sigmas is not asked for."""
    assert judged(truth(trouble="other_units"), said(f"backlash@{WHERE}")).wrong(0.9)
    weak = truth(part="loading", effects=[], trouble="gain_step", trouble_s=3.0)
    assert judged(weak, said(verdict="none")).told is None


def test_intervals_of_a_position_left_out() -> None:
    """Held, missed, or not given."""
    about = truth(
        left_out={f"{WHERE}.gap_rad": 0.01, f"{WHERE}.coulomb_n_mm": 300.0, f"{WHERE}.compliance_rad_per_n_mm": 1e-6}
    )
    found = said(f"backlash@{WHERE}", f"coulomb_friction@{WHERE}")
    found["effects"][0]["parameters"] = {f"{WHERE}.gap_rad": {"value": 0.011, "low": 0.009, "high": None}}
    found["effects"][1]["parameters"] = {f"{WHERE}.coulomb_n_mm": {"value": 200.0, "low": 150.0, "high": 250.0}}
    assert judged(about, found).covered == {"gap_rad": True, "coulomb_n_mm": False, "compliance_rad_per_n_mm": None}
