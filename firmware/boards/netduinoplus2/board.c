/* The Netduino Plus 2 as emulators have it: an STM32F405 with USARTs and timers, without clock control, CAN, flash
 * controller and watchdog. The driver is that of the real chip; other parts stand in for what the emulator lacks. */
#include "board.h"

#include <stddef.h>

#include "board_servos.h"
#include "brace_hal_stm32f405.h"
#include "fault.h"
#include "kept.h"
#include "kept_nvm.h"
#include "rest.h"
#include "stack.h"
#include "stand_in_joints.h"

static brace_hal_t door;

#if defined(BRACE_HAS_SERVOS) /* Dynamixel servos at the emulator's sixth serial port */
static const bool has_servos = true;
#else
static const bool has_servos = false;
#endif

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
    return has_servos ? "emulated; servos 12 13 on USART6, non-volatile memory is RAM, no CAN, no watchdog"
                      : "emulated; joints stand in, non-volatile memory is RAM, no CAN, no watchdog";
}

static int32_t joint_read(void *context, int32_t joint_index, brace_hal_joint_t *joint)
{
    if (has_servos) {
        return servo_joints_read(context, joint_index, joint);
    }
    return stand_in_joint(joint_index, board_now_us(), joint);
}

void board_serve(void)
{
    if (has_servos) {
        servo_joints_serve(board_now_us());
    }
}

void board_rest(uint32_t at_most_us)
{
    if (!has_servos) { /* their line is polled */
        rest_sleep(at_most_us);
    }
}

static void start_servos(void)
{
    static const stm32f405_servo_line_t wires = {.baud = 3000000u, .is_polled = true};
    static const brace_servo_line_t line = {.send = stm32f405_servo_send, .receive = stm32f405_servo_receive};
    static const brace_servo_setup_t servos = {
        .joint = {{.id = BRACE_SERVO_NO_ID}, {.id = 12u, .torque_ratio = 1.0f}, {.id = 13u, .torque_ratio = 1.0f}},
        .period_us = 1000u,
        .timeout_us = 30000u, /* of the emulator's clock, which does not wait for the host */
        .holds = true,
    };
    if (stm32f405_servo_line(&wires) == BRACE_HAL_OK) {
        (void)servo_joints_start(&servos, &line);
    }
}

const brace_hal_t *board_start(void)
{
    /* The emulator's own rates; it ignores the registers that set them. */
    static const stm32f405_clocks_t clocks = {
        .core_hz = 168000000u, .apb1_hz = 42000000u, .apb2_hz = 84000000u, .timer_hz = 1000000000u};
    static const stm32f405_joints_t joints = {.read = joint_read, .command = has_servos ? servo_joints_command : 0};
    static stm32f405_board_t board = {
        .name = BRACE_BOARD_NAME,
        .clocks_given = &clocks,
        .serial =
            {
                [BRACE_SERIAL_CONSOLE] = {.usart = 1u, .tx = {'A', 9u}, .rx = {'A', 10u}},
                [BRACE_SERIAL_MODBUS] = {.usart = 2u, .tx = {'A', 2u}, .rx = {'A', 3u}},
                [BRACE_SERIAL_SLCAN] = {.usart = 3u, .tx = {'B', 10u}, .rx = {'B', 11u}},
            },
        .joints = &joints,
        .crash_read = kept_crash_read,
        .crash_clear = kept_crash_clear,
        .stack_unused_bytes = stack_unused_bytes,
    };
    board.nvm_ram = kept_nvm_start(BRACE_NVM_SLOT_COUNT * STM32F405_NVM_RAM_SLOT_BYTES);
    door = *brace_hal_stm32f405(&board);
    if (has_servos) {
        start_servos();
    }
    rest_start(&door, board_core_hz());
    door.reset_cause = kept_reset_cause; /* the emulated chip keeps no reset flags */
    door.restart = kept_restart;
    return &door;
}
