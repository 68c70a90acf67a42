"""The enumeration of power cuts of the drift check's journal (tests/judges/memory)
finds out every journal broken on purpose."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from test_broken_stores import INCLUDES, INTERFACE, PROJECT

BROKEN = {
    "does not clear the next pieces": ("if (!journal->clean)", "if (false)"),
    "clears one piece only": ("ZEROED = 2 * PIECE", "ZEROED = PIECE"),
    "believes a record without its checksum": ("if (journal->crc == crc_of_record(journal))", "if (true)"),
    "lets half a record hide the one behind it": ("journal->position = journal->begun + PIECE;", ""),
    "writes over what may have been touched": ("is_blank(piece) || journal->next > at ?", "true ?"),
    "covers the header only": ("at + PIECE < BRACE_JOURNAL_COVERED_BYTES ?",
                               "at + PIECE < BRACE_JOURNAL_COVERED_BYTES && at == 0u ?"),
    "writes into the store's part": ("BRACE_JOURNAL_AT + offset, bytes, count",
                                     "BRACE_JOURNAL_AT - 64 + offset, bytes, count"),
}
SOURCES = ("tests/judges/memory/crc32_fast.c", "tests/judges/memory/nvm_model.c", "tests/judges/memory/journal_cuts.c")


@pytest.mark.minutes
@pytest.mark.skipif(shutil.which("gcc") is None, reason="no gcc")
@pytest.mark.parametrize("name", BROKEN)
def test_a_broken_journal_is_found_out(name: str, tmp_path: Path) -> None:
    before, after = BROKEN[name]
    text = (PROJECT / "firmware/store/src/journal.c").read_text()
    assert text.count(before) == 1, f"journal.c no longer has what this test breaks: {before}"
    (tmp_path / "journal.c").write_text(text.replace(before, after))
    program = tmp_path / "journal_cuts"
    subprocess.run(
        ["gcc", "-std=c11", "-O2", "-w", "-DNVM_MODEL_SLOT_BYTES=8192",
         *(f"-I{PROJECT / folder}" for folder in (*INCLUDES, *INTERFACE)),
         "-o", program, *(PROJECT / source for source in SOURCES), tmp_path / "journal.c"], check=True)
    outcome = subprocess.run([program, "--broken"], capture_output=True, text=True, timeout=300)
    assert outcome.returncode == 0, outcome.stdout
    print(f"{name}: {outcome.stdout.strip().splitlines()[-1]}")
