"""rig.toml: how the simulated rig loads the limb, as strictly checked as a limb model."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from brace import toml
from brace.ground.errors import BadFileError
from brace.model import LimbModel
from brace.toml import Key

WHAT = "rig file"
MAX_ROWS = 5_000_000

RIG_KEYS: tuple[Key, ...] = (
    Key("format", None, "the version of the file's format, 1", "", 1, 1, kind="integer"),
    Key("title", "simulated loading test", "the dataset's title", kind="text"),
    Key("seed", 0, "the seed of the noise: same seed, same bytes", "", 0, 2**63 - 1, kind="integer"),
    Key("rig.step_mm", 0.635, "the step of the imposed displacement", "mm", 0.0, 100.0, open_low=True),
    Key("rig.steps", 4, "the number of steps to each side", "", 1, 10_000, kind="integer"),
    Key("rig.repeats", 2, "how often each run is repeated", "", 1, 1000, kind="integer"),
    Key("rig.axes", ["x", "z"], "the axes that are loaded", kind="list", choices=("x", "z")),
    Key("rig.cyclic", False, "the cyclic test of Fig. 12 (first to the minus side, then over)", kind="flag"),
    Key("rig.shuffled", False, "runs in random order", kind="flag"),
    Key("rig.zeroed", "never", "when the sensor is zeroed", kind="text", choices=("never", "per_run")),
    Key("rig.dwell_s", 4.0, "the wait before each reading", "s", 0.0, 1e6),
    Key("rig.pause_s", 20.0, "the pause between runs", "s", 0.0, 1e6),
    Key("rig.start_s", 0.0, "when the first reading is taken, after those of earlier tests", "s", 0.0, 1e9),
    Key("rig.preload_x_mm", 0.0, "the displacement from which a run starts", "mm", -1e3, 1e3),
    Key("rig.preload_z_mm", 0.0, "the displacement from which a run starts", "mm", -1e3, 1e3),
    Key("sensor.noise_n", 0.0, "one sigma of each force reading", "N", 0.0, 1e6),
    Key("sensor.resolution_n", 0.0625, "the smallest step of a reading", "N", 0.0, 1e6),
    Key("sensor.range_n", 145.0, "where readings are clipped", "N", 0.0, open_low=True, infinite=True),
    Key("sensor.encoders", False, "record output-side joint deflections", kind="flag"),
    Key("sensor.encoder_noise_rad", 0.0, "one sigma of an encoder reading", "rad", 0.0, 1.0),
    Key("sensor.base_gauge", False, "record a dial gauge on the base", kind="flag"),
    Key("sensor.base_noise_mm", 0.0, "one sigma of the gauge", "mm", 0.0, 1e3),
    Key("temperature.start_degc", 22.0, "the temperature at the start", "degC", -273.15, 1e3),
    Key("temperature.rise_degc", 0.0, "how far it rises in the end", "degC", -1e3, 1e3),
    Key("temperature.time_constant_s", 600.0, "how fast", "s", 0.0, open_low=True),
)
_BY_ANGLES = (
    Key("theta1_rad", None, "the commanded femur angle", "rad", -2 * math.pi, 2 * math.pi),
    Key("theta2_rad", None, "the commanded knee angle", "rad", -math.pi, math.pi),
)
_BY_POLAR = (
    Key("r_mm", None, "the tip's distance from the femur axis", "mm", 0.0, 2e4),
    Key("phi_rad", None, "the tip's direction from +x", "rad", -2 * math.pi, 2 * math.pi),
    Key("knee", "up", "which posture reaches it", kind="text", choices=("up", "down")),
)


@dataclass(frozen=True)
class Rig:
    """A checked rig file: its values, and the poses as tables with the line they stand on."""

    values: Mapping[str, toml.Value]
    poses: tuple[Mapping[str, toml.Value], ...]
    document: toml.Document

    def design(self, model: LimbModel) -> dict[str, object]:
        """Fields of brace_rig_design_t. Polar poses are solved on `model` by the firmware's kinematics."""
        angles = np.array([self._angles(index, model) for index in range(len(self.poses))])
        value = self.values
        axes = sum({"x": 1, "z": 2}[axis] for axis in _axes(value))
        return {
            "theta1_rad": angles[:, 0].copy(),
            "theta2_rad": angles[:, 1].copy(),
            "axes": axes,
            "repeats": toml.whole(value, "rig.repeats"),
            "steps_per_side": value["rig.steps"],
            "cyclic": toml.whole(value, "rig.cyclic"),
            "shuffled": toml.whole(value, "rig.shuffled"),
            "zeroed": int(value["rig.zeroed"] == "per_run"),
            "step_mm": value["rig.step_mm"],
            "preload_x_mm": value["rig.preload_x_mm"],
            "preload_z_mm": value["rig.preload_z_mm"],
            "dwell_s": value["rig.dwell_s"],
            "pause_s": value["rig.pause_s"],
            "start_s": value["rig.start_s"],
            "temp_start_degc": value["temperature.start_degc"],
            "temp_rise_degc": value["temperature.rise_degc"],
            "temp_time_constant_s": value["temperature.time_constant_s"],
            "noise_n": value["sensor.noise_n"],
            "resolution_n": value["sensor.resolution_n"],
            "range_n": value["sensor.range_n"],
            "encoder_noise_rad": value["sensor.encoder_noise_rad"],
            "base_noise_mm": value["sensor.base_noise_mm"],
            "seed": value["seed"],
        }

    def _angles(self, index: int, model: LimbModel) -> tuple[float, float]:
        pose = self.poses[index]
        if "theta1_rad" in pose:
            return toml.number(pose, "theta1_rad"), toml.number(pose, "theta2_rad")
        from brace.stiffness.at_rest import PostureError, planar_limb

        try:
            r_mm, phi_rad = toml.number(pose, "r_mm"), toml.number(pose, "phi_rad")
            true1, true2 = planar_limb(model, "general").posture(r_mm, phi_rad, str(pose["knee"]))
        except PostureError as error:
            femur, tibia = model.number("geometry.femur_mm"), model.number("geometry.tibia_mm")
            raise BadFileError(
                f"pose {index + 1} is out of reach: r = {pose['r_mm']:g} mm",
                where=self.document.where(f"configuration.{index}.r_mm"),
                why=error.text,
                next_step=f"{abs(femur - tibia):g} <= r_mm <= {femur + tibia:g}",
            ) from None
        return (
            true1 - model.number("joint.femur.zero_offset_rad"),
            true2 - model.number("joint.tibia.zero_offset_rad"),
        )


def load_rig(path: Path) -> Rig:
    """Reads and checks a rig.toml; refuses with file:line, field, reason and suggestion."""
    document = toml.read(path, WHAT)
    content = dict(document.content)
    poses = content.pop("configuration", None)
    values = toml.check(document, RIG_KEYS, WHAT, content=content)
    if not isinstance(poses, list) or not poses or not all(isinstance(pose, dict) for pose in poses):
        raise BadFileError(
            "no configurations",
            where=document.where("configuration"),
            why="a rig file lists the poses at which the limb is loaded",
            next_step="add [[configuration]] with theta1_rad and theta2_rad, or r_mm and phi_rad",
        )
    checked = tuple(_pose(document, index, pose) for index, pose in enumerate(poses))
    sides = 6 if values["rig.cyclic"] else 4
    repeats, steps = toml.whole(values, "rig.repeats"), toml.whole(values, "rig.steps")
    rows = len(checked) * len(_axes(values)) * repeats * (sides * steps + 1)
    if rows > MAX_ROWS:
        raise BadFileError(
            f"the test would have {rows} rows",
            where=document.where("rig.steps"),
            why=f"at most {MAX_ROWS} are simulated in one go",
            next_step="fewer steps or repeats",
        )
    return Rig(values, checked, document)


def _axes(values: Mapping[str, toml.Value]) -> set[str]:
    axes = values["rig.axes"]
    return {str(axis) for axis in axes} if isinstance(axes, list) else set()


def _pose(document: toml.Document, index: int, pose: Mapping[str, object]) -> Mapping[str, toml.Value]:
    polar = "r_mm" in pose or "phi_rad" in pose
    if polar and ("theta1_rad" in pose or "theta2_rad" in pose):
        raise BadFileError(
            f"pose {index + 1} is given twice",
            where=document.where(f"configuration.{index}"),
            why="angles and polar coordinates may contradict each other",
            next_step="keep one pair",
        )
    return toml.check(
        document, _BY_POLAR if polar else _BY_ANGLES, WHAT, prefix=f"configuration.{index}.", content=pose
    )
