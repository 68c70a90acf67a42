"""Detectability and classes in the engine's world: as tests/blind/detect.py, with one set of the base's derivatives for
all fits. They change little over what calibration leaves open, and fits go on until the misfit itself says so."""

from __future__ import annotations

from designs import Design, Loose, Trust
from detect import Bench
from engine_plant import play
from many_rests import NoRest
from plant import INDEX, Array

FEMUR_BEAM, TIBIA_BEAM = "link.femur.moment_transfer", "link.tibia.moment_transfer"


class EngineBench(Bench):
    """One design and one believed limb of the engine."""

    hasty = True

    def __init__(self, design: Design, believed: Array, given: Trust) -> None:
        super().__init__(design, believed, given, play)
        for key in (FEMUR_BEAM, TIBIA_BEAM):
            if believed[INDEX[key]] > 0.5:
                self.scales[key] = -0.05
        self._columns: dict[int, Array] = {}
        self._here = self.record(believed)

    def record(self, p: Array) -> Array:
        """As of a limb; of one that finds no rest, far from everything."""
        try:
            return super().record(p)
        except NoRest:
            return self.in_sigmas(self.clean) + 1e6

    def column(self, loose: Loose, p: Array, here: Array) -> Array:
        """As Bench has it, of the believed limb where that is what the base moves."""
        if loose not in self.base:
            return super().column(loose, p, here)
        if loose.index not in self._columns:
            self._columns[loose.index] = super().column(loose, self.believed, self._here)
        return self._columns[loose.index]
