"""Breaks the layer in one place after the other and sees whether the register models notice.

    .venv/bin/python tests/silicon_model/broken_layers.py

Prints one line a break, and the count; exit code 1 when one went unnoticed.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]
BREAKS = [  # file, what stands there, what stands there instead
    ("can.c", "CAN_MCR_TXFP | CAN_MCR_RFLM", "CAN_MCR_RFLM"),
    ("can.c", "CAN_MCR_TXFP | CAN_MCR_RFLM", "CAN_MCR_TXFP"),
    ("can.c", "timing->before - 1u", "timing->before"),
    ("can.c", "timing->after - 1u", "timing->after"),
    ("can.c", "timing->prescaler - 1u", "timing->prescaler"),
    ("can.c", "setup->filter_mask) | CAN_RI0R_IDE | CAN_RI0R_RTR;", "setup->filter_mask) | CAN_RI0R_RTR;"),
    ("can.c", "setup->filter_mask) | CAN_RI0R_IDE | CAN_RI0R_RTR;", "setup->filter_mask) | CAN_RI0R_IDE;"),
    ("can.c", "*can(CAN_FMR) &= ~CAN_FMR_FINIT;", ""),
    ("can.c", "*can(CAN_FMR) |= CAN_FMR_FINIT;", "*can(CAN_FMR) &= ~CAN_FMR_FINIT;"),
    ("can.c", "CAN_BTR_LBKM | CAN_BTR_SILM : setup->listen_only ? CAN_BTR_SILM : 0u",
     "CAN_BTR_LBKM : setup->listen_only ? CAN_BTR_SILM : 0u"),
    ("can.c", ": setup->listen_only ? CAN_BTR_SILM : 0u", ": 0u"),
    ("can.c", "*can(CAN_TSR) = CAN_TSR_ABRQ0 | CAN_TSR_ABRQ1 | CAN_TSR_ABRQ2;", ""),
    ("can.c", "*can(CAN_MCR) |= CAN_MCR_INRQ;", ""),
    ("can.c", "*can(CAN_MCR) &= ~CAN_MCR_INRQ;", ""),
    ("can.c", "if (recovering && (*can(CAN_MSR) & CAN_MSR_INAK) != 0u) {", "if (recovering) {"),
    ("can.c", "FIELD(CAN_RI0R_STID, setup->filter_mask) | ", ""),
    ("can.c", "FIELD(CAN_RI0R_STID, setup->filter_id & setup->filter_mask)", "0u"),
    ("can.c", "    if (waits_for_the_bus()) {\n        return BRACE_HAL_AGAIN;\n    }\n", ""),
    ("can.c", "is_bus_off() || waits_for_the_bus()", "is_bus_off()"),
    ("can.c", "*can(CAN_RF0R) = CAN_RF0R_FOVR0;", ""),
    ("can.c", "    if (take_urgent(frame)) {\n        return 1;\n    }\n", ""),
    ("can.c", " | CAN_FM1R_FBM1", ""),
    ("can.c", " | CAN_FFA1R_FFA1", ""),
    ("can.c", "CAN_FA1R_FACT0 | CAN_FA1R_FACT1 :", "CAN_FA1R_FACT0 :"),
    ("can.c", "    *can(CAN_RF1R) = CAN_RF1R_RFOM1;\n", ""),
    ("can.c", "if (!poll_until(can(CAN_RF0R), CAN_RF0R_RFOM0, 0u, RELEASE_POLLS)) {\n            break;\n        }",
     ""),
    ("can.c", "const uint32_t length = dlc < 8u ? dlc : 8u;", "const uint32_t length = dlc;"),
    ("can.c", ">= (uint32_t)RING_FRAMES", "> (uint32_t)RING_FRAMES"),
    ("can.c", "frame->length = (uint8_t)(stored->id_and_length >> 16);", "frame->length = 8u;"),
    ("can.c", "    *can(CAN_IER) = CAN_IER_FMPIE0 | CAN_IER_FOVIE0;\n", ""),
    ("can.c", "interrupt_enable(CAN1_RX0_IRQ);", ""),
    ("can.c", "REGISTER(RCC_BASE, RCC_APB1ENR) |= RCC_APB1ENR_CAN1EN;", ""),
    ("can.c", "if ((status & mailbox_is_empty[mailbox]) != 0u) {", "if (mailbox == 0u) {"),
    ("can.c", "word(&frame->data[4])", "word(&frame->data[0])"),
    ("can.c", "pin_give(wiring->can_tx, PIN_FUNCTION);", ""),
    ("can_timing.c", "if (quanta - 1u - after > BEFORE_MAX) {", "if (false) {"),
    ("can_timing.c", "(quanta + 4u) / 8u", "quanta / 4u"),
    ("clock.c", "FLASH_WAIT_STATES = 5", "FLASH_WAIT_STATES = 4"),
    ("clock.c", "FIELD(RCC_CFGR_PPRE1, 5)", "FIELD(RCC_CFGR_PPRE1, 4)"),
    ("clock.c", "timer_hz / 1000000u - 1u", "timer_hz / 1000000u"),
    ("clock.c", "REGISTER(TIM2_BASE, TIM2_EGR) = TIM2_EGR_UG;", ""),
    ("clock.c", "(void)switch_to(CLOCK_HSI);\n        change(RCC_CR, RCC_CR_PLLON, 0u);\n        (void)rcc",
     "(void)rcc"),
    ("clock.c", "source_mhz % 2u == 0u ? source_mhz / 2u : source_mhz", "source_mhz / 2u"),
    ("clock.c", "            change(RCC_CR, RCC_CR_CSSON, RCC_CR_CSSON);", "            "),
    ("clock.c", "    report.crystal_was_lost = true;\n", ""),
    ("clock.c", "    change(RCC_CR, RCC_CR_PLLON, 0u); /* its", "    /* its"),
    ("crystal.c", "    REGISTER(RCC_BASE, RCC_CIR) |= RCC_CIR_CSSC;", "   "),
    ("crystal.c", "    can_leave_bus();\n", ""),
    ("crystal.c", "        processor_restart(0);", "       "),
    ("can.c", "    if (stopped) {\n        return BRACE_HAL_E_DEVICE;\n    }\n", ""),
    ("can.c", "return stopped || recovering", "return recovering"),
    ("can.c", "    stopped = false;\n", ""),
    ("can.c", "    if (!silent) {\n        stopped", "    {\n        stopped"),
    ("can.c", "    if (stopped) {\n        restart_controller();\n    }\n", ""),
    ("can.c", "    if (!clock_report()->crystal && !silent) {", "    if (false) {"),
    ("supply.c", "DETECTOR_2_9_V = 7,", "DETECTOR_2_9_V = 5,"),
    ("supply.c", "BROWN_OUT_LEVEL_3 = 0,", "BROWN_OUT_LEVEL_3 = 1,"),
    ("supply.c", "    *flash(FLASH_OPTKEYR) = FLASH_OPTKEYR_KEY1;\n", ""),
    ("supply.c", "    *flash(FLASH_OPTCR) |= FLASH_OPTCR_OPTLOCK;\n", ""),
    ("supply.c", "    REGISTER(RCC_BASE, RCC_APB1ENR) |= RCC_APB1ENR_PWREN;\n", ""),
    ("supply.c", "    if (!supply_is_low()) {", "    if (true) {"),
    ("flash_program.c", "supply_is_low() || ", ""),
    ("flash_program.c", "*flash(FLASH_KEYR) = FLASH_KEYR_KEY1;", ""),
    ("flash_program.c", "*flash(FLASH_SR) = ERRORS | FLASH_SR_EOP; /* an old", "/* an old"),
    ("flash_program.c", "PARALLEL_32 = 2,", "PARALLEL_32 = 1,"),
    ("flash_program.c", "    forget_caches();\n    return", "    return"),
    ("flash_program.c", "    *flash(FLASH_ACR) = off;\n    *flash(FLASH_ACR) = off | FLASH_ACR_DCRST",
     "    *flash(FLASH_ACR) = access | FLASH_ACR_DCRST"),
    ("flash_program.c", "    lock();\n    forget_caches();", "    forget_caches();"),
    ("flash_program.c", "watchdog_feed(0); /* the", "/* the"),
    ("flash_program.c", "i < count && sound;", "i < count;"),
    ("flash_program.c", "sound = finishes_within(PROGRAM_US) && (*flash(FLASH_SR) & ERRORS) == 0u;", "sound = true;"),
    ("flash_slots.c", "        serial_finish(FINISH_US);\n", ""),
    ("flash_slots.c", "        servo_line_finish(FINISH_US);\n", ""),
    ("flash_slots.c", "offset <= slot_bytes && count <= slot_bytes - offset", "offset + count <= slot_bytes"),
    ("board_key.c", "(byte ^ complement) == UINT8_MAX", "byte != UINT8_MAX"),
    ("board_key.c", "if (first_with_key() < (uint32_t)BLOCK_COUNT) {", "if (false) {"),
    ("board_key.c", "= first_usable();", "= first_with_key();"),
    ("board_key.c", "if (number == (uint32_t)BLOCK_COUNT) {\n        return BRACE_HAL_E_DEVICE;", "if (false) {\n        return 0;"),
    ("board_key.c", "flash_program_byte(LOCKS_START + number, LOCKED) == BRACE_HAL_OK;", "true;"),
    ("board_key.c", "is_safe = is_safe && spoil(before);", ""),
    ("board_key.c", "!was_key(number)) {\n        number++;", "true) {\n        number++;"),
    ("board_key.c", "        (void)lock_key(number);\n", ""),
    ("board_key.c", "is_new() ? BRACE_HAL_KEY_NONE : BRACE_HAL_E_DAMAGED", "BRACE_HAL_KEY_NONE"),
    ("board_key.c", "lock_key(number) ? BRACE_HAL_OK : BRACE_HAL_AGAIN", "(lock_key(number), BRACE_HAL_OK)"),
    ("board_key.c", "(is_locked(number) || !is_blank(number))", "!is_blank(number)"),
    ("flash_program.c", "PARALLEL_8 = 0,", "PARALLEL_8 = 2,"),
    ("random.c", "REGISTER(RCC_BASE, RCC_AHB2ENR) |= RCC_AHB2ENR_RNGEN;", ""),
    ("random.c", "    if (!has_last) {\n        has_last = take_word(&last_word);\n    }\n", "    has_last = true;\n"),
    ("random.c", " || next == last_word", ""),
    ("random.c", "RNG_SR_SEIS | ", ""),
    ("random.c", "*generator(RNG_SR) = 0u;", ""),
    ("random.c", "    *generator(RNG_CR) = 0u;\n", ""),
    ("watchdog.c", "REGISTER(IWDG_BASE, IWDG_KR) = IWDG_KR_ACCESS_KEY;", ""),
    ("watchdog.c", "(lsi_hz != 0u ? lsi_hz : (uint32_t)LSI_NOMINAL_HZ)", "(uint32_t)LSI_NOMINAL_HZ"),
    ("lsi.c", "EVERY_EIGHTH = 3", "EVERY_EIGHTH = 2"),
    ("lsi.c", "FIELD(TIM5_OR_IT4_RMP, LSI_TO_CHANNEL_4)", "0u"),
    ("watchdog.c", "(void)poll_until(&REGISTER(IWDG_BASE, IWDG_SR), IWDG_SR_PVU | IWDG_SR_RVU, 0u, UPDATE_POLLS);", ""),
    ("watchdog.c", "flags | RCC_CSR_RMVF", "flags"),
    ("serial.c", "(REGISTER(base, USART_CR1) & ~USART_CR1_TXEIE) | USART_CR1_TCIE",
     "REGISTER(base, USART_CR1) & ~USART_CR1_TXEIE"),
    ("serial.c", "set_switch(usart->drive_enable, usart->drive_enable.high);", ""),
    ("serial.c", "plain | USART_CR1_M | USART_CR1_PCE", "plain | USART_CR1_PCE"),
    ("serial.c", "(status & (USART_SR_PE | USART_SR_FE)) == 0u", "(status & USART_SR_PE) == 0u"),
    ("serial.c", "(USART_SR_RXNE | USART_SR_ORE)", "USART_SR_RXNE"),
    ("serial.c", "place->base == USART1_BASE ? clocks->apb2_hz : clocks->apb1_hz", "clocks->apb1_hz"),
    ("byte_ring.h", ">= (uint32_t)BYTE_RING_BYTES", "> (uint32_t)BYTE_RING_BYTES"),
    ("pins.c", "pin.number < 8u ? GPIO_AFRL : GPIO_AFRH", "GPIO_AFRL"),
]


def is_noticed(file: str, old: str, new: str) -> bool | None:
    """None: the text to break is not there (any more)."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for part in ("hal", "tests/silicon_model"):
            shutil.copytree(PROJECT / part, folder / part, ignore=shutil.ignore_patterns("__pycache__"))
        source = folder / "hal" / "stm32f405" / "src" / file
        text = source.read_text()
        if old not in text:
            return None
        source.write_text(text.replace(old, new))
        tests = folder / "tests" / "silicon_model"
        command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", str(tests)]
        try:
            run = subprocess.run(
                [*command, "--ignore", str(tests / "test_registers.py")], capture_output=True, timeout=150, check=False
            )
            return run.returncode != 0
        except subprocess.TimeoutExpired:
            return True  # the tests take 5-20 s


def main() -> int:
    unnoticed = 0
    for file, old, new in BREAKS:
        noticed = is_noticed(file, old, new)
        word = {True: "noticed", False: "UNNOTICED", None: "NOT THERE"}[noticed]
        unnoticed += noticed is not True
        print(f"{word:10} {file}: {' '.join(old.split())[:60]} -> {' '.join(new.split())[:40]}", flush=True)
    print(f"{len(BREAKS) - unnoticed} of {len(BREAKS)} noticed")
    return 1 if unnoticed else 0


if __name__ == "__main__":
    sys.exit(main())
