"""K as a picture of characters: the force that a displacement of 1 mm meets, all round."""

from __future__ import annotations

import math

_BRAILLE = 0x2800
_DOT = ((0x01, 0x08), (0x02, 0x10), (0x04, 0x20), (0x40, 0x80))  # row, column of a cell
_POINTS = 720


def ellipse(k_xx: float, k_xz: float, k_zz: float, columns: int = 26, rows: int = 12) -> list[str]:
    """Lines of braille dots, x to the right, z up, the longer half axis (lambda_max) to the edge."""
    width, height = 2 * columns, 4 * rows
    cells = [[0] * columns for _ in range(rows)]
    points = []
    for index in range(_POINTS):
        angle = 2 * math.pi * index / _POINTS
        x, z = math.cos(angle), math.sin(angle)
        points.append((k_xx * x + k_xz * z, k_xz * x + k_zz * z))
    reach = max(math.hypot(*point) for point in points)
    if not reach > 0.0 or not math.isfinite(reach):
        return []
    scale = (min(width, height) - 1) / 2 / reach

    def mark(x: float, z: float) -> None:
        column, row = round((width - 1) / 2 + x * scale), round((height - 1) / 2 - z * scale)
        if 0 <= column < width and 0 <= row < height:
            cells[row // 4][column // 2] |= _DOT[row % 4][column % 2]

    for point in points:
        mark(*point)
    mark(0.0, 0.0)
    return ["".join(chr(_BRAILLE + cell) for cell in line) for line in cells]
