"""Coulomb's law holds where many feet slide in one step: a statement on forces and places alone, whoever found them."""

import numpy as np
import pytest
from brace.stance.limb_law import Spring
from brace.stance.statics import OK, OPEN, SLIDES, STICKS, Contact, State, Statics

LIMBS, FRICTION, GRIP_N = 6, 0.35, 2.0
LOADS = [(np.array([0.0, 0.0, -30.0]), np.zeros(3)), (np.array([3.0, 0.0, -5.0]), np.array([30.0, 0.0, 0.0]))]


def _slid(seed: int, grips: bool) -> tuple[Statics, list[Contact], np.ndarray, np.ndarray, State] | None:
    """A body on limbs of any stiffness whose footholds are 0.5 mm off, put down at once; None: it has no rest."""
    chance = np.random.default_rng([seed, grips])
    angle = np.arange(LIMBS) * np.pi / 3 + chance.normal(0, 0.1, LIMBS)
    feet_mm = np.stack([250 * np.cos(angle), 250 * np.sin(angle), chance.normal(-100, 10, LIMBS)], -1)
    turns = np.linalg.qr(chance.normal(size=(LIMBS, 3, 3)))[0]
    k = turns @ (np.exp(chance.uniform(np.log(0.5), np.log(20), (LIMBS, 3)))[:, :, None] * turns.transpose(0, 2, 1))
    normals = np.array([0.0, 0.0, 1.0]) + np.c_[chance.normal(0, 0.1, (LIMBS, 2)), np.zeros(LIMBS)]
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    contacts = [Contact(normal, FRICTION, GRIP_N if grips else 0.0) for normal in normals]
    statics = Statics(feet_mm, contacts)
    statics.set_springs([Spring(one, np.zeros(3), ()) for one in k], np.zeros((LIMBS, 3)))
    offset_mm = chance.normal(0, 0.5, (LIMBS, 3))
    state = statics.place(offset_mm)
    status, _ = statics.settle(state, LOADS, 1)
    return (statics, contacts, feet_mm, offset_mm, state) if status == OK else None


@pytest.mark.parametrize("grips", [False, True])
def test_feet_that_slide_obey_coulomb(grips: bool) -> None:
    stances = [_slid(seed, grips) for seed in range(300)]
    found = [one for one in stances if one is not None]
    against: list[bool] = []
    for _, contacts, feet_mm, offset_mm, state in found:
        force_n = state.force_n
        assert np.abs(force_n.sum(axis=0) + sum(force for force, _ in LOADS)).max() < 1e-6
        for contact, force, slid_mm, held in zip(
            contacts, force_n, state.place_mm - offset_mm, state.contact, strict=True
        ):
            pressing_n = float(contact.normal @ force) + contact.grip_n
            along_n = force - float(contact.normal @ force) * contact.normal
            assert pressing_n > -1e-6
            assert float(np.linalg.norm(along_n)) <= FRICTION * pressing_n + 1e-6
            if held == STICKS and grips:  # without a grip it may have come down elsewhere
                assert np.abs(slid_mm).max() < 1e-9
            if held == SLIDES:
                assert abs(float(contact.normal @ slid_mm)) < 1e-9
                assert float(np.linalg.norm(along_n)) >= FRICTION * pressing_n - 1e-6
                against_n = -float(along_n @ slid_mm) / float(np.linalg.norm(slid_mm))
                against.append(against_n > float(np.linalg.norm(along_n)) - 1e-6)
            if held == OPEN:
                assert not np.any(force)
    assert len(found) >= 298 and len(against) > 2 * len(found)
    assert np.mean(against) > 0.98  # the others came down elsewhere, or slid in two steps
