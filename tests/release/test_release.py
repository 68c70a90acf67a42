"""Parts of ./dev release that are quick to try; the whole of it is run before a release."""

from __future__ import annotations

import json
import re
import shutil
import sys
import tarfile
import time
from pathlib import Path

import pytest
from targets import PROJECT, output_of

sys.path.insert(0, str(PROJECT / "tools"))
from release import source  # noqa: E402
from release.about import About, about  # noqa: E402
from release.python_packages import long_description  # noqa: E402

EPOCH_S = 1_700_000_000
HERE = source.Source(PROJECT, "0" * 40, EPOCH_S, source.version_of(PROJECT))


def test_an_archive_does_not_depend_on_order_time_or_rights(tmp_path: Path) -> None:
    for name, files in (("one", ("b", "a/c")), ("two", ("a/c", "b"))):
        for file in files:
            path = tmp_path / name / file
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(file)
    (tmp_path / "two" / "b").chmod(0o600)
    for name in ("one", "two"):
        source.archive(tmp_path / name, "brace-1", tmp_path / f"{name}.tar.gz", EPOCH_S)
    assert (tmp_path / "one.tar.gz").read_bytes() == (tmp_path / "two.tar.gz").read_bytes()
    with tarfile.open(tmp_path / "one.tar.gz") as tar:
        assert tar.getnames() == ["brace-1/a", "brace-1/a/c", "brace-1/b"]
        assert {entry.mtime for entry in tar} == {EPOCH_S}


def test_the_sources_of_the_last_commit_are_exported(tmp_path: Path) -> None:
    """./dev chooses Debian's Python, 3.11.2, which lacks what later patches of 3.11 have."""
    try:
        commit = source.run("git", "rev-parse", "HEAD", cwd=PROJECT).strip()
    except source.ReleaseError as error:
        pytest.skip(f"git does not read this folder: {error}")
    exported = source.export(tmp_path)
    assert (tmp_path / "dev").read_text() == output_of("git", "show", "HEAD:dev", cwd=PROJECT)
    assert (tmp_path / "dev").stat().st_mode & 0o100
    assert exported.commit == commit


def test_sums_are_what_sha256sum_reads(tmp_path: Path) -> None:
    (tmp_path / "firmware").mkdir()
    for name in ("firmware/b.bin", "a.txt"):
        (tmp_path / name).write_text(name)
    (tmp_path / "SHA256SUMS").write_text(source.sums(tmp_path))
    assert output_of("sha256sum", "--check", "SHA256SUMS", cwd=tmp_path).splitlines() == [
        "a.txt: OK", "firmware/b.bin: OK",
    ]  # fmt: skip


def test_one_author_and_one_address() -> None:
    """tools/pyproject.toml says them; the packages that ROS reads cannot ask it."""
    ours = about(PROJECT)
    assert {"Homepage", "Source", "Documentation", "Changelog", "Issues"} <= ours.urls.keys()
    for path in (PROJECT / "tools" / "client" / "ros2").glob("*/package.xml"):
        assert f'<maintainer email="{ours.email}">' in path.read_text(), path
    filled_in = About("brace", "1", "", "us", "us@robots.org", {"Source": "https://robots.org"}, (), ())
    assert not filled_in.has_placeholders


def test_the_long_description_has_no_link_to_a_file_beside_it() -> None:
    text = long_description(HERE)
    targets = re.findall(r"\]\(([^)]+)\)", text)
    assert len(targets) > 50 and all(target.startswith(("https://", "#")) for target in targets)
    home = about(PROJECT).urls["Source"]
    assert f"({home}/raw/main/docs/monitor.png)" in text and f"({home}/blob/main/docs/design.md)" in text


def test_bill_of_materials(tmp_path: Path) -> None:
    pytest.importorskip("cyclonedx")
    from cyclonedx.schema import SchemaVersion
    from cyclonedx.validation.json import JsonStrictValidator
    from release.bill_of_materials import bill_of_materials

    if shutil.which("dpkg-query") is None:
        pytest.skip("not Debian")
    text = bill_of_materials(HERE)
    assert text == bill_of_materials(HERE)
    assert JsonStrictValidator(SchemaVersion.V1_6).validate_str(text) is None
    bill = json.loads(text)
    assert bill["metadata"]["component"]["name"] == "brace"
    names = {part["name"] for part in bill["components"]}
    assert {"eigen", "newlib", "numpy", "scipy"} <= names and len(names) == len(about(PROJECT).needs) + 3


@pytest.mark.parametrize("zone", ["America/Los_Angeles", "Asia/Tokyo"])
def test_man_pages_have_one_date_in_every_time_zone(monkeypatch: pytest.MonkeyPatch, zone: str) -> None:
    pytest.importorskip("argparse_manpage")
    from release.man_pages import man_pages

    monkeypatch.setenv("SOURCE_DATE_EPOCH", str(EPOCH_S))  # 2023-11-14 22:13 UTC
    monkeypatch.setenv("TZ", zone)
    time.tzset()
    try:
        assert "2023\\-11\\-14" in man_pages("0.1.0")["brace-k.1"].splitlines()[0]
    finally:
        monkeypatch.undo()
        time.tzset()


def test_no_line_of_a_man_page_is_a_request_by_chance() -> None:
    """`.log, .mcap` at the start of a line would be left out."""
    pytest.importorskip("argparse_manpage")
    from release.man_pages import man_pages

    pages = man_pages("0.1.0")
    assert "\n\\&.log, .mcap" in pages["brace-record.1"]
    starts = {line.split()[0] for page in pages.values() for line in page.splitlines() if line[:1] in (".", "'")}
    assert starts <= {".TH", ".SH", ".SS", ".PP", ".TP", ".B", ".BR", ".sp", ".nf", ".fi", ".br"}


def test_the_source_distribution_has_what_its_build_needs(tmp_path: Path) -> None:
    """Every folder that the top CMakeLists.txt takes in for the wheel, and the licence; no board, no test."""
    pytest.importorskip("build")
    pytest.importorskip("scikit_build_core")
    from release.python_packages import source_distribution

    made = source_distribution(HERE, tmp_path / "work", tmp_path)
    with tarfile.open(made) as tar:
        names = {name.partition("/")[2] for name in tar.getnames()}
    assert {"LICENSE", "brace/data/paper-limb.toml", "native/CMakeLists.txt", "native/firmware/core/cmake/package.cmake",
            "native/host_sim/CMakeLists.txt", "native/tools/stance/src/stance.cpp",
            "README.md", "brace/docs/errors.md", "native/hal/posix/include/brace_hal_posix.h"} <= names  # fmt: skip
    assert not any(name.startswith(("native/tests", "native/firmware/boards")) for name in names)


def test_what_is_installed_has_the_pages_that_messages_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A wheel has docs/ inside; the source distribution puts it there."""
    from brace.ground import errors

    named = {name for path in (PROJECT / "tools" / "brace").rglob("*.py")
             for name in re.findall(r"docs/([a-z-]+\.md)", path.read_text())}  # fmt: skip
    assert "errors.md" in named and named <= {path.name for path in (PROJECT / "docs").iterdir()}
    assert errors._INSTALLED == PROJECT / "tools" / "brace" / "docs"
    folder = tmp_path / "brace"
    (folder / "docs").mkdir(parents=True)
    error = errors.UsageError("what", next_step="docs/errors.md and docs/security.md say why")
    assert error.render().endswith("try: docs/errors.md and docs/security.md say why")  # in the project
    monkeypatch.setattr(errors, "_INSTALLED", folder / "docs")
    assert error.render().endswith(f"try: {folder}/docs/errors.md and {folder}/docs/security.md say why")
