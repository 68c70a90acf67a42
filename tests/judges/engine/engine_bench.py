"""Detectability and classes in the engine's world: as tests/judges/blind/detect.py, with the base's derivatives kept for limbs
near the one where they were taken. They change little over what calibration leaves open."""

from __future__ import annotations

from designs import Design, Loose, Trust
from detect import Bench
from engine_plant import play
from many_rests import NoRest
from plant import INDEX, Array

NEAR_SIGMAS = 4.0
FEMUR_BEAM, TIBIA_BEAM = "link.femur.moment_transfer", "link.tibia.moment_transfer"


class EngineBench(Bench):
    """One design and one believed limb of the engine."""

    hasty = True

    def __init__(self, design: Design, believed: Array, given: Trust) -> None:
        super().__init__(design, believed, given, play)
        for key in (FEMUR_BEAM, TIBIA_BEAM):
            if believed[INDEX[key]] > 0.5:
                self.scales[key] = -0.05
        self._kept: list[tuple[Array, dict[int, Array]]] = [(believed, {})]  # of the believed limb, and of the latest

    def record(self, p: Array) -> Array:
        """As of a limb; of one that finds no rest, far from everything."""
        try:
            return super().record(p)
        except NoRest:
            return self.in_sigmas(self.clean) + 1e6

    def column(self, loose: Loose, p: Array, here: Array) -> Array:
        """As Bench has it; of what the base moves, of a limb nearby."""
        if loose not in self.base:
            return super().column(loose, p, here)
        columns = next((kept for at, kept in self._kept if self._near(p, at)), None)
        if columns is None:
            columns = {}
            self._kept = [self._kept[0], (p.copy(), columns)]
        if loose.index not in columns:
            columns[loose.index] = super().column(loose, p, here)
        return columns[loose.index]

    def _near(self, p: Array, at: Array) -> bool:
        """Within a few sigmas in all that the base moves."""
        return all(abs(loose.away(p, at)) < NEAR_SIGMAS for loose in self.base)
