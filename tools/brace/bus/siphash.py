"""SipHash-2-4, a keyed check of short messages (J.-P. Aumasson, D. J. Bernstein, INDOCRYPT 2012)."""

from __future__ import annotations

_MASK = (1 << 64) - 1
KEY_BYTES = 16


def siphash(key: bytes, message: bytes) -> int:
    """The check, 64 bits."""
    k0, k1 = int.from_bytes(key[:8], "little"), int.from_bytes(key[8:KEY_BYTES], "little")
    v = [k0 ^ 0x736F6D6570736575, k1 ^ 0x646F72616E646F6D, k0 ^ 0x6C7967656E657261, k1 ^ 0x7465646279746573]
    padded = message + bytes(7 - len(message) % 8) + bytes([len(message) & 0xFF])
    for at in range(0, len(padded), 8):
        word = int.from_bytes(padded[at : at + 8], "little")
        v[3] ^= word
        _turn(v, 2)
        v[0] ^= word
    v[2] ^= 0xFF
    _turn(v, 4)
    return v[0] ^ v[1] ^ v[2] ^ v[3]


def _turned(value: int, bits: int) -> int:
    return (value << bits | value >> (64 - bits)) & _MASK


def _turn(v: list[int], times: int) -> None:
    a, b, c, d = v
    for _ in range(times):
        a = (a + b) & _MASK
        b = _turned(b, 13) ^ a
        a = _turned(a, 32)
        c = (c + d) & _MASK
        d = _turned(d, 16) ^ c
        a = (a + d) & _MASK
        d = _turned(d, 21) ^ a
        c = (c + b) & _MASK
        b = _turned(b, 17) ^ c
        c = _turned(c, 32)
    v[:] = a, b, c, d
