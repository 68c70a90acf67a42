"""Every macro of the STM32F405 layer's register header against the chip's SVD file.

The names come from the preprocessor, the values from the compiler, so no macro escapes and none is read by a pattern.
"""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

import svd

PROJECT = Path(__file__).resolve().parents[2]
HEADER = PROJECT / "hal" / "stm32f405" / "src" / "stm32f405_registers.h"

# What the SVD calls the owner of a group of registers, or one of several that are alike.
OWNER = {"CAN": "CAN1", "GPIO": "GPIOA", "USART": "USART1"}

# Keys are values, which an SVD does not hold. RM0090: 3.6.1 (flash), 21.4.1 (watchdog); PM0214: 4.4.5 (AIRCR).
KEYS = {
    "FLASH_KEYR_KEY1": 0x45670123,
    "FLASH_KEYR_KEY2": 0xCDEF89AB,
    "FLASH_OPTKEYR_KEY1": 0x08192A3B,
    "FLASH_OPTKEYR_KEY2": 0x4C5D6E7F,
    "IWDG_KR_ACCESS_KEY": 0x5555,
    "IWDG_KR_RELOAD_KEY": 0xAAAA,
    "IWDG_KR_START_KEY": 0xCCCC,
    "SCB_AIRCR_VECTKEY_KEY": 0x05FA,
}
SCB_BASE = 0xE000ED00  # PM0214, table 46; the other chip's file counts from 0xe000e000


@pytest.fixture(scope="module")
def chip() -> svd.Chip:
    fetched = subprocess.run([PROJECT / "tests/fetch/svd"], capture_output=True, text=True, timeout=300, check=False)
    if fetched.returncode != 0:
        pytest.fail(f"the chip's SVD file can not be had: {fetched.stderr.strip()}")
    folder = Path(fetched.stdout.strip())
    chip = svd.read(folder / "STM32F41x.svd")  # STM32F405, 407, 415, 417: manual RM0090
    core = svd.read(folder / "MK64F12.svd").peripherals["SystemControl"]  # the same Cortex-M4; ST's file has no SCB
    registers = {
        name: svd.Register(core.base + register.offset - SCB_BASE, register.fields)
        for name, register in core.registers.items()
    }
    chip.peripherals["SCB"] = svd.Peripheral(SCB_BASE, registers)
    return chip


@pytest.fixture(scope="module")
def header(tmp_path_factory: pytest.TempPathFactory) -> dict[str, int]:
    """Macro -> value, both by the compiler."""
    listing = subprocess.run(
        ["gcc", "-E", "-dM", "-undef", "-ffreestanding", HEADER], check=True, capture_output=True, text=True
    ).stdout.splitlines()
    names = [line.split()[1] for line in listing]
    own = [name for name in names if name in HEADER.read_text() and "(" not in name and not name.endswith("_H")]
    folder = tmp_path_factory.mktemp("registers")
    lines = "\n".join(f'    printf("{name} %lu\\n", (unsigned long)({name}));' for name in own)
    source = folder / "print.c"
    source.write_text(f'#include <stdio.h>\n#include "{HEADER}"\nint main(void)\n{{\n{lines}\n}}\n')
    subprocess.run(["gcc", source, "-o", folder / "print"], check=True)
    printed = subprocess.run([folder / "print"], check=True, capture_output=True, text=True).stdout
    return {name: int(value) for name, value in map(str.split, printed.splitlines())}


def wanted(name: str, chip: svd.Chip) -> int:
    """What the SVD says a macro should be; KeyError: it knows no such thing."""
    if name in KEYS:
        return KEYS[name]
    if name.endswith("_IRQ"):
        return chip.interrupts[name]
    group, rest = name.split("_", 1)
    peripheral = chip.peripherals[OWNER.get(group, group)]
    if rest == "BASE":
        return peripheral.base
    if rest in peripheral.registers:
        return peripheral.registers[rest].offset
    owner = max((known for known in peripheral.registers if rest.startswith(known + "_")), key=len, default="")
    return peripheral.registers[owner].fields[rest[len(owner) + 1 :]]


def wrong(header: dict[str, int], chip: svd.Chip) -> list[str]:
    faults = []
    for name, value in header.items():
        try:
            right = wanted(name, chip)
        except KeyError:
            faults.append(f"{name}: the SVD knows no such register or field")
            continue
        if value != right:
            faults.append(f"{name} is 0x{value:x}, the SVD says 0x{right:x}")
    return faults


def test_every_macro_is_what_the_svd_says(header: dict[str, int], chip: svd.Chip) -> None:
    assert len(header) > 100
    assert wrong(header, chip) == []


def test_any_wrong_value_is_seen(header: dict[str, int], chip: svd.Chip) -> None:
    for name, value in header.items():
        for other in (value + 4, value ^ 1, (value << 1) & 0xFFFFFFFF or 1):
            assert wrong({**header, name: other}, chip) != [], name
    assert wrong({**header, "CAN_MCR_NONSENSE": 1}, chip) != []


def test_ports_of_pins_follow_each_other(chip: svd.Chip, header: dict[str, int]) -> None:
    """pins.c counts ports and their clock bits from A on."""
    step = header["GPIOB_BASE"] - header["GPIOA_BASE"]
    enables = chip.peripherals["RCC"].registers["AHB1ENR"].fields
    for index, letter in enumerate("ABCDEFGHI"):
        assert chip.peripherals[f"GPIO{letter}"].base == header["GPIOA_BASE"] + index * step
        assert enables[f"GPIO{letter}EN"] == header["RCC_AHB1ENR_GPIOAEN"] << index


def test_mailboxes_follow_each_other(chip: svd.Chip, header: dict[str, int]) -> None:
    """can.c counts mailboxes from 0 on."""
    step = header["CAN_TI1R"] - header["CAN_TI0R"]
    registers = chip.peripherals["CAN1"].registers
    for mailbox in range(3):
        for kind in ("TI{}R", "TDT{}R", "TDL{}R", "TDH{}R"):
            assert registers[kind.format(mailbox)].offset == registers[kind.format(0)].offset + mailbox * step


def test_interrupt_words_follow_each_other(chip: svd.Chip) -> None:
    """interrupts.h has one bit an interrupt, 32 a word."""
    for kind, first in (("ISER", 0x100), ("ISPR", 0x200)):
        for word in range(2):
            assert chip.peripherals["NVIC"].registers[f"{kind}{word}"].offset == first + 4 * word
