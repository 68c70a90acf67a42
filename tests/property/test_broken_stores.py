"""The enumeration of power cuts (tests/judges/memory) finds out every store that is broken on purpose."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

PROJECT = Path(__file__).resolve().parents[2]
STORE = PROJECT / "firmware" / "store" / "src"
INCLUDES = ("firmware/store/include", "firmware/store/src", "firmware/core/include", "firmware/core/src", "hal/include",
            "tests/judges/memory")
INTERFACE = ("firmware/interface/include", "firmware/interface/generated", "firmware/interface/src")
FOLDERS = [PROJECT / folder for folder in (*INCLUDES, *INTERFACE)]
SOURCES = (
    "firmware/interface/src/[!c]*.c",  # all but crc32.c, in whose place stands
    "tests/judges/memory/crc32_fast.c",
    "firmware/interface/generated/*.c",
    "firmware/core/src/limb/*.c",
    "firmware/core/src/base/*.c",
    "tests/judges/memory/nvm_model.c",
    "tests/judges/memory/power_cuts.c",
)

Edit = tuple[str, str, str]  # file, what stands there, what it becomes
GO_ON = "(go_to(store, {}), BRACE_STORE_BUSY)"
BROKEN: dict[str, list[Edit]] = {
    "commits before the block": [
        ("store.c", "go_to(store, STAGE_WRITE)", "go_to(store, STAGE_COMMIT)"),
        (
            "store.c",
            "store->wanted_sequence = store->sequence;\n        go_to(store, STAGE_PAST);",
            "go_to(store, STAGE_WRITE);",
        ),
        (
            "store.c",
            "go_to(store, STAGE_COMMIT);\n    }\n    return BRACE_STORE_BUSY;\n}\n\nstatic brace_store_state_t reread",
            "return done(store);\n    }\n    return BRACE_STORE_BUSY;\n}\n\nstatic brace_store_state_t reread",
        ),
    ],
    "does not erase": [("store.c", "store->hal->nvm_erase(store->hal->context, slot) != BRACE_HAL_OK", "false")],
    "writes the slot in force": [
        ("store.c", "return other_than(store->in_force - 1u);\n    }\n    const",
         "return store->in_force - 1u;\n    }\n    const")
    ],
    "does not affirm the slot in force": [
        ("store.c", "settle(store, other, store->is_old ? STORE_PAST : STORE_KEEP, STAGE_RETIRE)",
         GO_ON.format("STAGE_RETIRE"))
    ],
    "does not affirm the slot it rolls back to": [
        ("store.c", "settle(store, store->target, STORE_KEEP, STAGE_REREAD)", GO_ON.format("STAGE_REREAD"))
    ],
    "does not retire the slot it erases": [
        ("store.c", "settle(store, store->target, STORE_VOID, STAGE_SPOIL)", GO_ON.format("STAGE_SPOIL"))
    ],
    "does not spoil the slot it erases": [
        ("store.c", "settle(store, store->target, STORE_VOID, STAGE_SPOIL)",
         "settle(store, store->target, STORE_VOID, STAGE_ERASE)")
    ],
    "believes any sound block": [
        ("store_slot.c", "bool is_kept = marks.last_said == SAYS_KEEP ||", "bool is_kept = true ||")
    ],
    "believes a void slot": [("store_slot.c", '"VOID", 4) == 0 ? SAYS_VOID', '"VOID", 4) == 0 ? SAYS_NOTHING')],
    "calls a spoilt slot rotten": [("store_slot.c", "memcmp(store->block, withdrawn, sizeof withdrawn) != 0 &&", "")],
    "does not spoil again what an update had begun to spoil": [
        ("store.c", "store->next_mark[store->target] != 0u ? STAGE_SPOIL : STAGE_ERASE", "STAGE_ERASE")
    ],
    "leaves no mark in the slot that was in force": [
        ("store.c", "is_in_force(store, other) ? put_spare(store, other, STORE_PAST) : done(store)", "done(store)")
    ],
    "forgets while it stores that the set in force is old": [
        ("store.c", "store->is_old ? STORE_PAST : STORE_KEEP", "STORE_KEEP")
    ],
    "sees no slot that has rotted": [("store.c", "has_gone || (claims[other].is_rotten && is_later)", "false")],
    "believes a damaged block": [
        ("store_slot.c", "status != BRACE_OK && status != BRACE_E_PARAMETER", "status == BRACE_E_NULL"),
        (
            "store_slot.c",
            "return status == BRACE_OK ? BRACE_SLOT_COUNTS : BRACE_SLOT_REFUSED",
            "return brace_block_members(store->block, parameters), BRACE_SLOT_COUNTS",
        ),
        ("store_slot.c", "bool is_kept = marks.last_said == SAYS_KEEP ||", "bool is_kept = true ||"),
    ],
    "does not clear the next place": [("store.c", "if (!store->clean[slot])", "if (false)")],
    "takes the older set": [
        ("store.c", "(store->slot[1].sequence - store->slot[0].sequence) > 0;",
         "(store->slot[1].sequence - store->slot[0].sequence) < 0;")
    ],
}


def compile_objects(sources: list[Path], folders: list[Path], into: Path) -> list[Path]:
    """Their objects, with the includes looked for in these folders."""
    into.mkdir(exist_ok=True)
    subprocess.run(["gcc", "-std=c11", "-O2", "-w", *(f"-I{folder}" for folder in folders), "-c", *sources],
                   cwd=into, check=True)  # fmt: skip
    return [into / f"{source.stem}.o" for source in sources]


@pytest.fixture(scope="module")
def unbroken_objects(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    """All of the program but the store, which each test breaks in its own way."""
    sources = [path for pattern in SOURCES for path in sorted(PROJECT.glob(pattern))]
    assert len({source.stem for source in sources}) == len(sources)
    return compile_objects(sources, FOLDERS, tmp_path_factory.mktemp("unbroken"))


@pytest.mark.minutes
@pytest.mark.skipif(shutil.which("gcc") is None, reason="no gcc")
@pytest.mark.parametrize("name", BROKEN)
def test_a_broken_store_is_found_out(name: str, unbroken_objects: list[Path], tmp_path: Path) -> None:
    folder = tmp_path / "store"
    shutil.copytree(STORE, folder)
    for file, before, after in BROKEN[name]:
        text = (folder / file).read_text()
        assert text.count(before) == 1, f"{file} no longer has what this test breaks: {before}"
        (folder / file).write_text(text.replace(before, after))
    program = tmp_path / "power_cuts"
    broken = compile_objects(sorted(folder.glob("*.c")), [folder, *FOLDERS], tmp_path / "objects")
    subprocess.run(["gcc", "-o", program, *unbroken_objects, *broken, "-lm"], check=True)
    outcome = subprocess.run([program, "--broken"], capture_output=True, text=True, timeout=300)
    assert outcome.returncode == 0, outcome.stdout
    print(f"{name}: {outcome.stdout.strip().splitlines()[-1]}")
