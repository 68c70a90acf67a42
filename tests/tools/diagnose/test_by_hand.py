"""What a person is told to do where no loading test on the rig tells explanations apart."""

from __future__ import annotations

from brace.diagnose.loading.next_experiment.by_hand import ANGLES, GAUGE, WEIGHTS, orders


def test_a_sensor_is_told_from_a_limb_by_known_weights() -> None:
    assert WEIGHTS in list(orders(["sensor_gain@sensor", "joint_compliance@joint.femur"]))
    assert WEIGHTS not in list(orders(["sensor_gain@sensor", "sensor_crosstalk@sensor"]))


def test_a_joint_is_told_from_a_link_by_locking_it() -> None:
    (order,) = orders(["joint_compliance@joint.tibia", "link_compliance_error@link.tibia"])
    assert "lock the knee" in order


def test_a_joint_and_a_base_that_turns() -> None:
    found = list(orders(["joint_compliance@joint.femur", "base_compliance@base"]))
    assert found[0] == GAUGE and "lock the femur joint" in found[1]


def test_angles_are_measured_and_not_locked() -> None:
    assert list(orders(["joint_zero_offset@joint.femur", "link_compliance_error@link.femur"])) == [ANGLES]


def test_a_part_that_every_explanation_has_tells_nothing() -> None:
    both = ["backlash@joint.tibia + creep@creep", "backlash@joint.tibia"]
    assert list(orders(both)) == []
