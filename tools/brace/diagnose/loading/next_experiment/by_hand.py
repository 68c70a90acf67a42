"""What a person may do where no loading test on the rig tells two explanations apart: each takes a part out of the
limb, or tests a part by itself."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

SENSOR, OFFSETS = "sensor", ("joint_zero_offset", "link_length_error")
WEIGHTS = "hang known weights on the force sensor, along x and along z: what it reads then is of the sensor alone"
ANGLES = "measure the joints' angles and the links' lengths at one posture"
GAUGE = "put a dial gauge on the base"


def orders(labels: Sequence[str]) -> Iterator[str]:
    """Orders that part the `labels` (joined by " + " where an explanation has several effects): what some of them
    would show and others would not."""
    sides = [set(label.split(" + ")) for label in labels]
    for words, shows in _TESTS:
        if 0 < sum(any(shows(one) for one in side) for side in sides) < len(sides):
            yield words
    for joint, words in (("joint.femur", "femur joint"), ("joint.tibia", "knee")):
        with_it = [any(one.endswith(f"@{joint}") and not _is_angle(one) for one in side) for side in sides]
        if any(with_it) and not all(with_it):
            yield f"lock the {words} and load again: what stays is not of this joint"


def _is_angle(label: str) -> bool:
    return label.startswith(OFFSETS)


def _of_sensor(label: str) -> bool:
    return label.endswith(f"@{SENSOR}")


def _of_base(label: str) -> bool:
    return label.startswith("base_compliance")


_TESTS = ((WEIGHTS, _of_sensor), (ANGLES, _is_angle), (GAUGE, _of_base))
