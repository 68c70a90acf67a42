"""What docs/ needs to be a site: README as its first page, and links that leave docs/."""

from __future__ import annotations

import re
from pathlib import Path, PurePosixPath

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page

ROOT = Path(__file__).resolve().parents[2]
HEADERS = "c/index.html"  # Doxygen's pages of the C headers
_LINK = re.compile(r"(?<!!)\[([^\]]*)\]\(([^)#\s]+)(#[^)\s]*)?\)")


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """README.md is the site's first page."""
    files.append(File.generated(config, "index.md", content=_from_readme((ROOT / "README.md").read_text())))
    listed = set(re.findall(r"[\w-]+\.md", str(config.nav)))
    pages = {file.src_uri for file in files.documentation_pages()}
    for name in sorted(pages - listed):  # a page that is new: it stands at the end until nav has it
        config.nav.append(name)
    return files


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    """A link to a source file cannot be followed on the site: its words stay, and the file's name is said. A link to a
    C header goes to Doxygen's pages."""
    known = {file.src_uri for file in files}

    def replaced(found: re.Match[str]) -> str:
        words, target = found[1], found[2]
        if "://" in target or target in known or target == HEADERS:
            return found[0]
        name = str(PurePosixPath(target.removeprefix("../")))
        if not (ROOT / name).exists() and not (ROOT / "docs" / name).exists():
            raise FileNotFoundError(f"{page.file.src_uri}: a link to {target}, which is not there")
        if name.endswith(".h"):
            return f"[{words}]({HEADERS})"
        return words if words.strip("`") in (name, PurePosixPath(name).name) else f"{words} (`{name}`)"

    return _LINK.sub(replaced, markdown)


def _from_readme(markdown: str) -> str:
    """Its links as they are seen from docs/."""

    def replaced(found: re.Match[str]) -> str:
        words, target, anchor = found[1], found[2], found[3] or ""
        if "://" in target:
            return found[0]
        place = target.removeprefix("docs/") if target.startswith("docs/") else f"../{target}"
        return f"[{words}]({place}{anchor})"

    return re.sub(r"\]\(docs/", "](", _LINK.sub(replaced, markdown))  # pictures, too
