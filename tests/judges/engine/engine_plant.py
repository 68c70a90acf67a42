"""A loading test on a limb of the engine: parameters and rows in, readings out, as tests/judges/blind/plant.py has them.

Nothing here knows small displacements, and nothing is the product's. `outside.` parameters are of limbs and rigs that
no key of limb.toml describes."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from engine_chain import Array
from engine_limb import Hinges, engine_limb, equal_segments
from many_rests import Cable, Friction, Held, ManyRests, Rests, Rows
from plant import INDEX, KEYS, READINGS, ROW

# As physics engines have beams. Hinges at Gauss points would be nearer to an elastica, but they are what the product's
# own plant has, and would hide what that leaves out.
BEAM = equal_segments(10)
_JOINTS = ("joint.femur", "joint.tibia")
_COLUMN = {name: i for i, name in enumerate(ROW)}


@dataclass(frozen=True)
class Drives:
    """Torques of both drives in each row (count x 2). `crept_rad` is the delayed part of a deflection."""

    n_mm_per_rad: Array
    crept_rad: Array
    gap_rad: Array
    p: Array

    def rows(self, which: Rows) -> Drives:
        """The same for some of the rows."""
        return Drives(self.n_mm_per_rad[which], self.crept_rad[which], self.gap_rad[which], self.p)

    def torque(self, deflection_rad: Array) -> tuple[Array, Array]:
        """Springs beyond their play, with what else is between torque and deflection."""
        p = self.p
        bent = deflection_rad - self.crept_rad
        centred = bent - 0.5 * self.gap_rad * p[INDEX["outside.gap_offset"]]
        beyond = np.sign(centred) * np.maximum(0.0, np.abs(centred) - 0.5 * self.gap_rad)
        carries = np.abs(centred) > 0.5 * self.gap_rad
        k = np.where(centred > 0.0, self.n_mm_per_rad / (1.0 + p[INDEX["outside.asymmetry"]]), self.n_mm_per_rad)
        harder = np.array([p[INDEX[f"{joint}.hardening_n_mm_per_rad3"]] for joint in _JOINTS])
        torque = k * beyond + harder * beyond**3
        slope = np.where(carries | (self.gap_rad == 0.0), k + 3.0 * harder * beyond**2, 0.0)
        for number, link in enumerate(("femur", "tibia")):
            if (stop := p[INDEX[f"outside.{link}_stop_n_mm_per_rad"]]) > 0.0:
                past = deflection_rad[:, number] - p[INDEX[f"outside.{link}_stop_rad"]]
                torque[:, number] += stop * np.maximum(0.0, past)
                slope[:, number] += stop * (past > 0.0)
        if (ripple := p[INDEX["outside.cogging_n_mm"]]) != 0.0:
            wave = 2.0 * math.pi / p[INDEX["outside.cogging_period_rad"]]
            torque += ripple * np.sin(wave * bent)
            slope += ripple * wave * np.cos(wave * bent)
        return torque, slope


class _LoadingTest:
    """One limb through rows."""

    def __init__(self, p: Array, rows: Array, beam: Hinges) -> None:
        self.p, self.rows = p, rows
        keys = {key: float(p[i]) for key, i in INDEX.items()}
        for link in ("femur", "tibia"):
            keys[f"link.{link}.moment_transfer"] = min(1.0, max(0.0, keys[f"link.{link}.moment_transfer"]))
        cable = None
        if keys["outside.cable_n_per_mm"] > 0.0:
            from_mm = np.array([keys["outside.cable_from_x_mm"], keys["outside.cable_from_z_mm"]])
            cable = Cable(from_mm, keys["outside.cable_mm"], keys["outside.cable_n_per_mm"])
        self.limb = ManyRests(engine_limb(keys, 0.0, 0.0, beam), cable)
        self.changed = np.zeros(self.limb.springs, dtype=bool)
        if self.value("change.bending_factor") != 1.0:
            self.changed = self._bends(keys, "tibia" if self.value("change.link") > 0.5 else "femur", beam)
        offsets = [self.value(f"{joint}.zero_offset_rad") for joint in _JOINTS]
        self.theta = rows[:, [_COLUMN["theta1_rad"], _COLUMN["theta2_rad"]]] + offsets
        self.t_s = rows[:, _COLUMN["t_s"]]
        self.coulomb = np.array([self.value(f"{joint}.coulomb_n_mm") for joint in _JOINTS])

    def value(self, key: str) -> float:
        """A parameter."""
        return float(self.p[INDEX[key]])

    def _bends(self, keys: dict[str, float], link: str, beam: Hinges) -> Array:
        """Which springs are a link's bending: those that a change of it makes softer. The axial springs are not."""
        key = f"link.{link}.bending_mm_per_n"
        softer = engine_limb({**keys, key: 2.0 * keys[key]}, 0.0, 0.0, beam).model
        return np.asarray(np.array(softer.jnt_stiffness) < 0.75 * self.limb.stiffness)

    # --- what the rows ask for -------------------------------------------------------------------------------

    def softer(self, which: Rows) -> Array:
        """What each spring's compliance is multiplied with in some rows."""
        out = np.ones((len(which), self.limb.springs))
        late = self.t_s[which] >= self.value("change.at_s")
        out[np.ix_(late, self.changed)] = self.value("change.bending_factor")
        return out

    def drives(self, which: Rows, crept_rad: Array) -> Drives:
        """The joints in some rows."""
        warm = self.rows[which, _COLUMN["temp_degc"]] - self.value("thermal.reference_degc")
        soft = 1.0 + self.value("thermal.joint_compliance_per_degc") * warm
        k = 1.0 / np.array([self.value(f"{joint}.compliance_rad_per_n_mm") for joint in _JOINTS])
        grown = self.value("outside.gap_growth_rad_per_s") * self.t_s[which]
        gaps = [np.maximum(0.0, self.value(f"{joint}.gap_rad") + grown) for joint in _JOINTS]
        return Drives(k / soft[:, None], crept_rad, np.column_stack(gaps), self.p)

    def zero_mm(self, which: Rows) -> Array:
        """Where the tip is when the record says zero."""
        weight = any(self.value(f"gravity.{part}_n") for part in ("femur", "tibia", "knee"))
        if self.value("outside.held_at_rest") == 0.0 or not (weight or self.value("outside.cable_n_per_mm")):
            return self.limb.tip_mm(self.theta[which])
        first = self.first_of_run(which)
        unique, back = np.unique(first, return_inverse=True)
        none = np.zeros((len(unique), 2))
        hung = self.limb.rest(self.theta[unique], self.drives(unique, none), self.softer(unique),
                              Held(none, none, free=True))  # fmt: skip
        return self.limb.tip_mm(self.theta[unique], hung.q)[back]

    def first_of_run(self, which: Rows) -> Rows:
        """For some rows, the first of the same run: there the rig took hold."""
        _, first, back = np.unique(self.rows[:, 0], return_index=True, return_inverse=True)
        return np.asarray(first[back.ravel()][which], dtype=np.intp)

    def displaced_mm(self) -> Array:
        """By how much the rig moves the tip: as recorded, less the contact's play, along axes that may be turned."""
        asked = self.rows[:, [_COLUMN["dx_mm"], _COLUMN["dz_mm"]]]
        half = 0.5 * self.value("contact.play_mm")
        moved = asked.copy()
        if half > 0.0:
            runs = self.rows[:, 0]
            for row in range(len(asked)):
                was = moved[row - 1] if row and runs[row] == runs[row - 1] else np.zeros(2)
                moved[row] = np.clip(was, asked[row] - half, asked[row] + half)
        return moved @ _turn(self.value("outside.rig_turn_rad")).T

    # --- playing ---------------------------------------------------------------------------------------------

    def played(self) -> tuple[Array, Array]:
        """Deflections of all springs and forces on the tip, row by row."""
        if self.coulomb.any() or self.value("creep.ratio") != 0.0 or self.value("outside.cogging_n_mm") != 0.0:
            return self._in_turn()
        return self._at_once()

    def held(self, place_mm: Array) -> Held:
        """The tip at a place."""
        return Held(place_mm, np.zeros_like(place_mm), rig_mm_per_n=self.value("outside.rig_mm_per_n"))

    def _at_once(self) -> tuple[Array, Array]:
        """Without memory equal rows are played once."""
        moved = self.displaced_mm()
        every = np.arange(len(self.rows))
        state = [self.theta, moved]
        if self.value("thermal.joint_compliance_per_degc") != 0.0:
            state.append(self.rows[:, [_COLUMN["temp_degc"]]])
        if self.value("change.bending_factor") != 1.0:
            state.append((self.t_s >= self.value("change.at_s"))[:, None].astype(float))
        if self.value("outside.gap_growth_rad_per_s") != 0.0:
            state.append(self.t_s[:, None])
        _, first, back = np.unique(np.column_stack(state), axis=0, return_index=True, return_inverse=True)
        once = every[first]
        place = self.zero_mm(once) + moved[once]
        none = np.zeros((len(once), 2))
        found = self.limb.rest(self.theta[once], self.drives(once, none), self.softer(once), self.held(place))
        return found.q[back.ravel()], found.force_n[back.ravel()]

    def _in_turn(self) -> tuple[Array, Array]:
        """With memory: row after row, all runs beside one another, or run after run where friction is carried on."""
        limb, every = self.limb, np.arange(len(self.rows))
        place = self.zero_mm(every) + self.displaced_mm()
        q, force = np.zeros((len(every), limb.springs)), np.zeros((len(every), 2))
        number = np.unique(self.rows[:, 0], return_inverse=True)[1].ravel()
        runs = [np.flatnonzero(number == run) for run in range(number.max() + 1)]
        carried = self.value("outside.friction_carried") > 0.0
        ends = np.zeros((1, 2))
        for group in ([[run] for run in runs] if carried else [runs]):
            before = self._run_starts(group, place, ends if carried else None)
            ends = self._runs(group, place, before, q, force)
            if carried:  # set free, a drive springs back as far as friction lets it
                k = 1.0 / np.array([self.value(f"{joint}.compliance_rad_per_n_mm") for joint in _JOINTS])
                ends = np.clip(ends, -self.coulomb / k, self.coulomb / k)
        return q, force

    def _run_starts(self, group: list[Rows], place: Array, ends: Array | None) -> Array:
        """Deflections that friction holds when runs begin: those of a rest without friction, or what was left."""
        if ends is not None:
            return ends
        first = np.array([run[0] for run in group])
        none = np.zeros((len(first), 2))
        rest = self.limb.rest(self.theta[first], self.drives(first, none), self.softer(first), self.held(place[first]))
        return rest.q[:, self.limb.joints]

    def _runs(self, group: list[Rows], place: Array, before: Array, q: Array, force: Array) -> Array:
        """Plays runs side by side; the joints' deflections at their ends."""
        limb, count = self.limb, len(group)
        crept, elastic, t_before = np.zeros((count, 2)), np.zeros((count, 2)), np.zeros(count)
        ratio, time_s = self.value("creep.ratio"), self.value("creep.time_constant_s")
        state = Rests(np.zeros((count, limb.springs)), np.zeros((count, 2)))
        before = before.copy()
        for step in range(max(len(run) for run in group)):
            going = np.array([i for i, run in enumerate(group) if step < len(run)])
            rows = np.array([group[i][step] for i in going])
            if step:
                grow = 1.0 - np.exp(-(self.t_s[rows] - t_before[going]) / time_s)
                crept[going] += grow[:, None] * (ratio * elastic[going] - crept[going])
            t_before[going] = self.t_s[rows]
            rubs = Friction(before[going], np.tile(self.coulomb, (len(going), 1))) if self.coulomb.any() else None
            found = limb.rest(self.theta[rows], self.drives(rows, crept[going]), self.softer(rows),
                              self.held(place[rows]), Rests(state.q[going], state.force_n[going]), rubs)  # fmt: skip
            state.q[going], state.force_n[going] = found.q, found.force_n
            q[rows], force[rows] = found.q, found.force_n
            before[going] = found.q[:, limb.joints]
            elastic[going] = before[going] - crept[going]
        return before

    def readings(self, q: Array, force: Array) -> Array:
        """What is read of it."""
        out = np.zeros((len(q), len(READINGS)))
        talk = np.array([[1.0, self.value("sensor.crosstalk_xz")], [self.value("sensor.crosstalk_zx"), 1.0]])
        read = self.value("sensor.gain") * (force @ talk.T) @ _turn(self.value("sensor.rotation_rad")).T
        for i, axis in enumerate("xz"):
            zero = self.value(f"sensor.bias_{axis}_n") + self.value(f"sensor.drift_{axis}_n_per_s") * self.t_s
            limit = self.value("sensor.saturation_n")
            out[:, i] = np.clip(read[:, i] + zero, -limit, limit)
            base = f"base.{axis}_mm_per_n"
            if self.value(base) > 0.0:  # the chain begins with the base's slides, x before z
                spring = 1 if axis == "z" and self.value("base.x_mm_per_n") > 0.0 else 0
                out[:, 4 + i] = q[:, spring]
        out[:, 2:4] = q[:, self.limb.joints]
        return out


def _turn(angle_rad: float) -> Array:
    return np.array([[math.cos(angle_rad), -math.sin(angle_rad)], [math.sin(angle_rad), math.cos(angle_rad)]])


def play(p: Array, rows: Array, beam: Hinges = BEAM) -> Array:
    """Readings (columns of READINGS) of a limb for rows (columns of ROW), before noise and rounding."""
    if p.shape != (len(KEYS),) or rows.ndim != 2 or rows.shape[1] != len(ROW):
        raise ValueError(f"parameters {p.shape}, rows {rows.shape}")
    test = _LoadingTest(p, rows, beam)
    return test.readings(*test.played())


def k_under_load(p: Array, theta: Array, force_n: Array, beam: Hinges = BEAM) -> Array:
    """True K (count x 2 x 2) at the rest under forces on the tip: of the drives without friction, creep and change."""
    rows = np.zeros((len(theta), len(ROW)))
    rows[:, 1:3], rows[:, _COLUMN["temp_degc"]] = theta, p[INDEX["thermal.reference_degc"]]
    test = _LoadingTest(p, rows, beam)
    every, none = np.arange(len(rows)), np.zeros((len(rows), 2))
    rest = test.limb.rest(test.theta, test.drives(every, none), np.ones((len(rows), test.limb.springs)),
                          Held(none, np.asarray(force_n, dtype=float), free=True))  # fmt: skip
    return rest.k_n_per_mm
