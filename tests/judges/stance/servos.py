"""What servos' currents say of the loads that a stance's joints bear: friction in the gears after a published fit.

The fits and their numbers are those of tests/judges/currents/servos.c, models M5 and M6 of the MX-106 (M. Duclusaud, G.
Passault, V. Padois, O. Ly, ICRA 2025, arXiv 2410.08650), for joints that stand. A servo holds its angle by its motor's
torque T; while |T - L| is within friction(T, L), the load L changes and T does not. So T hangs on what the joint has
borne before: a random side it has come from, then forces at other places, as the judge of currents has them.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from limbs import Array

FITS = Path(__file__).resolve().parents[1] / "currents" / "servos.c"
# What a user writes, by docs/joints.md; and what it leaves out: the spreads are drawn.
C_N_MM, PER_TORQUE, PER_LOAD, TOLERANCE, CONSTANT_SD = 122.0, 0.40, 0.11, 0.1, 0.03
TORQUE_NOISE_N_MM = 25.0
N_MM_PER_A = 1615.0 * 1.37  # the manual's constant, by the board's torque_ratio
CURRENT_STEP_A, CURRENT_NOISE_A = 3.36e-3, 0.010
PLACES_MOST, EARLIER_N = 3, (1.0, 20.0)
STEPS = 10
N_MM_PER_N_M = 1000.0


def fits() -> list[dict[str, float]]:
    """M5 and M6, in SI units."""
    text = FITS.read_text()
    blocks = re.findall(r"mx106_m\d = \{(.*?)\}", text, re.DOTALL)
    return [{name: float(value) for name, value in re.findall(r"\.(\w+) = ([-\d.e]+)", block)} for block in blocks]


@dataclass(frozen=True)
class Servos:
    """Any number of them; arrays have a row a servo."""

    constant: Array  # N m/A
    factor: Array  # of all friction
    fit: dict[str, Array]

    @staticmethod
    def draw(rng: np.random.Generator, count: int) -> Servos:
        kinds = fits()
        which = rng.integers(len(kinds), size=count)
        fit = {name: np.array([kinds[kind].get(name, 0.0) for kind in which]) for name in kinds[1]}
        constant = fit["kt"] * (1 + CONSTANT_SD * rng.normal(size=count))
        return Servos(constant, rng.uniform(1 - TOLERANCE, 1 + TOLERANCE, count), fit)

    def friction(self, motor: Array, load: Array) -> Array:
        """The most of it [N m] at rest. The load has the sense in which the motor balances it."""
        fit = self.fit
        held = (fit["base"] + fit["base_stribeck"] + np.abs(fit["outside"] * load + fit["motor"] * motor)
                + np.abs(fit["outside_stribeck"] * load + fit["motor_stribeck"] * motor))
        quad = np.where(np.abs(load) < np.abs(motor), fit["outside_quad"] * load**2, fit["motor_quad"] * motor**2)
        most: Array = self.factor * (held + np.where(load * motor > 0, quad, 0))
        return most

    def end(self, load: Array, sense: float) -> Array:
        """The most of the motor's torque that this load lets it have, or the least for the sense -1."""
        inside, beyond = load, load + sense * (20.0 + 20.0 * np.abs(load))
        for _ in range(60):
            middle = (inside + beyond) / 2
            holds = np.abs(middle - load) <= self.friction(middle, load)
            inside, beyond = np.where(holds, middle, inside), np.where(holds, beyond, middle)
        return inside

    def torques(self, rng: np.random.Generator, loads: list[Array]) -> Array:
        """The motors' [N m] where each joint has borne these loads one after the other, after it came without load from
        a random side."""
        nothing = np.zeros(len(self.factor))
        motor = np.where(rng.uniform(size=len(nothing)) < 0.5, self.end(nothing, -1.0), self.end(nothing, 1.0))
        before = nothing
        for load in loads:
            for share in np.linspace(0, 1, STEPS + 1)[1:]:
                now = before + share * (load - before)
                motor = np.clip(motor, self.end(now, -1.0), self.end(now, 1.0))
            before = load
        return motor

    def read_n_mm(self, rng: np.random.Generator, motor: Array) -> Array:
        """What the currents say of the motors' torques, by the constant that a user writes."""
        current = motor / self.constant + CURRENT_NOISE_A * rng.normal(size=len(motor))
        read: Array = np.round(current / CURRENT_STEP_A) * CURRENT_STEP_A * N_MM_PER_A
        return read


def read(rng: np.random.Generator, levers: Array, loads_n_mm: Array) -> Array:
    """(n, 3) [N mm]: torques of motors by their currents, where joints bear loads (n, 3) in the sense of their angles;
    levers (n, 3, 3): of the tips by the joints, in any frame."""
    servos = Servos.draw(rng, loads_n_mm.size)
    before = []
    for _ in range(int(rng.integers(PLACES_MOST + 1))):
        way = rng.normal(size=(len(levers), 3))
        force = rng.uniform(*EARLIER_N, (len(levers), 1)) * way / np.linalg.norm(way, axis=1, keepdims=True)
        before.append(np.einsum("nic,nc->ni", levers, force).ravel() / N_MM_PER_N_M)
    motor = servos.torques(rng, [*before, loads_n_mm.ravel() / N_MM_PER_N_M])
    return servos.read_n_mm(rng, motor).reshape(loads_n_mm.shape)


def toml(joint: str) -> list[str]:
    """Lines of limb.toml, by docs/joints.md."""
    return [f"[motor.{joint}]", f"friction_n_mm = {C_N_MM}", f"friction_per_torque_ratio = {PER_TORQUE}",
            f"friction_per_load_ratio = {PER_LOAD}", f"friction_tolerance_ratio = {TOLERANCE}",
            f"torque_gain_rel = {CONSTANT_SD}", f"torque_noise_n_mm = {TORQUE_NOISE_N_MM}"]
