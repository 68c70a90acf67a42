"""limb.toml: what is read comes back, what cannot be is refused with its line, its reason and a way on."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from brace.ground.errors import BadFileError
from brace.model import LIMB_KEYS, load_limb
from command_bench import LIMB, Outcome


def test_written_model_reads_back_bit_for_bit(tmp_path: Path) -> None:
    random = np.random.default_rng(1)
    model = load_limb(_file(tmp_path, LIMB))
    changes: dict[str, float | str] = {}
    for key in LIMB_KEYS:
        if key.kind == "number":
            low, high = max(key.low, -1e3), min(key.high, 1e3)
            changes[key.name] = float(random.uniform(low, high)) or high
        elif key.kind == "ratio":
            changes[key.name] = float(random.choice([0.0, 1.0, 0.37]))
    changes |= {"name": 'quote " slash \\ tab\t \N{GREEK SMALL LETTER LAMDA}', "change.link": "femur"}
    changed = model.with_values(changes)
    again = load_limb(_file(tmp_path, changed.to_toml(["made by a test"])))
    assert again.values == changed.values


def test_missing_tables_mean_no_effect(tmp_path: Path) -> None:
    model = load_limb(_file(tmp_path, LIMB))
    assert model.number("sensor.gain") == 1.0
    assert model.number("joint.femur.gap_rad") == 0.0
    assert model.number("sensor.saturation_n") == np.inf
    assert model.values["change.link"] == "tibia"


def test_moment_transfer_is_a_switch_or_a_strength(tmp_path: Path) -> None:
    for text, value in (("true", 1.0), ("false", 0.0), ("0.25", 0.25), ("1", 1.0)):
        model = load_limb(
            _file(tmp_path, LIMB.replace("[link.tibia]", f"moment_transfer = {text}\n[link.tibia]"))
        )
        assert model.number("link.femur.moment_transfer") == value


HOSTILE = {  # what is done to the file -> line, and words that the message must hold
    "negative compliance": (
        ("bending_mm_per_n = 0.06", "bending_mm_per_n = -0.06"),
        9,
        ["link.femur.bending_mm_per_n", "negative", "mm/N"],
    ),
    "not a number": (("femur_mm = 185.0", "femur_mm = nan"), 5, ["geometry.femur_mm", "not a number"]),
    "infinite": (("femur_mm = 185.0", "femur_mm = inf"), 5, ["finite"]),
    "too long": (("femur_mm = 185.0", "femur_mm = 1e9"), 5, ["too large", "mm"]),
    "huge integer": (("femur_mm = 185.0", "femur_mm = 1" + "0" * 400), 5, ["too large"]),
    "text for a number": (("femur_mm = 185.0", 'femur_mm = "185"'), 5, ["must be a number", "text"]),
    "true for a number": (("femur_mm = 185.0", "femur_mm = true"), 5, ["must be a number"]),
    "list for a number": (("femur_mm = 185.0", "femur_mm = [185.0]"), 5, ["a list"]),
    "misspelt key": (
        ("bending_mm_per_n = 0.06", "bendig_mm_per_n = 0.06"),
        9,
        ["unknown key", "did you mean link.femur.bending_mm_per_n"],
    ),
    "typographic minus": (("femur_mm = 185.0", "femur_mm = \u2212185.0"), 5, ["femur_mm = -185.0", "U+2212"]),
    "decimal comma": (("femur_mm = 185.0", "femur_mm = 185,5  # measured"), 5, ["femur_mm = 185.5"]),
    "a unit behind the number": (("femur_mm = 185.0", "femur_mm = 185 mm"), 5, ["femur_mm = 185: the unit"]),
    "a table of another name": (
        ("[link.tibia]", "[link.shank]"),
        10,
        ["known tables: link.coxa, link.femur, link.tibia"],
    ),
    "misspelt table": (("[link.tibia]", "[link.tibea]"), 10, ["unknown table", "did you mean [link.tibia]"]),
    "unit in another suffix": (("femur_mm = 185.0", "femur_m = 0.185"), 5, ["femur_mm"]),
    "duplicate key": (("femur_mm = 185.0", "femur_mm = 185.0\nfemur_mm = 186.0"), 6, ["twice", "keep one"]),
    "duplicate table": (("[uncertainty]", "[geometry]\n[uncertainty]"), 17, ["twice"]),
    "syntax": (("femur_mm = 185.0", "femur_mm = = 185.0"), 5, ["not valid TOML"]),
    "missing length": (("femur_mm = 185.0\n", ""), 3, ["geometry.femur_mm is missing"]),
    "another format": (("format = 1", "format = 2"), 1, ["write 1"]),
    "value where a table is": (
        ("[geometry]\ncoxa_mm = 57.0\nfemur_mm = 185.0\ntibia_mm = 313.5", "geometry = 3"),
        3,
        ["geometry", "table"],
    ),
    "moment transfer above one": (
        ("[link.tibia]", "moment_transfer = 1.5\n[link.tibia]"),
        10,
        ["true/false"],
    ),
    "choice": (("[uncertainty]", '[change]\nlink = "knee"\n[uncertainty]'), 18, ['"femur"']),
}


@pytest.mark.parametrize("case", HOSTILE)
def test_hostile_models_are_refused_with_line_and_way_on(
    case: str, tmp_path: Path, brace: Callable[..., Outcome]
) -> None:
    (before, after), line, words = HOSTILE[case]
    assert before in LIMB
    path = _file(tmp_path, LIMB.replace(before, after))
    outcome = brace("k", "--model", path, "--theta1", 1, "--theta2", 1)
    assert outcome.code == 3
    assert outcome.out == ""
    assert f"{path}:{line}:" in outcome.err
    assert "why:" in outcome.err and "try:" in outcome.err
    for word in words:
        assert word in outcome.err


def test_a_limb_in_which_nothing_yields_is_refused(tmp_path: Path) -> None:
    text = LIMB
    for value in ("0.001", "0.002", "0.06", "0.25", "1.0e-5", "1.6e-5"):
        text = text.replace(f"= {value}\n", "= 0.0\n")
    with pytest.raises(BadFileError, match="nothing in this limb yields"):
        load_limb(_file(tmp_path, text))


@pytest.mark.parametrize(
    "content",
    [
        b"\x7fELF\x00\x01\x02",
        b"\xff\xfe\x00",
        b"",
        b"\x00" * 100,
        b"a = " + b"[" * 5000 + b"]" * 5000,
        b"format = 1\n" * 10,
    ],
)
def test_garbage_is_refused(content: bytes, tmp_path: Path, brace: Callable[..., Outcome]) -> None:
    path = tmp_path / "limb.toml"
    path.write_bytes(content)
    outcome = brace("k", "--model", path, "--theta1", 1, "--theta2", 1)
    assert outcome.code == 3 and "limb.toml" in outcome.err and "try:" in outcome.err


def test_files_that_are_none(tmp_path: Path, brace: Callable[..., Outcome]) -> None:
    _file(tmp_path, LIMB)
    for path, word in (
        (tmp_path, "folder"),
        (tmp_path / "limp.toml", "did you mean"),
        (Path("/dev/zero"), "regular"),
        (tmp_path / ("x" * 400), "cannot be opened"),
        (tmp_path / "no" / "limb.toml", "does not exist"),
    ):
        outcome = brace("k", "--model", path, "--theta1", 1, "--theta2", 1)
        assert outcome.code == 3 and word in outcome.err


def test_an_endless_file_is_not_read(tmp_path: Path, brace: Callable[..., Outcome]) -> None:
    path = tmp_path / "limb.toml"
    with path.open("wb") as file:
        file.truncate(1 << 33)
    outcome = brace("k", "--model", path, "--theta1", 1, "--theta2", 1)
    assert outcome.code == 3 and "too large" in outcome.err


def test_mutated_files_never_break_the_reader(tmp_path: Path) -> None:
    random = np.random.default_rng(7)
    whole = LIMB.encode()
    refused = 0
    for _ in range(400):
        data = bytearray(whole)
        for _ in range(int(random.integers(1, 6))):
            place = int(random.integers(len(data)))
            match random.integers(3):
                case 0:
                    data[place] = int(random.integers(256))
                case 1:
                    del data[place : place + int(random.integers(1, 30))]
                case _:
                    data[place:place] = bytes(random.integers(0, 256, 3, dtype=np.uint8))
            if not data:
                break
        path = tmp_path / "limb.toml"
        path.write_bytes(bytes(data))
        try:
            load_limb(path)
        except BadFileError as error:
            refused += 1
            assert str(path) in error.where and error.why and error.next_step
    assert refused > 200


def _file(folder: Path, text: str) -> Path:
    path = folder / "limb.toml"
    path.write_text(text)
    return path
