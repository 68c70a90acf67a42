"""Weighted least squares of a set of terms over the fitted readings, from several starts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from brace.diagnose.joint_test.record import JointRecord
from brace.diagnose.joint_test.terms import Term
from brace.identify.parameters import TORQUE_OFFSET, Parameter, ParameterSet
from brace.model import LimbModel

STEP = 1e-4
REFUSED = 1e6
PLENTY = 40  # evaluations of the slope
# relative change of misfit or parameters that ends a fit: of sets to choose from, of sizes
SEARCHING, ESTIMATING = 1e-5, 1e-8


@dataclass(frozen=True)
class Fitted:
    """`off_n_mm` is played less measured at every averaged reading, times the root of its weight; `rss` and
    `held_rss` sum its squares over fitted and held-out readings."""

    terms: tuple[Term, ...]
    parameters: ParameterSet
    x: np.ndarray
    off_n_mm: np.ndarray
    rss: float
    held_rss: float

    @property
    def model(self) -> LimbModel:
        return self.parameters.model(self.x)

    @property
    def nuisances(self) -> dict[str, float]:
        return self.parameters.nuisances(self.x)

    @property
    def values(self) -> dict[str, float]:
        return dict(zip(self.parameters.keys, map(float, self.x)))


class Fitter:
    """Fits over one record from one base model. `trust` is the relative sigma of the base's spring; inf:
    free."""

    def __init__(self, record: JointRecord, base: LimbModel, trust: float) -> None:
        self.record, self.base, self.trust = record, base, trust
        self.root_weight = record.root_weight
        self.tolerance = SEARCHING
        self.known: dict[frozenset[str], Fitted] = {}  # the best fit of every set of terms so far
        self.left: set[tuple[frozenset[str], frozenset[str]]] = (
            set()
        )  # sets that were reached from larger ones

    def by_rows(self) -> Fitter:
        """The same fitter, in which every reading counts alike."""
        other = Fitter(self.record, self.base, self.trust)
        other.root_weight, other.tolerance = np.ones_like(self.root_weight), 0.01 * SEARCHING
        return other

    def over_all(self) -> Fitter:
        """The same fitter, for the readings that were held out, too."""
        other = Fitter(self.record.whole(), self.base, self.trust)
        other.root_weight, other.tolerance = self.root_weight, ESTIMATING
        return other

    def own(self) -> tuple[Parameter, ...]:
        """The spring and the record's zeros, free in every fit."""
        size = self.record.size
        key = f"joint.{self.record.joint}.compliance_rad_per_n_mm"
        start = self.base.number(key) or size.angle_rad / size.torque_n_mm
        scale = size.angle_rad / size.torque_n_mm if np.isinf(self.trust) else self.trust * start
        least, most = 1e-3 * size.angle_rad / size.torque_n_mm, 1.0
        if np.isfinite(self.trust):  # inside the calibration's trust a deviation is no missing effect
            least, most = max((1.0 - 2.0 * self.trust) * start, least), (1.0 + 2.0 * self.trust) * start
        spring = Parameter(key, float(np.clip(start, least, most)), scale, least, most)
        return (
            *([spring] if self.trust > 0.0 else []),
            *self.record.zeros(size.angle_rad),
            *self.record.spreads(),
            Parameter(TORQUE_OFFSET, 0.0, 0.02 * size.torque_n_mm, -size.torque_n_mm, size.torque_n_mm),
        )

    def parameter_set(self, terms: tuple[Term, ...]) -> ParameterSet:
        freed = [parameter for term in terms for parameter in term.parameters]
        keys = {parameter.key for parameter in freed}
        return ParameterSet(self.base, (*(p for p in self.own() if p.key not in keys), *freed))

    def fit(self, terms: tuple[Term, ...], near: Fitted | None = None, added: Term | None = None) -> Fitted:
        """The best fit; starts `near` another fit, with each of the starts of the `added` term."""
        chosen = self.parameter_set(terms)
        known = near.values if near is not None else {}
        points = []
        for start in added.starts if added is not None else ({},):
            values = {parameter.key: parameter.start for parameter in chosen.parameters} | known | dict(start)
            points.append(np.array([values[key] for key in chosen.keys]))
            if added is not None:
                points += self._reshaped(chosen, values, points[-1], added)
        best = min((self._from(chosen, point) for point in points), key=lambda pair: pair[1])
        off = self._offs(chosen, best[0][np.newaxis])[0]
        if (pull := self._pull(chosen, best[0], off)) is not None:
            best = self._from(chosen, best[0], pull)
            off = self._offs(chosen, best[0][np.newaxis])[0]
        record = self.record
        fitted, kept = off[record.fitted], off[record.kept]
        found = Fitted(terms, chosen, best[0], off, float(fitted @ fitted), float(kept @ kept))
        names = frozenset(term.name for term in terms)
        if names not in self.known or found.rss < self.known[names].rss:
            self.known[names] = found
        return found

    def _reshaped(
        self, chosen: ParameterSet, values: Mapping[str, float], point: np.ndarray, added: Term
    ) -> list[np.ndarray]:
        """Gives the start once more with another spring, where the added effect takes way or torque from the spring."""
        if added.shows is None or added.shows.spring_factor is None:
            return []
        spring = f"joint.{self.record.joint}.compliance_rad_per_n_mm"
        point = point.copy()
        if spring in chosen.keys:
            factor = added.shows.spring_factor(added.by_leaf(values), self.record.size)
            point[chosen.keys.index(spring)] *= factor
        return [point]

    def _offs(self, chosen: ParameterSet, points: np.ndarray) -> np.ndarray:
        """Points x averaged readings."""
        off = self.record.offs(chosen.models(points), chosen.nuisance_columns(points)) * self.root_weight
        return np.where(np.isnan(off), REFUSED * self.record.size.torque_n_mm, off)

    def _pull(self, chosen: ParameterSet, x: np.ndarray, off_n_mm: np.ndarray) -> np.ndarray | None:
        """What each parameter weighs by, times its distance from its start over its scale, where one lies further off
        than its prior; None where none does. A prior weighs as much as one independent reading that is off by as many
        sigmas."""
        scale, prior, start = (chosen.array(name) for name in ("scale", "prior_sigma", "start"))
        if np.all(np.abs(x - start) <= prior):
            return None
        left = off_n_mm[self.record.fitted]
        sigma = float(np.linalg.norm(left)) / np.sqrt(self.record.independent(off_n_mm))
        return np.asarray(np.where(np.isinf(prior), 0.0, sigma * scale / prior))

    def _from(
        self, chosen: ParameterSet, point: np.ndarray, pull: np.ndarray | None = None
    ) -> tuple[np.ndarray, float]:
        scale, low, high = (chosen.array(name) for name in ("scale", "low", "high"))
        start = chosen.array("start") / scale
        unit = max(self.record.noise_n_mm, 1e-3 * self.record.size.torque_n_mm)
        fitted = np.flatnonzero(self.record.fitted)

        def whole(points: np.ndarray) -> np.ndarray:
            off = self._offs(chosen, points * scale).take(fitted, axis=1)
            if pull is not None:
                off = np.hstack([off, pull * (points - start)])
            return np.asarray(off / unit)

        def at(u: np.ndarray) -> np.ndarray:
            return np.asarray(whole(u[np.newaxis])[0])

        def slope(u: np.ndarray) -> np.ndarray:
            step = np.where(u + STEP <= high / scale, STEP, -STEP)
            rows = whole(np.vstack([u, u + np.diag(step)]))
            return np.ascontiguousarray(((rows[1:] - rows[0]) / step[:, np.newaxis]).T)

        inside = np.clip(point / scale, low / scale + 1e-9, high / scale - 1e-9)
        found = least_squares(
            at,
            inside,
            jac=slope,
            bounds=(low / scale, high / scale),
            ftol=self.tolerance,
            xtol=self.tolerance,
            gtol=1e-9,
            max_nfev=PLENTY,
        )
        return found.x * scale, float(found.cost)

    def slope_n_mm(self, fitted: Fitted) -> np.ndarray:
        """Readings x parameters: how the weighted torque moves per scale of each parameter."""
        scale, low, high = (fitted.parameters.array(name) for name in ("scale", "low", "high"))
        up, down = np.minimum(fitted.x + 1e-3 * scale, high), np.maximum(fitted.x - 1e-3 * scale, low)
        own = np.eye(fitted.x.size, dtype=bool)
        moved = np.vstack([np.where(own, up, fitted.x), np.where(own, down, fitted.x)])
        above, below = np.split(self._offs(fitted.parameters, moved)[:, self.record.fitted], 2)
        return np.ascontiguousarray(((above - below) / ((up - down) / scale)[:, np.newaxis]).T)
