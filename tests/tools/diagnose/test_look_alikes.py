"""Which look-alikes a large stroke or a preload tells apart. Prints its table: run it with -s.

A number of limb.toml leaves a trace in a record: the change of the forces as the number is turned a little. The sine of
the angle between two traces says how much of the one the other cannot make up: 0 are look-alikes."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from brace.diagnose.loading.next_experiment.confusability import Confusability, in_words
from brace.model import LimbModel, load_limb
from brace.native.plant import play_rig
from brace.native.plant_batch import LoadingBatchPlayer, model_numbers, number_index
from brace.rig.rig import load_rig

BEAMS = {"link.femur.moment_transfer": 1.0, "link.tibia.moment_transfer": 1.0}
STEPS = {
    "joint.tibia.compliance_rad_per_n_mm": 1e-8,
    "link.tibia.bending_mm_per_n": 1e-4,
    "joint.femur.compliance_rad_per_n_mm": 1e-8,
    "base.rotation_rad_per_n_mm": 1e-8,
    "base.x_mm_per_n": 1e-5,
    "link.femur.axial_mm_per_n": 1e-5,
}
PAIRS = tuple(zip(list(STEPS)[::2], list(STEPS)[1::2]))
RECORDS = {"does not turn": (True, 0.0), "2.54 mm": (False, 0.0), "preload 5 mm": (False, 5.0), "20 mm": (False, 20.0)}


def traces(limb: LimbModel, rig: Path, small: bool, preload_mm: float) -> dict[str, np.ndarray]:
    design = load_rig(rig).design(limb) | {"preload_x_mm": preload_mm, "preload_z_mm": preload_mm}
    player = LoadingBatchPlayer(play_rig(None, design), ("fx_n", "fz_n"), small_displacements=small)
    models = np.tile(model_numbers(limb), (len(STEPS) + 1, 1))
    for row, (key, step) in enumerate(STEPS.items(), start=1):
        models[row, number_index()[key]] += step
    played = player.play_numbers(models).reshape(len(models), -1)
    moved = (played[1:] - played[0]) / np.array(list(STEPS.values()))[:, None]
    return dict(zip(STEPS, moved / np.linalg.norm(moved, axis=1)[:, None]))


@pytest.mark.parametrize("links", ["ellipsoids", "beams"])
def test_what_turning_tells_apart(links: str, paper_limb: Path, paper_rig: Path) -> None:
    limb = load_limb(paper_limb).with_values(BEAMS if links == "beams" else {})
    sines: dict[str, list[float]] = {}
    for small, preload_mm in RECORDS.values():
        of = traces(limb, paper_rig, small, preload_mm)
        for one, other in PAIRS:
            sine = float(np.sqrt(max(0.0, 1.0 - (of[one] @ of[other]) ** 2)))
            sines.setdefault(f"{one} | {other}", []).append(sine)
    print(f"\n{links}: sine between traces", *RECORDS, sep=" | ")
    for pair, values in sines.items():
        print(pair, *(f"{value:.2g}" for value in values), sep=" | ")
    knee, hip, base = sines.values()
    # The tibia's bending moves the tip as the knee does; only where the knee turns far its lever is another one.
    assert knee[0] < 1e-4 and 0.01 < knee[1] and knee[3] > 5.0 * knee[1]
    assert max(hip) < 1e-6  # one axis: whatever turns about it is the same to the tip
    assert base[3] < base[0]  # a preload does not help everywhere


LIKE_B = "in this record a looks like b (of 100 such records 30 would tell the two apart)"


def test_only_what_a_record_may_not_tell_apart_is_told_as_alike() -> None:
    labels = ("a", "b", "c", "d")
    alike = np.array([[1.0, 0.99, 0.97, 0.5]] * 4)
    power = np.array([[1.0, 0.3, 0.96, 0.1]] * 4)
    found = Confusability(labels, np.ones(4), alike, np.zeros((4, 4)), power)
    assert in_words(found, ["a"]) == (LIKE_B,)
    assert in_words(found, ["e"]) == ()
    assert in_words(replace(found, power=np.ones((4, 4))), ["a"]) == ()


def test_a_class_holds_what_is_alike_by_way_of_another() -> None:
    """a makes what b makes, b what c makes, and a not what c makes; d is like none."""
    alike = np.eye(4)
    alike[0, 1] = alike[1, 2] = 0.99
    found = Confusability(("a", "b", "c", "d"), np.ones(4), alike, np.zeros((4, 4)), np.ones((4, 4)))
    assert found.classes == (("a", "b", "c"),)


def test_two_that_look_like_each_other_are_told_once() -> None:
    power = np.array([[1.0, 0.3], [0.2, 1.0]])
    found = Confusability(("a", "b"), np.ones(2), np.ones((2, 2)), np.zeros((2, 2)), power)
    assert in_words(found, ["a", "b"]) == (LIKE_B,)
    # What b looks like stands nowhere else where a does not look like b.
    one_way = replace(found, cosine=np.array([[1.0, 0.5], [0.99, 1.0]]))
    assert in_words(one_way, ["a", "b"]) == (
        "in this record b looks like a (of 100 such records 20 would tell the two apart)",
    )
