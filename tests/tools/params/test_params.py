"""`brace params`: packed, unpacked, packed again gives the same bytes; what cannot be is refused with a way on."""

from __future__ import annotations

import json
import struct
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from brace.model import LIMB_KEYS, load_limb
from brace.wire.names import OF_THE_MODEL, PARAMETERS, SCHEMA_HASH
from command_bench import LIMB

Brace = Callable[..., Any]


def _file(folder: Path, text: str, name: str = "limb.toml") -> Path:
    path = folder / name
    path.write_text(text)
    return path


def _block(values: dict[str, float | int], sequence: int = 3, schema: int = SCHEMA_HASH) -> bytes:
    """A block put together from its documented layout: shares no code with the firmware."""
    members = b""
    for parameter in PARAMETERS:
        value = values.get(parameter.key, parameter.safe)
        members += struct.pack("<f" if parameter.type == "f32" else "<I", value)
    body = b"BRCE" + struct.pack("<HHIII", 1, 20, schema, len(members), sequence) + members
    return body + struct.pack("<I", zlib.crc32(body))


def test_a_block_is_what_its_layout_says(tmp_path: Path, brace: Brace) -> None:
    limb = _file(tmp_path, LIMB)
    outcome = brace("params", "pack", "--model", limb, "--out", tmp_path / "b.bin", "--sequence", 3)
    assert outcome.code == 0, outcome.err
    model = load_limb(limb)
    values: dict[str, float | int] = {p.key: model.number(p.key) for p in PARAMETERS if p.type == "f32"}
    for p in (p for p in PARAMETERS if p.type == "u32"):
        values[p.key] = p.texts.index(str(model.values[p.key])) if p.texts else int(model.number(p.key))
    assert (tmp_path / "b.bin").read_bytes() == _block(values)


def test_the_round_trip_is_byte_identical(tmp_path: Path, brace: Brace) -> None:
    random = np.random.default_rng(4)
    for trial in range(12):
        changes: dict[str, Any] = {}
        for key in LIMB_KEYS:
            if key.name in ("format", "name", *(p.key for p in OF_THE_MODEL)) or random.random() < 0.3:
                continue
            if key.choices:
                changes[key.name] = str(random.choice(key.choices))
            elif key.kind == "integer":
                changes[key.name] = int(random.choice(key.numbers)) if key.numbers else int(key.high)
            else:  # a bound, or anywhere between
                low, high = max(key.low, -1e6), min(key.high, 1e6)
                ends = [high] if key.open_low else [low, high]
                changes[key.name] = float(random.choice([*ends, random.uniform(low, high)]))
        for joint in ("coxa", "femur", "tibia"):  # what these say together
            changes[f"motor.{joint}.angle_min_rad"], changes[f"motor.{joint}.angle_max_rad"] = -1.1, 2.3
            changes[f"motor.{joint}.torque_range_n_mm"] = 1e6
        changes["geometry.coxa_mm"] = 57.0
        changes["controller.age_limit_us"] = 10_000_000
        changes["link.tibia.axial_mm_per_n"] = changes["link.femur.axial_mm_per_n"] = 0.002
        changes["link.femur.bending_mm_per_n"] = 0.1
        start = load_limb(_file(tmp_path, LIMB)).with_values(changes)
        first = _file(tmp_path, start.to_toml(), f"{trial}.toml")
        blocks = [tmp_path / f"{trial}-{i}.bin" for i in range(2)]
        unpacked = tmp_path / f"{trial}-unpacked.toml"
        for arguments in (
            ("pack", "--model", first, "--out", blocks[0], "--sequence", 77),
            ("unpack", blocks[0], "--out", unpacked),
            ("pack", "--model", unpacked, "--out", blocks[1], "--sequence", 77),
            ("diff", first, blocks[0], "--check"),
            ("diff", unpacked, blocks[0], "--check"),
        ):
            outcome = brace("params", *arguments)
            assert outcome.code == 0, outcome.err + outcome.out
        assert blocks[0].read_bytes() == blocks[1].read_bytes()
        for name, value in load_limb(unpacked).values.items():
            if isinstance(value, float) and np.isfinite(value):
                # half a step each: to the float, to its decimals
                assert value == pytest.approx(start.number(name), rel=2**-23, abs=1e-44)


def test_rounding_is_told(tmp_path: Path, brace: Brace) -> None:
    limb = _file(tmp_path, LIMB.replace("[uncertainty]", "[base]\nx_mm_per_n = 1e-44\n[uncertainty]"))
    outcome = brace("params", "pack", "--model", limb, "--out", tmp_path / "b.bin", "--json")
    told = json.loads(outcome.out)
    assert [item["key"] for item in told["rounded"]] == ["base.x_mm_per_n"]
    assert told["rounded"][0]["held"] == float(np.float32(1e-44))
    assert told["bytes"] == 24 + 4 * len(PARAMETERS) and told["schema_hash"] == f"{SCHEMA_HASH:08x}"
    assert "base.x_mm_per_n" in outcome.err


def test_differences_have_key_values_and_unit(tmp_path: Path, brace: Brace) -> None:
    first = _file(tmp_path, LIMB)
    second = _file(
        tmp_path,
        LIMB.replace("313.5", "313.6") + "[sensor]\nsaturation_n = 100.0\n[change]\nlink = 'femur'\n",
        "2.toml",
    )
    outcome = brace("params", "diff", first, second, "--json")
    assert outcome.code == 0
    assert json.loads(outcome.out)["differences"] == [
        {"key": "geometry.tibia_mm", "unit": "mm", "a": 313.5, "b": 313.6},
        {"key": "sensor.saturation_n", "unit": "N", "a": "inf", "b": 100.0},
        {"key": "change.link", "unit": "", "a": "tibia", "b": "femur"},
    ]
    outcome = brace("params", "diff", first, second, "--check")
    assert outcome.code == 1
    assert "geometry.tibia_mm" in outcome.out and "mm" in outcome.out


def test_the_same_values_have_the_same_identity(tmp_path: Path, brace: Brace) -> None:
    limb, told = _file(tmp_path, LIMB), []
    for sequence in (1, 4294967295):
        out = tmp_path / f"{sequence}.bin"
        told.append(
            json.loads(brace("params", "pack", "--model", limb, "--out", out, "--sequence", sequence, "--json").out)
        )
    assert told[0]["parameter_crc"] == told[1]["parameter_crc"]
    unpacked = json.loads(brace("params", "unpack", tmp_path / "1.bin", "--json").out)
    assert unpacked["parameter_crc"] == told[0]["parameter_crc"] and unpacked["sequence"] == 1
    assert unpacked["parameters"]["sensor.saturation_n"] == "inf"
    body = (tmp_path / "1.bin").read_bytes()
    assert zlib.crc32(body[8:12] + body[20:-4]) == int(told[0]["parameter_crc"], 16)


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        (
            "[motor.femur]\ntorque_noise_n_mm = 9000.0\n",
            ["motor.femur.torque_noise_n_mm", "at most motor.femur.torque_range"],
        ),
        (
            "[motor.tibia]\nangle_min_rad = 3.5\n",
            ["motor.tibia.angle_max_rad", "more than motor.tibia.angle_min_rad = 3.5"],
        ),
        (
            "[controller]\ntick_us = 5000\nage_limit_us = 4000\n",
            ["controller.age_limit_us", "controller.tick_us = 5000"],
        ),
        ("[controller]\ncan_bit_rate = 400000\n", ["controller.can_bit_rate", "125000 or 250000"]),
        ("[controller]\nnode_id = 128\n", ["controller.node_id", "[0, 127]"]),
        ("[controller]\nnode_id = 1.5\n", ["whole number"]),
        ("[controller]\nnod_id = 1\n", ["did you mean controller.node_id"]),
        ("[creep]\ntime_constant_s = 1e300\n", ["creep.time_constant_s", "32-bit"]),
        ("[sensor]\ngain = 1e-60\n", ["sensor.gain"]),
    ],
)
def test_what_a_controller_cannot_hold_is_refused(lines: str, words: list[str], tmp_path: Path, brace: Brace) -> None:
    limb, out = _file(tmp_path, LIMB + lines), tmp_path / "b.bin"
    outcome = brace("params", "pack", "--model", limb, "--out", out)
    assert outcome.code == 3 and not out.exists()
    assert f"{limb}:" in outcome.err and "why:" in outcome.err and "try:" in outcome.err
    for word in words:
        assert word in outcome.err


def test_broken_blocks_are_refused(tmp_path: Path, brace: Brace) -> None:
    whole = _block({})
    flipped = bytearray(whole)
    flipped[100] ^= 4
    cases = {
        "empty": (b"", 3, "missing"),
        "text": (b"format = 1\n" * 10, 3, "not a parameter block"),
        "cut": (whole[:-1], 3, "bytes"),
        "padded": (whole + b"\0", 3, "bytes"),
        "flipped": (bytes(flipped), 3, "damaged"),
        "out of range": (_block({"sensor.gain": -1.0}), 3, "sensor.gain"),
        "nan": (_block({"geometry.femur_mm": float("nan")}), 3, "geometry.femur_mm"),
        "other schema": (_block({}, schema=SCHEMA_HASH ^ 1), 6, f"{SCHEMA_HASH:08x}"),
    }
    for name, (content, code, word) in cases.items():
        path = tmp_path / "b.bin"
        path.write_bytes(content)
        outcome = brace("params", "unpack", path, "--out", tmp_path / "limb.toml")
        assert outcome.code == code, name
        assert word in outcome.err and "try:" in outcome.err, name
        assert not (tmp_path / "limb.toml").exists()
    assert f"{SCHEMA_HASH ^ 1:08x}" in outcome.err  # both hashes


def test_usage(tmp_path: Path, brace: Brace) -> None:
    limb = _file(tmp_path, LIMB)
    assert brace("params").code == 2
    assert brace("params", "pack", "--model", limb).code == 2
    assert brace("params", "pack", "--model", limb, "--out", limb).code == 2
    assert brace("params", "pack", "--model", limb, "--out", tmp_path / "b", "--sequence", -1).code == 2
    assert brace("params", "diff", limb).code == 2
    assert brace("params", "unpack", tmp_path / "none.bin").code == 3
    assert load_limb(limb).number("geometry.femur_mm") == 185.0
