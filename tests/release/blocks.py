"""Keeps a parameter block of this version: what its controllers have in flash. Run it before a release.

    .venv/bin/python tests/release/blocks.py
"""

from __future__ import annotations

from pathlib import Path

from brace import __version__
from brace.model import load_limb
from brace.params import pack

FOLDER = Path(__file__).with_name("blocks")
LIMB = Path(__file__).resolve().parents[2] / "tools" / "brace" / "data" / "paper-limb.toml"


def main() -> None:
    """Writes blocks/<version>.bin: the paper's limb, sequence 7."""
    (FOLDER / f"{__version__}.bin").write_bytes(pack(load_limb(LIMB), sequence=7).content)


if __name__ == "__main__":
    main()
