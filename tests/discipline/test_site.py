"""docs/ becomes a site without a warning, and a link that leads nowhere is one."""

from __future__ import annotations

import importlib
import shutil
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools" / "site"))


def built(root: Path, folder: Path) -> subprocess.CompletedProcess[str]:
    script = root / "tools/site/build.py"
    return subprocess.run([sys.executable, script, folder], capture_output=True, text=True, timeout=300)


@pytest.fixture(autouse=True)
def generators() -> None:
    pytest.importorskip("mkdocs")
    if shutil.which("doxygen") is None:
        pytest.skip("no doxygen here")


def test_the_site_has_all_pages_and_no_warning(tmp_path: Path) -> None:
    done = built(ROOT, tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    listed = (ROOT / "tools/site/mkdocs.yml").read_text()
    for page in (ROOT / "docs").glob("*.md"):
        assert (tmp_path / f"{page.stem}.html").exists(), page.name
        assert f"- {page.name}\n" in listed, f"{page.name} stands in no list of tools/site/mkdocs.yml"
    assert "Brace" in (tmp_path / "index.html").read_text()
    assert (tmp_path / "c" / "index.html").exists()
    assert any("brace_loaded_stiffness" in file.read_text() for file in (tmp_path / "c").glob("*loaded_8h.html"))


def test_a_link_that_leads_nowhere_is_refused() -> None:
    hooks = importlib.import_module("hooks")
    page = SimpleNamespace(file=SimpleNamespace(src_uri="plan.md"))
    known = [SimpleNamespace(src_uri="plan.md")]

    def seen(markdown: str) -> str:
        return str(hooks.on_page_markdown(markdown, page, None, known))

    assert seen("[a](plan.md#b) [c](https://example.org)") == "[a](plan.md#b) [c](https://example.org)"
    assert seen("[the list](../docs/layers.toml)") == "the list (`docs/layers.toml`)"
    assert seen("[`tests`](../tests)") == "`tests`"
    assert seen("[loaded](../firmware/core/include/brace/loaded.h)") == f"[loaded]({hooks.HEADERS})"
    with pytest.raises(FileNotFoundError, match="plan.md: a link to nowhere.md"):
        seen("[a page](nowhere.md)")
