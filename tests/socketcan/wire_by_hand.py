"""The wire as docs and DBC describe it, written out by hand, and K by physics.md in double precision: shares no code with
what it judges."""

from __future__ import annotations

import functools
import math
import struct
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

PROJECT = Path(__file__).resolve().parents[2]
LIMB = PROJECT / "tools" / "brace" / "data" / "paper-limb.toml"
DBC = PROJECT / "firmware" / "interface" / "brace.dbc"

NODE = 1
STIFFNESS_A, DETAILS, STIFFNESS_B, EIGENVALUES, POSTURE, HEARTBEAT = 0x180, 0x200, 0x280, 0x380, 0x480, 0x700
REQUEST, ANSWER = 0x600, 0x580
READ_ENTRY, K_AT_POSTURE = 1, 3
K_ANSWERS = [3, 4, 5, 6]  # the numbers of the frames that answer it
SEQUENCE_ENTRY = 0x1004  # the snapshot's number, of the measured values
K_STEP_N_PER_MM = 0.0005
AXIS_STEP_RAD = 1e-4


def whole(data: bytes, start_bit: int, bits: int, signed: bool = False) -> int:
    """A run of bits of a frame, Intel."""
    code = int.from_bytes(data, "little") >> start_bit & (1 << bits) - 1
    return code - (1 << bits) if signed and code >> (bits - 1) else code


def k_request(token: int, theta1_rad: float, theta2_rad: float) -> bytes:
    """K at a posture: two 24-bit angles of 1e-6 rad."""
    angles = [round(angle * 1e6) & 0xFFFFFF for angle in (theta1_rad, theta2_rad)]
    return bytes((K_AT_POSTURE, token)) + b"".join(angle.to_bytes(3, "little") for angle in angles)


def entry_request(token: int, index: int) -> bytes:
    """The value of an entry."""
    return struct.pack("<BBHI", READ_ENTRY, token, index, 0)


@dataclass
class K:
    """An answer's numbers, or what they should be [N/mm, rad]."""

    xx: float
    xz: float
    zz: float
    low: float
    high: float
    axis: float


def k_of_answers(parts: list[bytes]) -> K:
    """Of the four frames, in their order."""
    assert [part[0] for part in parts] == K_ANSWERS, parts
    xx, xz = (whole(parts[0], start, 24, True) * K_STEP_N_PER_MM for start in (16, 40))
    zz, low = (whole(parts[1], 16, 24, True) * K_STEP_N_PER_MM, whole(parts[1], 40, 24) * K_STEP_N_PER_MM)
    high, axis = whole(parts[2], 16, 24) * K_STEP_N_PER_MM, whole(parts[2], 40, 16, True) * AXIS_STEP_RAD
    return K(xx, xz, zz, low, high, axis)


@functools.cache
def _paper_limb() -> dict[str, Any]:
    return tomllib.loads(LIMB.read_text())


def paper_k(theta1_rad: np.ndarray | float, theta2_rad: np.ndarray | float) -> np.ndarray:
    """K of the paper's limb at postures, ... x 2 x 2 [N/mm]."""
    limb = _paper_limb()
    length1, length2 = limb["geometry"]["femur_mm"], limb["geometry"]["tibia_mm"]
    femur, tibia = limb["link"]["femur"], limb["link"]["tibia"]
    assert not femur["moment_transfer"], "this formula is for links without moment transfer"
    theta1, theta2 = np.asarray(theta1_rad, float), np.asarray(theta2_rad, float)
    u1 = np.stack([np.cos(theta1), np.sin(theta1)], -1)
    u2 = np.stack([np.cos(theta1 - theta2), np.sin(theta1 - theta2)], -1)
    shank = length2 * u2
    tip = length1 * u1 + shank
    p1 = np.stack([-tip[..., 1], tip[..., 0]], -1)
    p2 = np.stack([-shank[..., 1], shank[..., 0]], -1)
    bend1, bend2 = femur["bending_mm_per_n"] / length1**2, tibia["bending_mm_per_n"] / length2**2
    joint1, joint2 = (limb["joint"][name]["compliance_rad_per_n_mm"] for name in ("femur", "tibia"))

    def outer(a: np.ndarray, b: np.ndarray) -> np.ndarray:
        return np.asarray(a[..., :, None] * b[..., None, :])

    c = (
        (joint1 + bend1) * outer(p1, p1)
        - bend1 * (outer(p1, p2) + outer(p2, p1))
        + (joint2 + bend1 + bend2) * outer(p2, p2)
        + femur["axial_mm_per_n"] * outer(u1, u1)
        + tibia["axial_mm_per_n"] * outer(u2, u2)
    )
    inverse: np.ndarray = np.linalg.inv(c)
    return inverse


def expected(theta1_rad: float, theta2_rad: float) -> K:
    """Of the paper's limb."""
    k = paper_k(theta1_rad, theta2_rad)
    values, vectors = np.linalg.eigh(k)
    axis = math.atan2(vectors[1, 1], vectors[0, 1])
    return K(k[0, 0], k[0, 1], k[1, 1], values[0], values[1], axis)


def check(reported: K, theta1_rad: float, theta2_rad: float) -> None:
    """Within a step of the wire and the core's 2e-6 of the largest entry; an axis has no sense, so modulo pi."""
    true = expected(theta1_rad, theta2_rad)
    room = K_STEP_N_PER_MM / 2 + 2e-6 * true.high + 1e-9
    for name in ("xx", "xz", "zz", "low", "high"):
        assert abs(getattr(reported, name) - getattr(true, name)) <= room, (name, reported, true)
    turn = (reported.axis - true.axis + math.pi / 2) % math.pi - math.pi / 2
    assert abs(turn) <= AXIS_STEP_RAD / 2 + 4e-6 * true.high / (true.high - true.low), (reported, true)
