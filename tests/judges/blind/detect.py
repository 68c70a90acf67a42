"""How detectable a hidden effect is, and which others leave the same trace: s and classes, without noise.

s^2 is what is left of the true record after refitting the base under its priors: chi-squared of the readings
plus that of the priors, which is twice the gain in log-likelihood that the truth brings. Another effect is of
the truth's class when it explains all but 1 - 0.95^2 of s^2 (for an effect linear in its parameters: the cosine
of the principal angle between the traces, after projecting out the base, is above 0.95)."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from designs import Design, Loose, Play, Trust, base_parameters
from effects import Candidate, Hidden, candidates, scales
from plant import INDEX, Array, play

SAME_CLASS = 0.95


class Bench:
    """One design and one believed limb: records, fits, traces."""

    hasty = False  # whether a fit ends where the next step promises little, or where it has gained little

    def __init__(self, design: Design, believed: Array, given: Trust, by: Play = play) -> None:
        self.design, self.believed, self.play = design, believed, by
        self.base = base_parameters(believed, given)
        self.clean = by(believed, design.rows)
        self.sigma = design.sigma(self.clean)
        self.peak_n = float(np.max(np.abs(self.clean[:, :2])))
        self.whole_s = float(design.rows[-1, 3])
        self.scales = scales(believed, self.whole_s)
        th1, th2 = design.rows[:, 1], design.rows[:, 1] - design.rows[:, 2]
        wx, wz = (believed[INDEX["geometry.tibia_mm"]] * f(th2) for f in (np.cos, np.sin))
        ax, az = (believed[INDEX["geometry.femur_mm"]] * f(th1) for f in (np.cos, np.sin))
        fx, fz = self.clean[:, 0], self.clean[:, 1]
        self.deepest = {
            "femur_rad": float(np.max(np.abs(self.clean[:, 2]))),
            "tibia_rad": float(np.max(np.abs(self.clean[:, 3]))),
            "femur_n_mm": float(np.max(np.abs(-(az + wz) * fx + (ax + wx) * fz))),
            "tibia_n_mm": float(np.max(np.abs(-wz * fx + wx * fz))),
        }

    def record(self, p: Array) -> Array:
        """Readings of a limb, in standard deviations, as one vector."""
        return self.in_sigmas(self.play(p, self.design.rows))

    def in_sigmas(self, readings: Array) -> Array:
        """Readings (all columns of the plant) as such a vector."""
        out: Array = (self.design.seen(readings[:, self.design.columns]) / self.sigma).ravel()
        return out

    def column(self, loose: Loose, p: Array, here: Array) -> Array:
        """How a limb's record moves with a parameter, a sigma of it."""
        moved = p.copy()
        loose.moved(moved, 0.05)
        out: Array = (self.record(moved) - here) / 0.05
        return out

    def fit(
        self, target: Array, start: Array, extra: Sequence[str] = (), rounds: int = 12, until: float = 1e-4
    ) -> tuple[float, Array, Array]:
        """Least squares of base (under its priors) and of the `extra` parameters (free, also where the base
        has them under a prior): chi-squared, the limb, and the residual with the priors' beneath it."""
        steps = [loose for loose in self.base if _not_in(loose.index, extra)]
        steps += [Loose(INDEX[key], self.scales[key], False) for key in extra]
        bound = len(steps) - len(extra)
        p = start.copy()

        def residual(limb: Array) -> Array:
            prior = [-loose.away(limb, self.believed) for loose in steps[:bound]]
            return np.concatenate([target - self.record(limb), prior])

        r = residual(p)
        chi2, damping = float(r @ r), 1e-6
        for _ in range(rounds):
            jacobian = np.zeros((len(r), len(steps)))
            here = target - r[: len(target)]
            for k, loose in enumerate(steps):
                jacobian[: len(target), k] = self.column(loose, p, here)
                if k < bound:
                    jacobian[len(target) + k, k] = 1.0
            normal, gradient = jacobian.T @ jacobian, jacobian.T @ r
            better = False
            for _ in range(8):
                weight = np.diag(normal) + 1e-12 * float(np.max(np.diag(normal))) + 1e-300
                move = np.linalg.solve(normal + np.diag(damping * weight), gradient)
                if self.hasty and float(move @ gradient) < until * (1.0 + chi2):
                    break
                tried = p.copy()
                for loose, sigmas in zip(steps, move, strict=True):
                    loose.moved(tried, float(np.clip(sigmas, -100.0, 100.0)) if loose.relative else float(sigmas))
                if _possible(tried):
                    fresh = residual(tried)
                    value = float(fresh @ fresh)
                    if value < chi2:
                        better = True
                        break
                damping = max(10.0 * damping, 1e-4)
            if not better:
                break
            gained, chi2, p, r = chi2 - value, value, tried, fresh
            damping = max(0.1 * damping, 1e-9)
            if gained < until * (1.0 + chi2):
                break
        return chi2, p, r

    def s_of(self, truth: Array) -> float:
        """Detectability of what makes `truth` differ from the believed limb."""
        return math.sqrt(max(0.0, self.fit(self.record(truth), self.believed)[0]))

    def s_of_record(self, target: Array) -> float:
        """The same of a record (in standard deviations)."""
        return math.sqrt(max(0.0, self.fit(target, self.believed)[0]))

    def sized(self, hidden: Hidden, wanted: float, s_at: Callable[[float], float] | None = None) -> tuple[float, float]:
        """Size at which the effect is as detectable as wanted, or its largest; and the s reached."""
        find = s_at or (lambda size: self.s_of(hidden.applied(self.believed, size)))
        high = hidden.largest
        s_high = find(high)
        if s_high <= wanted:
            return high, s_high
        low = hidden.smallest
        guess = low
        size, s = high, s_high
        for _ in range(40):
            # s is nearly proportional to size: aim there; halve (in logarithms) when that leaves the bracket
            guess = size * (wanted / s) if s > 0.0 else math.sqrt(low * high)
            if not low < guess < high:
                guess = math.sqrt(low * high)
            size = guess
            s = find(size)
            if abs(s - wanted) < 0.01 * wanted:
                break
            if s < wanted:
                low = size
            else:
                high = size
            if high / low < 1.0 + 1e-6:
                break
        return size, s

    # --- classes -----------------------------------------------------------------------------------------

    def cosines(
        self, target: Array, own: tuple[Candidate, Array] | None = None, above: float = 0.7
    ) -> dict[str, float]:
        """For each effect of the catalogue, how much of the record's trace it explains: the cosine."""
        chi2, at, r = self.fit(target, self.believed)
        out: dict[str, float] = {}
        if chi2 <= 0.0:
            return out
        projector = self._projector(at, len(r))
        trace = r / math.sqrt(chi2)
        here = self.record(at)
        size = len(here)
        row_of = {loose.index: size + k for k, loose in enumerate(self.base)}
        for candidate in candidates(self.believed, self.design.rows, self.peak_n, self.deepest):
            best = 0.0
            best_start: tuple[tuple[str, float], ...] = ()
            for start in candidate.starts:
                p = at.copy()
                for key, value in start:
                    p[INDEX[key]] = value
                columns: list[Array] = []
                free: list[int] = []
                set_here = {key for key, _ in start} & set(candidate.keys)
                for key in candidate.keys:
                    moved = p.copy()
                    if INDEX[key] in row_of:
                        # In the base already: what the effect adds is freedom from the prior.
                        free.append(row_of[INDEX[key]])
                    elif key in set_here and key != "creep.time_constant_s":
                        columns.append(self.record(moved) - here)
                    elif key == "creep.time_constant_s":
                        continue
                    else:
                        moved[INDEX[key]] += self.scales[key]
                        columns.append(self.record(moved) - here)
                block = np.zeros((len(r), len(columns) + len(free)))
                if columns:
                    block[:size, : len(columns)] = np.array(columns).T
                for k, row in enumerate(free):
                    block[row, len(columns) + k] = 1.0
                block -= projector @ (projector.T @ block)
                norms = np.linalg.norm(block, axis=0)
                block = block[:, norms > 1e-9] / norms[norms > 1e-9]
                if block.size == 0:
                    continue
                u, w, _ = np.linalg.svd(block, full_matrices=False)
                cosine = float(np.linalg.norm(u[:, w > 1e-6].T @ trace))
                if cosine > best:
                    best, best_start = cosine, start
            if best > above:  # near enough to matter: fit it, since its trace may bend with its size
                p = at.copy()
                for key, value in best_start:
                    p[INDEX[key]] = value
                if candidate.name == "creep":
                    p[INDEX["creep.ratio"]] += 1e-3
                left = min(self.fit(target, p, candidate.keys, rounds=25)[0], chi2)
                best = math.sqrt(1.0 - left / chi2) if left < chi2 else 0.0
            out[candidate.label] = best
        return out

    def _projector(self, at: Array, length: int) -> Array:
        """Orthonormal basis of what the base can do around a limb, priors beneath."""
        here = self.record(at)
        block = np.zeros((length, len(self.base)))
        for k, loose in enumerate(self.base):
            block[: len(here), k] = self.column(loose, at, here)
            block[len(here) + k, k] = 1.0
        return np.linalg.qr(block)[0]


def _not_in(index: int, keys: Sequence[str]) -> bool:
    return all(INDEX[key] != index for key in keys)


_POSITIVE = [
    INDEX[key]
    for key in (
        "geometry.femur_mm",
        "geometry.tibia_mm",
        "link.femur.axial_mm_per_n",
        "link.femur.bending_mm_per_n",
        "link.tibia.axial_mm_per_n",
        "link.tibia.bending_mm_per_n",
        "joint.femur.compliance_rad_per_n_mm",
        "joint.tibia.compliance_rad_per_n_mm",
        "sensor.gain",
        "sensor.saturation_n",
        "creep.time_constant_s",
        "change.bending_factor",
    )
]


_NEVER_NEGATIVE = [
    INDEX[key]
    for key in (
        "joint.femur.gap_rad",
        "joint.tibia.gap_rad",
        "joint.femur.coulomb_n_mm",
        "joint.tibia.coulomb_n_mm",
        "contact.play_mm",
    )
]


def _possible(p: Array) -> bool:
    """A limb that can be played."""
    return bool(
        np.all(np.isfinite(p[_POSITIVE[:9]]))
        and np.all(p[_POSITIVE] > 0.0)
        and np.all(p[_NEVER_NEGATIVE] >= 0.0)
        and p[INDEX["geometry.femur_mm"]] > 20.0
        and p[INDEX["geometry.tibia_mm"]] > 20.0
    )
