"""The controller images as files: bounds, what must not be in them, what lies beside them, what they say."""

from __future__ import annotations

import hashlib
import json
import re
import struct
import subprocess
from pathlib import Path

import numpy as np
import pytest
from board import IMAGES, PROJECT, image

from brace.flash.boards import BOARDS
from brace.flash.checks import board_of, check_fits, check_listed
from brace.flash.image import read_image

CONTROLLERS = tuple(f"brace-{board}" for board in BOARDS)
LIBRARIES_OF_HOSTS = re.compile(
    r"^_*(malloc|calloc|realloc|free|s?brk|[a-z]*printf(_float)?|[a-z]*scanf|puts|putchar|fopen|fwrite|write|read|open|"
    r"exit|impure_ptr|initialise_monitor_handles)(_r)?$"
)


def output_of(*command: object) -> str:
    return subprocess.run([str(part) for part in command], capture_output=True, text=True, check=True).stdout


def symbols(elf: Path) -> dict[str, int]:
    lines = (line.split() for line in output_of("arm-none-eabi-nm", elf).splitlines())
    return {fields[2]: int(fields[0], 16) for fields in lines if len(fields) == 3}


@pytest.mark.parametrize("name", CONTROLLERS)
def test_no_heap_no_stdio_no_semihosting(name: str) -> None:
    elf = image(name)
    assert [symbol for symbol in symbols(elf) if LIBRARIES_OF_HOSTS.match(symbol)] == []
    code = output_of("arm-none-eabi-objdump", "-d", elf)
    assert "vsqrt" in code or "vmul" in code  # it has been disassembled
    assert not re.search(r"\bbkpt\b", code)
    doubles = [symbol for symbol in symbols(elf) if re.match(r"__aeabi_d(add|mul|div|sub|2|cmp)", symbol)]
    assert doubles == []  # double precision would be a software library


def test_the_pattern_knows_them() -> None:
    for symbol in (
        "malloc",
        "_malloc_r",
        "_sbrk",
        "printf",
        "_printf_float",
        "snprintf",
        "_write",
        "_exit",
        "free",
    ):
        assert LIBRARIES_OF_HOSTS.match(symbol), symbol
    for symbol in ("memcpy", "main", "brace_app_tick", "nvm_write", "serial_read", "free_ring"):
        assert not LIBRARIES_OF_HOSTS.match(symbol), symbol


@pytest.mark.parametrize("name", CONTROLLERS)
def test_bounds(name: str) -> None:
    elf = image(name)
    board = BOARDS[name.removeprefix("brace-")]
    place = symbols(elf)
    assert place["_vectors"] == board.flash_start
    assert place["_stack_limit"] == board.ram_start  # lowest: outgrowing it is a fault
    assert place["_stack_top"] - place["_stack_limit"] == 8192
    assert (
        place["_stack_top"]
        <= place["_kept_nvm"]
        <= place["_data_start"]
        <= place["_bss_start"]
        <= place["_bss_end"]
    )
    assert place["_bss_end"] <= board.ram_start + board.ram_bytes
    load = read_image(elf)
    assert load.start == board.flash_start and load.end <= board.flash_start + board.flash_bytes
    headers = output_of("arm-none-eabi-objdump", "-h", elf)
    assert not re.search(r"\.(init_array|ctors|ARM\.exidx|eh_frame) ", headers)


@pytest.mark.parametrize("name", CONTROLLERS)
def test_files_beside_the_image(name: str) -> None:
    elf = image(name)
    images = [read_image(elf.with_suffix(f".{kind}")) for kind in ("elf", "hex", "bin")]
    assert len({one.flat() for one in images}) == 1
    for one in images:
        board = board_of(one, name.removeprefix("brace-"))
        check_fits(one, board)
        check_listed(one, unlisted=False)
    listed = (IMAGES / "SHA256SUMS").read_text()
    assert f"{hashlib.sha256(elf.read_bytes()).hexdigest()}  {elf.name}\n" in listed
    assert "brace_app_tick" in elf.with_suffix(".map").read_text()
    size = json.loads(elf.with_suffix(".size.json").read_text())
    text, data, bss = map(int, output_of("arm-none-eabi-size", elf).splitlines()[1].split()[:3])
    assert size["flash_bytes"] == text + data
    assert 0 <= len(images[0].flat()) - size["flash_bytes"] < 16  # code begins at a multiple of 16 after the vectors
    assert size["ram_bytes"] == data + bss and size["stack_bytes"] == 8192
    assert size["flash_of_bytes"] == board.flash_bytes and size["ram_of_bytes"] == board.ram_bytes


def test_a_board_of_servos_has_its_ceilings(tmp_path: Path) -> None:
    """Torque, least and greatest angle, speed of each joint: bounded, and wide enough for the set that is built in."""
    elf, plain = image("brace-stm32f405"), tmp_path / "plain.bin"
    output_of("arm-none-eabi-objcopy", "-O", "binary", elf, plain)
    at = symbols(elf)["ceilings"] - 0x0800_0000
    table = plain.read_bytes()[at : at + 48]
    for torque_n_mm, least_rad, most_rad, speed_rad_per_s in struct.iter_unpack("<4f", table):
        assert 8000.0 <= torque_n_mm < 1e5
        assert -8.0 < least_rad <= np.float32(-3.2) and np.float32(3.2) <= most_rad < 8.0
        assert 0.1 < speed_rad_per_s < 10.0


def test_a_port_can_start() -> None:
    """The blank board, which docs/porting.md starts from, is an image like the others."""
    one = read_image(image("brace-blank"))
    assert one.info is not None and one.info.board == "blank"
    assert {"brace_hal_blank", "brace_app_tick", "fault_handler"} <= symbols(one.path).keys()


def test_only_test_images_crash_on_request() -> None:
    for name in CONTROLLERS:
        assert not [symbol for symbol in symbols(image(name)) if symbol.startswith("provoke")]
    assert "provoke_hang" in symbols(image("brace-mps2-an386-crash-test"))


@pytest.mark.parametrize(
    ("script", "source", "options", "words"),
    [
        ("stm32f405/memory.ld", "char big[130 * 1024]; int main(void) { return big[5]; }", (),
         "region `RAM' overflowed"),
        ("stm32f405/memory.ld", "const char big[800 * 1024] = {1}; int main(void) { return big[5]; }", (),
         "region `FLASH' overflowed"),
        ("stm32f405/memory.ld", "int main(void) { return 0; }", ("-Wl,--defsym=_stack_size=1024",), "2 KiB of stack"),
    ],
)  # fmt: skip
def test_the_linker_refuses_what_does_not_fit(
    tmp_path: Path, script: str, source: str, options: tuple[str, ...], words: str
) -> None:
    boards = PROJECT / "firmware" / "boards"
    memory = tmp_path / "memory.ld"
    text = (boards / script).read_text()
    memory.write_text(re.sub(r"_stack_size = \w+;\n", "", text) if options else text)
    code = "extern int main(void); void reset_handler(void); void reset_handler(void) { main(); }"
    (tmp_path / "main.c").write_text(f"{code}\n{source}\n")
    done = subprocess.run(
        ["arm-none-eabi-gcc", "-mcpu=cortex-m4", "-mthumb", "-nostartfiles", "-nostdlib", *options,
         f"-L{boards}/common",
         f"-T{memory}", tmp_path / "main.c", "-o", tmp_path / "image.elf"],
        capture_output=True, text=True, check=False)  # fmt: skip
    assert done.returncode != 0 and words in done.stderr


def test_the_source_hash_says_dirty(tmp_path: Path) -> None:
    def hash_now() -> str:
        script = PROJECT / "firmware" / "boards" / "common" / "build_info.cmake"
        output_of("cmake", f"-DSOURCE={tmp_path / 'source'}", f"-DOUT={tmp_path}", "-DBRACE_VERSION=1.2.3",
                  "-DBRACE_BUILD_TYPE=Release", "-P", script)  # fmt: skip
        text = (tmp_path / "build_info.h").read_text()
        assert '"1.2.3"' in text and '"Release"' in text
        return str(re.findall(r'SOURCE_HASH "(.*)"', text)[0])

    def git(*arguments: str) -> str:
        return output_of(
            "git",
            "-C",
            tmp_path / "source",
            "-c",
            "user.name=t",
            "-c",
            "user.email=t@example.org",
            *arguments,
        )

    source = tmp_path / "source" / "firmware" / "main.c"
    source.parent.mkdir(parents=True)
    source.write_text("1\n")
    assert hash_now() == "unknown"
    git("init", "-q")
    git("add", ".")
    git("commit", "-q", "-m", "one")
    clean = hash_now()
    assert clean == git("rev-parse", "--short=12", "HEAD").strip()
    (tmp_path / "source" / "notes.md").write_text("nothing of the image's\n")
    assert hash_now() == clean
    source.write_text("2\n")
    assert hash_now() == clean + "-dirty"
    git("commit", "-q", "-a", "-m", "two")
    assert re.fullmatch(r"[0-9a-f]{12}", hash_now()) and hash_now() != clean
