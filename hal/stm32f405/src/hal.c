/* The door: puts the parts of this layer together. */
#include "brace_hal_stm32f405.h"

#include "board_key.h"
#include "can.h"
#include "clock.h"
#include "flash_slots.h"
#include "pins.h"
#include "random.h"
#include "serial.h"
#include "supply.h"
#include "watchdog.h"

static brace_hal_t door;
static const stm32f405_joints_t *joints;

static uint32_t now_us(void *context)
{
    (void)context;
    return clock_now_us();
}

static int32_t joint_read(void *context, int32_t joint_index, brace_hal_joint_t *joint)
{
    (void)context;
    if (joints == 0 || joints->read == 0) {
        return BRACE_HAL_E_UNSUPPORTED;
    }
    return joints->read(joints->context, joint_index, joint);
}

static int32_t joint_command(void *context, int32_t joint_index, const brace_hal_joint_command_t *command)
{
    (void)context;
    return joints->command(joints->context, joint_index, command);
}

static int32_t tip_force_read(void *context, float *force_x_n, float *force_z_n)
{
    (void)context;
    return joints->tip_force_read(joints->context, force_x_n, force_z_n);
}

static int32_t no_crash(void *context, brace_crash_record_t *record)
{
    (void)context;
    (void)record;
    return 0;
}

static void nothing_to_clear(void *context)
{
    (void)context;
}

static uint32_t stack_not_known(void *context)
{
    (void)context;
    return 0u;
}

static void fill_door(const stm32f405_board_t *board)
{
    door.context = 0;
    door.board = board->name;
    door.now_us = now_us;

    joints = board->joints;
    door.joint_read = joint_read;
    door.joint_command = joints != 0 && joints->command != 0 ? joint_command : 0;
    door.tip_force_read = joints != 0 && joints->tip_force_read != 0 ? tip_force_read : 0;

    door.nvm_shape = flash_slots_shape();
    door.nvm_read = flash_slots_read;
    door.nvm_write = flash_slots_write;
    door.nvm_erase = flash_slots_erase;

    const bool has_can = pin_is_connected(board->can_rx) && pin_is_connected(board->can_tx);
    door.can_setup = has_can ? can_setup : 0;
    door.can_send = has_can ? can_send : 0;
    door.can_receive = has_can ? can_receive : 0;
    door.can_health = has_can ? can_health : 0;
    door.can_recover = has_can ? can_recover : 0;

    door.serial_setup = serial_setup;
    door.serial_write = serial_write;
    door.serial_read = serial_read;

    door.key_read = board->keeps_key ? board_key_read : 0;
    door.key_write = board->keeps_key ? board_key_write : 0;
    door.random_read = board->keeps_key ? random_read : 0;

    door.watchdog_feed = watchdog_feed;
    door.reset_cause = reset_cause_read;
    door.crash_read = board->crash_read != 0 ? board->crash_read : no_crash;
    door.crash_clear = board->crash_clear != 0 ? board->crash_clear : nothing_to_clear;
    door.stack_unused_bytes = board->stack_unused_bytes != 0 ? board->stack_unused_bytes : stack_not_known;
    door.restart = processor_restart;
}

const brace_hal_t *brace_hal_stm32f405(const stm32f405_board_t *board)
{
    reset_cause_take(board->reset_by_fault);
    clock_start(board->hse_hz, board->clocks_given);
    if (board->guards_supply) {
        supply_start();
    }
    if (board->keeps_key) {
        random_start();
        board_key_start();
    }
    if (board->watchdog) {
        watchdog_start(clock_report()->clocks.timer_hz);
    }
    serial_use(board);
    can_use(board);
    flash_slots_use(board);
    fill_door(board);
    return &door;
}
