/* A plain board with an STM32F405. Copy this folder for your board, and write here how yours is wired.
 *
 *   8 MHz crystal       console   USART1  PA9 tx, PA10 rx
 *   CAN1  PB8 rx, PB9 tx  Modbus    USART2  PA2 tx, PA3 rx, PA1 drives the RS-485 transceiver
 *                         SLCAN     USART3  PB10 tx, PB11 rx
 *   parameters: flash sectors 10 and 11, behind the image (memory.ld)
 *
 *                         servos    USART6  PC6 tx, PC7 rx, PC8 drives the half-duplex line
 *
 * Joints are wired differently on every limb; these are three Dynamixel servos. Another stm32f405_joints_t in `board`
 * stands for other drives. */
#include "board.h"

#include <stddef.h>

#include "board_servos.h"
#include "brace_hal_stm32f405.h"
#include "fault.h"
#include "kept.h"
#include "stack.h"

static brace_hal_t door;

/* The paper's limb: three MX-106. Ids, senses and zeros are those of its assembly; docs/joints.md sets them up. */
static const brace_servo_setup_t servos = {
    .joint = {{.id = 11u, .torque_ratio = 1.0f}, {.id = 12u, .torque_ratio = 1.0f}, {.id = 13u, .torque_ratio = 1.0f}},
    .period_us = 500u,
    .timeout_us = 700u,
    .holds = true,
};

/* What no parameter passes: an MX-106's stall torque at 14.8 V, a turn, and 1 rad/s of what take-ups and loading tests
 * add to a set-point. */
static const brace_hal_ceiling_t ceilings[BRACE_SERVO_JOINTS] = {
    {.torque_most_n_mm = 10000.0f, .angle_least_rad = -3.2f, .angle_most_rad = 3.2f, .speed_most_rad_per_s = 1.0f},
    {.torque_most_n_mm = 10000.0f, .angle_least_rad = -3.2f, .angle_most_rad = 3.2f, .speed_most_rad_per_s = 1.0f},
    {.torque_most_n_mm = 10000.0f, .angle_least_rad = -3.2f, .angle_most_rad = 3.2f, .speed_most_rad_per_s = 1.0f},
};

uint32_t board_now_us(void)
{
    return door.now_us != NULL ? door.now_us(door.context) : 0u; /* a fault may come before the clock */
}

uint32_t board_core_hz(void)
{
    return stm32f405_clock_report().clocks.core_hz;
}

const char *board_remark(void)
{
    const stm32f405_clock_report_t clock = stm32f405_clock_report();
    if (!clock.pll) {
        return "PLL does not start: 16 MHz, too slow for the joints";
    }
    if (clock.crystal_was_lost) {
        return "crystal lost: 168 MHz without it; CAN is off until a restart";
    }
    return clock.crystal ? "168 MHz by crystal; servos 11 12 13 on USART6"
                         : "168 MHz without its crystal: CAN listens only; servos 11 12 13 on USART6";
}

void board_serve(void)
{
    servo_joints_serve(board_now_us());
}

void board_rest(uint32_t at_most_us)
{
    (void)at_most_us; /* nobody has measured on the chip what sleep does to the ticks, and nothing here saves power */
}

const brace_hal_t *board_start(void)
{
    static const stm32f405_joints_t joints = {.read = servo_joints_read, .command = servo_joints_command};
    static const stm32f405_servo_line_t wires = {
        .tx = {'C', 6u}, .rx = {'C', 7u}, .drive_enable = {'C', 8u}, .baud = 3000000u};
    static const brace_servo_line_t line = {.send = stm32f405_servo_send, .receive = stm32f405_servo_receive};
    static stm32f405_board_t board = {
        .name = BRACE_BOARD_NAME,
        .hse_hz = 8000000u,
        .serial =
            {
                [BRACE_SERIAL_CONSOLE] = {.usart = 1u, .tx = {'A', 9u}, .rx = {'A', 10u}},
                [BRACE_SERIAL_MODBUS] = {.usart = 2u, .tx = {'A', 2u}, .rx = {'A', 3u}, .drive_enable = {'A', 1u}},
                [BRACE_SERIAL_SLCAN] = {.usart = 3u, .tx = {'B', 10u}, .rx = {'B', 11u}},
            },
        .can_rx = {'B', 8u},
        .can_tx = {'B', 9u},
        .nvm_sector = {10u, 11u},
        .guards_supply = true,
        .keeps_key = true,
        .watchdog = true,
        .joints = &joints,
        .crash_read = kept_crash_read,
        .crash_clear = kept_crash_clear,
        .stack_unused_bytes = stack_unused_bytes,
    };
    board.reset_by_fault = kept_reset_cause(0) == BRACE_RESET_FAULT;
    door = *brace_hal_stm32f405(&board);
    door.ceiling = ceilings;
    const bool has_line = stm32f405_servo_line(&wires) == BRACE_HAL_OK; /* not at 16 MHz, when the PLL does not start */
    if (!has_line || !servo_joints_start(&servos, &line)) {
        door.joint_command = NULL;
    }
    return &door;
}
