"""Which seed is for what, and how many cases of each kind."""

from __future__ import annotations

from dataclasses import dataclass

DEVELOPMENT_SEED, TEST_SEED, SUBSET_SEED = 260_017, 774_192, 470_021


@dataclass(frozen=True)
class Plan:
    """How many cases of each kind."""

    joint: int = 0
    evidence: int = 0
    positions: int = 0
    sound: int = 0
    troubled: int = 0
    beside: int = 0  # a trouble and an effect
    ringing: int = 0  # limbs that ring, one effect each
    wandering: int = 0  # sound limbs that ring, a sensor whose zero wanders


DEVELOPMENT = Plan(2, 2, 8, 5, 4, 2, 30, 10)
# Of healthy records with a trouble 300 and of outsiders 170: one wrong name in a hundred can be distinguished from five.
TEST = Plan(25, 20, 60, 60, 30, 10, 150, 100)
SUBSET = Plan(joint=1, evidence=1)
