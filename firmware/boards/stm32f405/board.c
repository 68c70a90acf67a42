/* A plain board with an STM32F405. Copy this folder for your board, and write here how yours is wired.
 *
 *   8 MHz crystal       console   USART1  PA9 tx, PA10 rx
 *   CAN1  PB8 rx, PB9 tx  Modbus    USART2  PA2 tx, PA3 rx, PA1 drives the RS-485 transceiver
 *                         SLCAN     USART3  PB10 tx, PB11 rx
 *   parameters: flash sectors 10 and 11, behind the image (memory.ld)
 *
 * Joints are wired differently on every limb, so this board has none. A stm32f405_joints_t in `board` adds them. */
#include "board.h"

#include "brace_hal_stm32f405.h"
#include "fault.h"
#include "kept.h"
#include "stack.h"

static const brace_hal_t *door;

uint32_t board_now_us(void)
{
    return door != 0 ? door->now_us(door->context) : 0u; /* a fault may come before the clock */
}

uint32_t board_core_hz(void)
{
    return stm32f405_clock_report().clocks.core_hz;
}

const char *board_remark(void)
{
    const stm32f405_clock_report_t clock = stm32f405_clock_report();
    if (!clock.pll) {
        return "PLL does not start: 16 MHz, no joints wired";
    }
    return clock.crystal ? "168 MHz by crystal, no joints wired"
                         : "168 MHz without its crystal: CAN listens only, no joints wired";
}

const brace_hal_t *board_start(void)
{
    static stm32f405_board_t board = {
        .name = BRACE_BOARD_NAME,
        .hse_hz = 8000000u,
        .serial = {
            [BRACE_SERIAL_CONSOLE] = {.usart = 1u, .tx = {'A', 9u}, .rx = {'A', 10u}},
            [BRACE_SERIAL_MODBUS] = {.usart = 2u, .tx = {'A', 2u}, .rx = {'A', 3u}, .drive_enable = {'A', 1u}},
            [BRACE_SERIAL_SLCAN] = {.usart = 3u, .tx = {'B', 10u}, .rx = {'B', 11u}},
        },
        .can_rx = {'B', 8u},
        .can_tx = {'B', 9u},
        .nvm_sector = {10u, 11u},
        .watchdog = true,
        .crash_read = kept_crash_read,
        .crash_clear = kept_crash_clear,
        .stack_unused_bytes = stack_unused_bytes,
    };
    board.reset_by_fault = kept_reset_cause(0) == BRACE_RESET_FAULT;
    door = brace_hal_stm32f405(&board);
    return door;
}
