"""limb.toml of a diagnosis: the believed file with the finding in it, its comments kept, fit for every
command."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

import pytest
from command_bench import LIMB, Outcome

from brace import toml
from brace.diagnose.diagnosis import Diagnosis, Interval, NamedEffect
from brace.diagnose.export import Exported, export
from brace.model import LimbModel, load_limb
from brace.model.limb import limb_from_document
from brace.toml import Value

HEADER = ["by a test", "of something"]
COMMENTED = """# my limb, bought in May
format = 1
name = "odd # name"   # with a sign in it
[geometry]
coxa_mm = 57.0
femur_mm = 185.0      # measured twice
tibia_mm = 313.5
[link.tibia]          # carbon
bending_mm_per_n = 0.25
axial_mm_per_n = 0.002
# end of tibia
[joint.tibia]
compliance_rad_per_n_mm = 1.6e-5
[change]
link = "tibia"        # which one
"""


def _believed(tmp_path: Path, text: str) -> LimbModel:
    path = tmp_path / "limb.toml"
    path.write_text(text)
    return load_limb(path)


def _exported(tmp_path: Path, text: str, changes: Mapping[str, Value]) -> tuple[LimbModel, Exported]:
    believed = _believed(tmp_path, text)
    found = Diagnosis("effect", "x", believed.with_values(changes))
    return believed, export(found, believed, text, HEADER)


def _reread(text: str) -> LimbModel:
    return limb_from_document(toml.parse(text, Path("limb.toml"), "limb model"))


def test_comments_and_order_are_kept(tmp_path: Path) -> None:
    changes: dict[str, Value] = {
        "joint.tibia.gap_rad": 0.0061,
        "geometry.femur_mm": 185.5,
        "link.tibia.axial_mm_per_n": 0.0021,
        "sensor.bias_x_n": 0.5,
        "change.link": "femur",
        "link.femur.moment_transfer": 1.0,
    }
    _, exported = _exported(tmp_path, COMMENTED, changes)
    lines = exported.text.splitlines()
    assert lines[:3] == ["# by a test", "# of something", "# my limb, bought in May"]
    assert "femur_mm = 185.5      # was 185.0: measured twice" in lines
    assert "axial_mm_per_n = 0.0021  # was 0.002" in lines
    assert (
        'link = "femur"        # was "tibia": which one' in lines
        and 'name = "odd # name"   # with a sign in it' in lines
    )
    assert lines[lines.index("compliance_rad_per_n_mm = 1.6e-5") + 1] == "gap_rad = 0.0061"
    assert lines[-5:] == [
        "[link.femur]",
        "moment_transfer = true",
        "",
        "[sensor]",
        "bias_x_n = 0.5",
    ] or lines[-5:] == ["[sensor]", "bias_x_n = 0.5", "", "[link.femur]", "moment_transfer = true"]
    values = _reread(exported.text).values
    assert values == exported.model.values
    assert {key: values[key] for key in changes} == changes


@pytest.mark.parametrize(
    "text",
    [
        LIMB,
        COMMENTED,
        COMMENTED.replace("\n", "\r\n"),
        LIMB.replace("[geometry]\ncoxa_mm = 57.0\nfemur_mm = 185.0\ntibia_mm = 313.5\n", "").replace(
            'name = "test"',
            'name = "test"\ngeometry = { coxa_mm = 57.0, femur_mm = 185.0, tibia_mm = 313.5 }',
        ),
        LIMB.replace("[geometry]\ncoxa_mm", "geometry.coxa_mm")
        .replace("\nfemur_mm", "\ngeometry.femur_mm")
        .replace("\ntibia_mm", "\ngeometry.tibia_mm"),
        LIMB.replace("[joint.tibia]", '["joint".tibia]'),
    ],
    ids=["plain", "commented", "crlf", "inline", "dotted", "quoted"],
)
def test_whatever_the_style_it_reads_back_the_same(text: str, tmp_path: Path) -> None:
    changes = {"joint.tibia.gap_rad": 1 / 3e2, "geometry.femur_mm": 184.0 + 1e-9, "creep.ratio": 0.2}
    believed, exported = _exported(tmp_path, text, changes)
    values = _reread(exported.text).values
    assert values == exported.model.values
    assert values["joint.tibia.gap_rad"] == 0.00333333333
    untouched = set(values) - set(changes)
    assert {key: values[key] for key in untouched} == {key: believed.values[key] for key in untouched}


def test_what_the_firmware_refuses_is_not_written(tmp_path: Path) -> None:
    for changes in (
        {"joint.tibia.gap_rad": -0.01},
        {"geometry.femur_mm": 1e30},
        {"link.tibia.bending_mm_per_n": -1.0},
    ):
        believed, exported = _exported(tmp_path, LIMB, changes)
        assert _reread(exported.text).values == believed.values
        assert "unchanged" in exported.notes[0] and next(iter(changes)) in exported.notes[0]


def test_nothing_found_nothing_changed(tmp_path: Path) -> None:
    _, exported = _exported(tmp_path, COMMENTED, {})
    assert exported.text.endswith(COMMENTED) and "# nothing was changed" in exported.text


def test_without_a_model_the_fitted_one_is_written(tmp_path: Path) -> None:
    spring = _believed(tmp_path, LIMB).with_values({"joint.femur.gap_rad": 0.1 + 1e-12})
    found = Diagnosis("effect", "x", replace(spring, document=None))
    exported = export(found, None, "", HEADER)
    assert (
        exported.text.startswith("# by a test\n")
        and _reread(exported.text).number("joint.femur.gap_rad") == 0.1
    )


def test_every_command_takes_it(brace: Callable[..., Outcome], tmp_path: Path, paper_rig: Path) -> None:
    _, exported = _exported(tmp_path, LIMB, {"joint.tibia.gap_rad": 0.0061, "creep.ratio": 0.1})
    limb = tmp_path / "out.toml"
    limb.write_text(exported.text)
    assert brace("k", "--model", limb, "--theta1", 1.0, "--theta2", 1.4).code == 0
    assert brace("simulate", "--model", limb, "--rig", paper_rig, "--out", tmp_path / "data").code == 0
    assert brace("predict", tmp_path / "data", "--model", limb, "--out", tmp_path / "p.csv").code == 0
    assert brace("params", "pack", "--model", limb, "--out", tmp_path / "b.bin").code == 0
    told = brace("params", "unpack", tmp_path / "b.bin", "--json")
    assert json.loads(told.out)["parameters"]["joint.tibia.gap_rad"] == pytest.approx(0.0061, rel=1e-6)


def test_the_header_names_effect_place_and_data() -> None:
    from brace.diagnose.provenance import Provenance
    from brace.diagnose.write import _header

    limb = LimbModel({})
    effect = NamedEffect(
        "backlash", "joint.tibia", 0.9, {"joint.tibia.gap_rad": Interval(1.0, 0.5, 2.0)}, 1.0
    )
    origin = Provenance("two\nlines", "loading", 3, "abc", "", {})
    lines = _header(Diagnosis("effect", "x", limb, effects=(effect,)), origin)
    assert "backlash@joint.tibia" in lines[2] and "0.5 to 2 rad" in lines[2] and "two lines" in lines[1]
    assert all("\n" not in line for line in lines)
