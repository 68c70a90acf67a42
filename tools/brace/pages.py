"""Where the project's pages lie on this machine, for messages that name one as docs/NAME.md."""

from __future__ import annotations

import re
from pathlib import Path

_INSTALLED = Path(__file__).resolve().parents[3] / "share" / "doc" / "brace" / "docs"  # the Debian package's
_PAGE = re.compile(r"(?<![\w/])docs/(?=[a-z-]+\.md\b)")


def located(text: str) -> str:
    """The text, with the folder of its pages where they are installed; in the project they are in docs/."""
    if "docs/" not in text or not _INSTALLED.is_dir():
        return text
    return _PAGE.sub(f"{_INSTALLED}/", text)
