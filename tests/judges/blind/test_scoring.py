"""The judge: what counts as right, shares and intervals, against hand-worked examples."""

from __future__ import annotations

from typing import Any

import pytest
from report import promises
from scoring import Share, calibration, calibration_scatter, judge


def truth(kind: str = "single", *names: str, **more: Any) -> dict[str, Any]:
    effects = [dict(zip(("name", "where"), n.split("@"), strict=True)) for n in names]
    return {"id": "x", "kind": kind, "effects": effects, "detectability": 12, "cls": [], **more}


def said(verdict: str, *names: str, confidence: float = 0.9, **more: Any) -> dict[str, Any]:
    effects = [
        {**dict(zip(("name", "where"), n.split("@"), strict=True)), "confidence": confidence, "parameters": {}}
        for n in names
    ]
    return {"verdict": verdict, "effects": effects, **more}


def test_single() -> None:
    """Right, wrong place, look-alike with and without its class, silence."""
    real = truth("single", "backlash@joint.femur", cls=["backlash@joint.femur", "joint_hardening@joint.femur"])
    right = judge(real, said("effect", "backlash@joint.femur")).flags
    assert right["exact"] and right["where"] and right["class"] and not right["extra"]
    place = judge(real, said("effect", "backlash@joint.tibia")).flags
    assert place["exact"] and not place["where"] and place["class"]
    alone = judge(real, said("effect", "joint_hardening@joint.femur")).flags
    assert not alone["exact"] and not alone["class"]
    group = [["joint_hardening@joint.femur", "backlash@joint.femur"]]
    named = judge(real, said("ambiguous", "joint_hardening@joint.femur", indistinguishable=group)).flags
    assert named["class"] and not named["exact"]
    outside_class = judge(real, said("effect", "creep@creep", "backlash@joint.femur")).flags
    assert not outside_class["class"] and outside_class["extra"]
    assert not any(judge(real, said("none")).flags[f] for f in ("exact", "where", "class"))
    assert not judge(real, {}).flags["class"]


def test_none_outside_fault() -> None:
    """Alarms, names for the nameless, the right field."""
    assert not judge(truth("none"), said("none")).flags["false_alarm"]
    assert all(
        judge(truth("none"), said(v)).flags["false_alarm"] for v in ("effect", "unknown", "data_fault", "ambiguous")
    )
    assert judge(truth("none"), {}).flags["false_alarm"]
    out = truth("outside", "slip@outside")
    assert judge(out, said("unknown")).flags["unknown"]
    assert judge(out, said("effect", "creep@creep", confidence=0.9)).flags["misnamed"]
    assert not judge(out, said("effect", "creep@creep", confidence=0.7)).flags["misnamed"]
    glitches, why = truth("outside", "glitch_bursts@outside"), "single readings stand out (row 7)"
    assert judge(glitches, said("data_fault", data_faults=[{"field": "fx_n", "why": why}])).flags["unknown"]
    for hidden, sentence in ((glitches, "the sensor reads +5 % from row 7 on"), (out, why)):
        wrong = judge(hidden, said("data_fault", data_faults=[{"field": "fx_n", "why": sentence}])).flags
        assert wrong["misnamed"] and not wrong["unknown"]
    bad = truth("data_fault", fields=["fx_n"])
    assert judge(bad, said("data_fault", data_faults=[{"field": "fx_n"}])).flags["fault"]
    assert not judge(bad, said("data_fault", data_faults=[{"field": "t_s"}])).flags["fault"]


def test_pairs() -> None:
    """Both and nothing else; with classes, each truth by a member of its own."""
    real = truth("pair", "creep@creep", "backlash@joint.femur",
                 cls_each=[["creep@creep"], ["backlash@joint.femur", "joint_hardening@joint.femur"]])  # fmt: skip
    assert judge(real, said("effect", "backlash@joint.femur", "creep@creep")).flags["set"]
    assert not judge(real, said("effect", "creep@creep")).flags["set"]
    kin = judge(real, said("effect", "joint_hardening@joint.femur", "creep@creep")).flags
    assert not kin["set"] and kin["set_or_class"]
    assert not judge(real, said("effect", "creep@creep", "creep@creep")).flags["set_or_class"]


def test_intervals_of_what_is_named_right() -> None:
    """Inside, outside, open end; what is named wrong does not count."""
    real = truth("single", "sensor_bias@sensor", true_parameters={"sensor.bias_x_n": 0.5, "sensor.bias_z_n": 0.5})
    found = said("effect", "sensor_bias@sensor", "creep@creep")
    found["effects"][0]["parameters"] = {
        "sensor.bias_x_n": {"value": 0.4, "low": 0.3, "high": 0.6},
        "sensor.bias_z_n": {"value": 0.1, "low": None, "high": 0.2},
    }
    found["effects"][1]["parameters"] = {"sensor.bias_x_n": {"value": 9.0, "low": 8.0, "high": 10.0}}
    assert judge(real, found).intervals == [("sensor.bias_x_n", True), ("sensor.bias_z_n", False)]


def test_figures() -> None:
    """Wilson's interval of 8 of 10; calibration error of claims at 0.9 that are right half the time."""
    assert Share(8, 10).wilson() == pytest.approx((0.4902, 0.9433), abs=1e-4)
    cases = [judge(truth("single", n), said("effect", "creep@creep")) for n in ("creep@creep", "gravity@gravity")]
    error, claims, _ = calibration(cases)
    assert claims == 2 and error == pytest.approx(0.4)
    # of n claims at 0.9 the share right scatters by 0.3 / sqrt(n), whose mean size is 0.8 of it
    middle, high = calibration_scatter(50 * cases)
    assert middle == pytest.approx(0.8 * 0.3 / 10, rel=0.4) and 1.5 < high / middle < 4.0


def test_disguised() -> None:
    """Outside the catalogue, but exactly like entries of it: their names or unknown, nothing else."""
    alike = ["sensor_rotation@sensor", "joint_zero_offset@joint.femur"]
    real = {**truth("disguised", "rig_turned@outside"), "alike": alike}
    assert judge(real, said("unknown")).flags["seen_through"]
    assert judge(real, said("effect", *reversed(alike))).flags["seen_through"]
    assert not judge(real, said("effect", alike[0])).flags["seen_through"]
    assert not judge(real, said("none")).flags["seen_through"]


def test_outsiders_by_their_own_names() -> None:
    """The tool is right when the true name is among the names of its class. Any other name, said with 0.9, is
    wrong."""
    real = {
        **truth("disguised", "rig_turned@outside"),
        "alike": ["sensor_rotation@sensor"],
    }
    own = judge(real, said("effect", "rig_rotation@rig", "gravity@gravity", confidence=0.9)).flags
    assert own["seen_through"] and not own["misnamed"] and not own["unknown"]
    other = judge(real, said("effect", "rig_compliance@rig", confidence=0.9)).flags
    assert other["misnamed"] and not other["seen_through"]
    played = judge(
        truth("outside", "off_centre_play@outside"),
        said("ambiguous", "off_centre_play@joint.tibia"),
    ).flags
    assert played["seen_through"] and not played["misnamed"]


def test_promises_beside_what_they_brought() -> None:
    """Cases are counted in bins of the promise. A case without a played experiment or a promise does not count."""
    rows = [
        {"played": played, "promised": promised, "right_after": right}
        for played, promised, right in (
            *((True, 0.5, False), (True, 0.7, True), (True, 0.99, True), (True, 0.97, True), (True, 1.0, False)),
            *((False, 0.99, False), (True, None, False)),
        )
    ]
    low, high = promises(rows)
    assert low == pytest.approx((0.6, 0.5, 2))
    assert high == pytest.approx((2.96 / 3, 2 / 3, 3))
