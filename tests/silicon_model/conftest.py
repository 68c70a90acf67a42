"""The image is compiled once; each test gets a chip of its own."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from chip import Image
from silicon import Maker, Silicon


@pytest.fixture(scope="session")
def image(tmp_path_factory: pytest.TempPathFactory) -> Image:
    return Image(tmp_path_factory.mktemp("stm32f405"))


@pytest.fixture
def silicon(image: Image) -> Iterator[Maker]:
    """Makes chips; what the manual forbids fails the test that did it."""
    made: list[Silicon] = []

    def make(
        seed: int = 0,
        crystal_hz: int | None = 8_000_000,
        pll_locks: bool = True,
        csr: int = 0x0E000000,
        lsi_hz: float = 32_000.0,
    ) -> Silicon:
        made.append(Silicon(image, seed, crystal_hz, pll_locks, csr, lsi_hz))
        return made[-1]

    yield make
    for one in made:
        assert one.chip.violations == []
