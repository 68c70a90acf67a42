"""brace flash: what it refuses, what it would run, how soon it says that nothing is there. No board is needed:
programmers are stand-ins on PATH, images are made here."""

from __future__ import annotations

import hashlib
import json
import os
import stat
import threading
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from command_bench import Outcome
from image_bench import START, content, elf, info_block, list_them

from brace.flash import console, usb
from brace.flash.image import ImageInfo, read_image

Brace = Callable[..., Outcome]


def intel_hex(data: bytes, start: int = START) -> str:
    def line(kind: int, address: int, body: bytes) -> str:
        record = bytes([len(body), address >> 8, address & 255, kind]) + body
        return f":{record.hex().upper()}{-sum(record) & 255:02X}"

    lines = [line(4, 0, (start >> 16).to_bytes(2, "big"))]
    lines += [line(0, at, data[at : at + 16]) for at in range(0, len(data), 16)]
    return "\n".join([*lines, line(1, 0, b"")]) + "\n"


def make_images(folder: Path, **how: object) -> Path:
    data = content(**how)  # type: ignore[arg-type]
    folder.mkdir(exist_ok=True)
    path = folder / "image.elf"
    path.write_bytes(elf(data))
    path.with_suffix(".hex").write_text(intel_hex(data))
    path.with_suffix(".bin").write_bytes(data)
    list_them(folder)
    return path


class Bench:
    """A PATH with stand-ins only, and a USB bus of our own."""

    def __init__(self, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        self.programs, self.usb, self.log = folder / "bin", folder / "usb", folder / "log"
        self.programs.mkdir()
        self.usb.mkdir()
        monkeypatch.setenv("PATH", str(self.programs))
        monkeypatch.setattr(usb, "USB_DEVICES", self.usb)

    def program(self, name: str, script: str = "exit 0") -> None:
        path = self.programs / name
        path.write_text(f'#!/bin/sh\nPATH=/usr/bin:/bin\necho "{name} $*" >> "{self.log}"\n{script}\n')
        path.chmod(path.stat().st_mode | stat.S_IXUSR)

    def plug(self, vendor: str, product: str, name: str = "ST-LINK/V2", serial: str = "A1") -> None:
        device = self.usb / f"1-{len(list(self.usb.iterdir()))}"
        device.mkdir()
        for key, value in (
            ("idVendor", vendor),
            ("idProduct", product),
            ("product", name),
            ("serial", serial),
        ):
            (device / key).write_text(value + "\n")

    def ran(self) -> list[str]:
        return self.log.read_text().splitlines() if self.log.exists() else []


@pytest.fixture
def bench(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Bench:
    return Bench(tmp_path, monkeypatch)


@pytest.fixture
def built(tmp_path: Path) -> Path:
    return make_images(tmp_path / "images")


def test_the_three_kinds_hold_the_same(built: Path) -> None:
    images = [read_image(built.with_suffix(kind)) for kind in (".elf", ".hex", ".bin")]
    assert len({image.flat() for image in images}) == 1
    assert all(image.info == ImageInfo("stm32f405", "0.1.0", "0123456789ab", "Release") for image in images)
    assert images[0].start == images[1].start == START and images[0].end == images[1].end


def test_dry_run_says_command_hash_and_target_and_touches_nothing(
    brace: Brace, bench: Bench, built: Path
) -> None:
    bench.program("openocd")
    outcome = brace("flash", built, "--dry-run")
    assert outcome.code == 0 and bench.ran() == []
    assert hashlib.sha256(built.read_bytes()).hexdigest() in outcome.out
    for words in ("openocd -f interface/stlink.cfg -f target/stm32f4x.cfg", "verify reset exit", "STM32F405RG",
                  "0x08000000", "1000 bytes", "dry run: nothing was written",
                  "0.1.0 (0123456789ab, Release)"):  # fmt: skip
        assert words in outcome.out
    told = json.loads(brace("flash", built, "--dry-run", "--json", "--tool", "dfu-util").out)
    assert told["command"][:3] == ["dfu-util", "-d", "0483:df11"] and told["image"].endswith("image.bin")
    assert told["sha256"] == hashlib.sha256(built.with_suffix(".bin").read_bytes()).hexdigest()
    assert told["written"] is False and told["address"] == "0x08000000"
    told = json.loads(
        brace("flash", built.with_suffix(".bin"), "--dry-run", "--json", "--tool", "openocd").out
    )
    assert told["command"][-1].endswith("verify reset exit 0x08000000")


@pytest.mark.parametrize("tool", ["openocd", "st-flash", "dfu-util"])
def test_a_missing_tool_names_its_package(brace: Brace, bench: Bench, built: Path, tool: str) -> None:
    package = {"openocd": "openocd", "st-flash": "stlink-tools", "dfu-util": "dfu-util"}[tool]
    outcome = brace("flash", built, "--tool", tool)
    assert outcome.code == 4 and f"{tool} is not installed" in outcome.err
    assert f"apt-get install {package}" in outcome.err


@pytest.mark.parametrize("tool", [None, "openocd", "st-flash", "dfu-util"])
def test_nothing_plugged_in_is_said_at_once(
    brace: Brace, bench: Bench, built: Path, tool: str | None
) -> None:
    for name in ("openocd", "st-flash", "st-info", "dfu-util"):
        bench.program(name, "sleep 60")
    began = time.monotonic()
    outcome = brace("flash", built, *(("--tool", tool) if tool else ()))
    assert time.monotonic() - began < 30.0  # no program was run: that, below, and not a minute's sleep
    assert outcome.code == 4 and "no probe and no board answer" in outcome.err and "try: " in outcome.err
    assert bench.ran() == []


@pytest.mark.parametrize(
    ("tool", "program", "script"),
    [
        (
            "openocd",
            "openocd",
            "echo 'Info : x'; echo 'Error: init mode failed (unable to connect)' >&2; exit 1",
        ),
        ("openocd", "openocd", "sleep 60"),
        ("st-flash", "st-info", "echo 'Found 0 stlink programmers'"),
        ("dfu-util", "dfu-util", "echo 'dfu-util 0.11'"),
    ],
)
def test_a_board_that_does_not_answer(
    brace: Brace, bench: Bench, built: Path, tool: str, program: str, script: str
) -> None:
    for name in (tool, program):
        bench.program(name, script)
    bench.plug("0483", "df11" if tool == "dfu-util" else "3748")
    began = time.monotonic()
    outcome = brace("flash", built, "--tool", tool)
    assert time.monotonic() - began < 30.0  # 3 s on an idle machine; the program would sleep for a minute
    assert outcome.code == 4 and "no probe and no board answer" in outcome.err
    assert ("unable to connect" in outcome.err) == ("unable" in script)
    assert not any(" write " in line or "program" in line or " -D " in line for line in bench.ran())


@pytest.mark.parametrize(
    ("tool", "product", "written"),
    [
        ("openocd", "3748", "program {"),
        ("st-flash", "374b", "--reset write"),
        ("dfu-util", "df11", ":leave -D"),
    ],
)
def test_writing(brace: Brace, bench: Bench, built: Path, tool: str, product: str, written: str) -> None:
    bench.program(tool, "echo 'Found DFU: [0483:df11]'")
    bench.program("st-info", "echo 'Found 1 stlink programmers'")
    bench.plug("0483", product)
    outcome = brace("flash", built, "--json", *(("--tool", tool) if tool == "st-flash" else ()))
    assert outcome.code == 0, outcome.err
    told = json.loads(outcome.out)
    assert told["written"] is True and told["tool"] == tool
    connected, wrote = bench.ran()
    assert written in wrote and written not in connected


def test_the_write_that_fails_and_the_one_that_hangs(
    brace: Brace, bench: Bench, built: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    bench.plug("0483", "3748")
    bench.program("openocd", "case \"$*\" in *program*) echo 'Error: verify failed'; exit 1;; esac")
    outcome = brace("flash", built)
    assert outcome.code == 4 and "verify failed" in outcome.err and "not known" in outcome.err
    monkeypatch.setattr("brace.flash.programmers.PROGRAM_S", 0.5)
    bench.program("openocd", 'case "$*" in *program*) sleep 60;; esac')
    began = time.monotonic()
    outcome = brace("flash", built)
    assert time.monotonic() - began < 30.0
    assert outcome.code == 4 and "did not come to an end" in outcome.err


def test_several_probes_need_a_name(brace: Brace, bench: Bench, built: Path) -> None:
    bench.program("openocd")
    bench.plug("0483", "3748", serial="A1")
    bench.plug("1366", "0101", name="J-Link", serial="B2")
    outcome = brace("flash", built)
    assert outcome.code == 2 and "2 probes" in outcome.err and "--probe A1" in outcome.err
    assert brace("flash", built, "--probe", "C3").code == 2
    assert brace("flash", built, "--probe", "B2").code == 0
    assert "interface/jlink.cfg" in bench.ran()[-1] and "adapter serial B2" in bench.ran()[-1]
    assert brace("flash", built, "--probe", "B2; shutdown").code == 2
    assert brace("flash", built, "--interface", "ftdi/minimodule").code == 0
    assert "interface/ftdi/minimodule.cfg" in bench.ran()[-1]


def test_images_that_are_not_written(brace: Brace, bench: Bench, tmp_path: Path) -> None:
    def refusal(path: Path, *options: object) -> str:
        outcome = brace("flash", path, "--dry-run", *options)
        assert outcome.code == 3, outcome.err
        assert "why: " in outcome.err and "try: " in outcome.err
        return str(outcome.err)

    good = make_images(tmp_path / "good")
    assert "an image for stm32f405, not for mps2-an386" in refusal(good, "--board", "mps2-an386")
    good.write_bytes(good.read_bytes()[:-1] + b"!")
    assert "is not the file that was built" in refusal(good)
    (good.parent / "SHA256SUMS").write_text("0" * 64 + "  other.elf\n")
    assert "is not listed" in refusal(good)
    (good.parent / "SHA256SUMS").write_text("nonsense\n")
    assert "SHA256SUMS:1" in refusal(good)
    (good.parent / "SHA256SUMS").unlink()
    assert "no SHA256SUMS beside" in refusal(good)
    assert brace("flash", good, "--dry-run", "--unlisted").code == 0

    def made(name: str, data: bytes) -> Path:
        path = tmp_path / name
        path.write_bytes(data)
        return path

    whole = elf(content())
    for cut in (10, 40, 60, 90, len(whole) - 1):
        assert "not whole" in refusal(made("cut.elf", whole[:cut]), "--unlisted")
    assert "not whole" in refusal(made("no.elf", b"hello"), "--unlisted")
    assert "not whole" in refusal(made("empty.bin", b""), "--unlisted")
    text = intel_hex(content())
    assert "not whole" in refusal(made("cut.hex", text[:-20].encode()), "--unlisted")
    assert "no Brace image" in refusal(made("other.elf", elf(bytes(1000))), "--unlisted")
    assert "it lies at" in refusal(made("low.elf", elf(content(), 0x08004000)), "--unlisted")
    assert "it lies at" in refusal(made("big.elf", elf(content(size=768 * 1024 + 4))), "--unlisted")
    assert "could not start" in refusal(made("stack.elf", elf(content(stack=0x30000000))), "--unlisted")
    assert "could not start" in refusal(made("thumb.elf", elf(content(reset=START + 0x100))), "--unlisted")
    assert "could not start" in refusal(made("short.bin", info_block("stm32f405")), "--unlisted")
    assert "no such firmware image" in refusal(tmp_path / "nowhere.elf")
    assert "no kind of image" in refusal(made("image.txt", whole))
    odd = make_images(tmp_path / "a{b}")
    assert "OpenOCD cannot be told this name" in refusal(odd)
    alone = make_images(tmp_path / "alone")
    alone.with_suffix(".bin").unlink()
    assert "image.bin with the same content" in refusal(alone, "--tool", "st-flash")


def test_damaged_lines_of_a_hex_file_are_named(brace: Brace, tmp_path: Path) -> None:
    lines = intel_hex(content()).splitlines()
    for at in (0, 5, len(lines) - 1):
        damaged = list(lines)
        damaged[at] = damaged[at][:-1] + ("0" if damaged[at][-1] != "0" else "1")
        path = tmp_path / "damaged.hex"
        path.write_text("\n".join(damaged) + "\n")
        outcome = brace("flash", path, "--dry-run", "--unlisted")
        assert outcome.code == 3 and f"damaged.hex:{at + 1}: " in outcome.err


def test_emulated_boards_are_started_not_written(brace: Brace, bench: Bench, tmp_path: Path) -> None:
    folder = tmp_path / "emulated"
    folder.mkdir()
    path = folder / "image.elf"
    path.write_bytes(elf(content("netduinoplus2")))
    list_them(folder)
    outcome = brace("flash", path)
    assert (
        outcome.code == 2
        and f"qemu-system-arm -machine netduinoplus2 -nographic -kernel {path}" in outcome.err
    )


def test_changed_sources_are_told(brace: Brace, bench: Bench, tmp_path: Path) -> None:
    path = tmp_path / "image.elf"
    path.write_bytes(elf(content().replace(b"0123456789ab", b"0123456789ab-dirty"[:12]).replace(
        info_block("stm32f405"), info_block("stm32f405", "0123456789ab-dirty"))))  # fmt: skip
    outcome = brace("flash", path, "--dry-run", "--unlisted")
    assert (
        outcome.code == 0
        and "changed and not committed" in outcome.err
        and "0123456789ab-dirty" in outcome.out
    )


@pytest.mark.parametrize(
    ("banner", "code", "words"),
    [
        (b"\r\n# brace 0.1.0 (0123456789ab, Release) on stm32f405\r\n# start: pin\r\n", 0, "running"),
        (b"\r\n# brace 0.0.9 (0123456789ab, Release) on stm32f405\r\n", 7, "the board runs brace 0.0.9"),
        (b"garbage\r\n", 4, "does not say what runs on it"),
    ],
)
def test_the_board_is_asked_what_runs(
    brace: Brace,
    bench: Bench,
    built: Path,
    monkeypatch: pytest.MonkeyPatch,
    banner: bytes,
    code: int,
    words: str,
) -> None:
    monkeypatch.setattr(console, "ANSWER_S", 1.0)
    bench.program("openocd")
    bench.plug("0483", "3748")
    ours, theirs = os.openpty()
    try:

        def answer() -> None:
            if b"banner\r" in os.read(ours, 16):
                os.write(ours, banner)

        threading.Thread(target=answer, daemon=True).start()
        outcome = brace("flash", built, "--port", os.ttyname(theirs))
        assert outcome.code == code, outcome.err
        assert words in outcome.out + outcome.err
    finally:
        os.close(theirs)
        os.close(ours)
