"""The limits the project has set itself, each checked against what this run measured."""

from collections.abc import Callable
from dataclasses import dataclass

from measure import Measured
from throughput import Rate
from versions import COLLAPSE, PLANAR, PLANAR_NO_FPU, SPATIAL
from weights import FIXED_RAM, PLANAR_RAM, SPATIAL_RAM


@dataclass(frozen=True)
class Check:
    """One limit."""

    name: str
    measured: str
    required: str
    passed: bool

    @property
    def verdict(self) -> str:
        """PASS or MISS."""
        return "PASS" if self.passed else "MISS"


def at_most(name: str, value: float, limit: float, unit: str = "",
            text: Callable[[float], str] = "{:,.0f}".format) -> Check:
    return Check(name, text(value) + unit, f"at most {text(limit)}{unit}", value <= limit)


def at_least(name: str, value: float, limit: float, unit: str = "") -> Check:
    return Check(name, f"{value:.2f}{unit}", f"at least {limit:g}{unit}", value >= limit)


def _error_text(value: float) -> str:
    return f"{value:.1e}"


class Limits:
    """Looks versions up by group and name."""

    def __init__(self, measured: list[Measured], rates: list[Rate], weights: dict[str, int],
                 map_s: float) -> None:
        self.measured, self.rates, self.weights, self.map_s = measured, rates, weights, map_s

    def _ours(self, group: str, name: str = "") -> list[Measured]:
        return [m for m in self.measured if m.version.group == group and m.version.ours and name in m.version.name]

    def _peers(self, group: str) -> list[Measured]:
        return [m for m in self.measured if m.version.group == group and not m.version.ours]

    def _planar(self) -> list[Check]:
        ticks = self._ours(PLANAR)
        most = max(m.maximum for m in ticks)
        best = min(self._peers(PLANAR), key=lambda m: m.median)
        return [
            at_most("planar K, instructions at every posture", most, 170),
            at_least(f"planar K, times fewer instructions than the best peer ({best.version.name}, median)",
                      best.median / most, 2.7),
        ]

    def _others(self) -> list[Check]:
        fixed = max(m.maximum for m in self._ours(PLANAR_NO_FPU))
        soft = min(m.median for m in self._peers(PLANAR_NO_FPU))
        spatial = max(m.maximum for m in self._ours(SPATIAL))
        collapse = self._ours(COLLAPSE)
        refused = sum(m.refused for m in collapse)
        return [
            at_most("fixed point on Cortex-M3, instructions at every posture", fixed, 260),
            at_least("fixed point, times fewer instructions than soft float (best median)", soft / fixed, 35),
            at_most("spatial K, instructions, worst posture and limb", spatial, 500),
            at_most(f"parameter change, instructions, worst limb ({refused} left to the general path)",
                     max(m.maximum for m in collapse), 3000),
        ]

    def _paths(self) -> list[Check]:
        checks = []
        for m in [*self._ours(PLANAR), *self._ours(PLANAR_NO_FPU)]:
            ratio = m.maximum_anywhere / m.minimum_anywhere
            checks.append(Check(f"{m.version.group}, {m.version.name}: worst over best, whole workspace",
                                f"{ratio:.2f}, {'one path' if m.one_path else 'paths differ'}", "1.00, one path",
                                ratio == 1.0 and m.one_path))
        return checks

    def _accuracy(self) -> list[Check]:
        ticks, no_fpu, spatial = self._ours(PLANAR), self._ours(PLANAR_NO_FPU), self._ours(SPATIAL)
        rows = (("planar K", ticks, 1e-6, 2e-6), ("fixed point", no_fpu, 2e-6, 5e-6),
                ("spatial K", spatial, 1e-5, 1e-5))
        checks = []
        for name, measured, k_limit, lambda_limit in rows:
            errors = [e for m in measured for e in (m.error, m.workspace_error) if e]
            least = [max(e.eigenvalues) if measured is spatial else e.eigenvalues[0] for e in errors]
            which = "eigenvalues" if measured is spatial else "lambda_min"
            checks.append(at_most(f"{name}: error over lambda_max, whole workspace", max(e.k for e in errors), k_limit,
                                   text=_error_text))
            checks.append(at_most(f"{name}: relative error of {which}, whole workspace", max(least), lambda_limit,
                                   text=_error_text))
        return checks

    def _weight(self) -> list[Check]:
        return [at_most(name, self.weights[name], 512, " B") for name in (PLANAR_RAM, FIXED_RAM, SPATIAL_RAM)]

    def _host(self) -> list[Check]:
        eigen = next(r for r in self.rates if r.name.startswith("Eigen"))
        batch = next(r for r in self.rates if r.name == "Brace, batch")
        return [at_least("host batches, times Eigen's throughput", batch.postures_per_s / eigen.postures_per_s, 40),
                at_most("host batches: error of K over lambda_max", batch.error.k, 2e-6, text=_error_text),
                at_most("brace map over a million postures, processor time", self.map_s, 2.0, " s", "{:.2f}".format)]

    def checks(self) -> list[Check]:
        """All limits, in the order a reader wants them."""
        return [*self._planar(), *self._others(), *self._host(), *self._paths(), *self._accuracy(), *self._weight()]
