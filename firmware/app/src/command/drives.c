#include "command/drives.h"

#include <stddef.h>

#define REFUSED_US 50000u /* a drive that starts anew may refuse for a while */
#define BACK_RAD_PER_S 0.1f /* what a drive is behind is made up for as slowly as a drive's own way back: brace_hal.h */

static brace_hal_joint_command_t command_of(const flank_joint_t *flank, const drives_test_t *test, int index)
{
    brace_hal_joint_command_t command = {flank->out.command_rad, __builtin_inff()};
    if (test->runs) {
        command.offset_rad += test->offset_rad[index];
        command.torque_limit_n_mm = test->torque_limit_n_mm[index];
    }
    if (flank->out.limit_torque && flank->watched) {
        const float most_n_mm = flank->machine.params.takeup.torque_max_n_mm;
        command.torque_limit_n_mm = most_n_mm < command.torque_limit_n_mm ? most_n_mm : command.torque_limit_n_mm;
    }
    return command;
}

/* How far a set-point may go in this tick [rad]. */
static float way_rad(const brace_hal_ceiling_t *ceiling, bool is_behind, uint32_t tick_us)
{
    const float board_rad_per_s = ceiling != NULL ? ceiling->speed_most_rad_per_s : __builtin_inff();
    const float most_rad_per_s = is_behind && BACK_RAD_PER_S < board_rad_per_s ? BACK_RAD_PER_S : board_rad_per_s;
    return most_rad_per_s * 1e-6f * (float)tick_us;
}

/* Cuts a command to what the board allows. Returns true if the command's offset is left whole. */
static bool limit(const brace_hal_ceiling_t *ceiling, float before_rad, float way, brace_hal_joint_command_t *command)
{
    const float asked_rad = command->offset_rad;
    command->offset_rad = asked_rad > before_rad + way   ? before_rad + way
                          : asked_rad < before_rad - way ? before_rad - way
                                                         : asked_rad;
    if (ceiling != NULL && command->torque_limit_n_mm > ceiling->torque_most_n_mm) {
        command->torque_limit_n_mm = ceiling->torque_most_n_mm;
    }
    return command->offset_rad == asked_rad;
}

void drives_start(drives_t *drives)
{
    *drives = (drives_t){.are_commanded = false};
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        drives->limit_n_mm[i] = __builtin_inff();
    }
}

void drives_command(drives_t *drives, const brace_hal_t *hal, const joints_t *joints, const flank_t *flank,
                    bool takes_up, const drives_test_t *test, bool stands, uint32_t tick_us, uint32_t *commands_failed)
{
    const bool moves = takes_up || test->runs;
    bool refuse = false, is_back = true;
    if (hal->joint_command == NULL || !(moves || drives->are_commanded)) {
        drives->refused_us = 0;
        return;
    }
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        if (joints->joint[i].fitted) {
            const brace_hal_ceiling_t *ceiling = hal->ceiling != NULL ? &hal->ceiling[i] : NULL;
            brace_hal_joint_command_t command = command_of(&flank->joint[i], test, i);
            const float asked_rad = command.offset_rad;
            const float way = stands ? 0.0f : way_rad(ceiling, !moves || drives->is_behind[i], tick_us);
            const bool is_there = limit(ceiling, drives->commanded_offset_rad[i], way, &command);
            if (!moves && is_there) {
                command.torque_limit_n_mm = __builtin_inff(); /* nothing is added: the drive's own limit holds again */
            }
            const bool is_commanded = hal->joint_command(hal->context, i, &command) == BRACE_HAL_OK;
            if (is_commanded) {
                drives->commanded_offset_rad[i] = command.offset_rad;
                drives->limit_n_mm[i] = command.torque_limit_n_mm;
                is_back = is_back && is_there;
            } else { /* it holds the last command, and goes back by itself when no command comes */
                brace_count(commands_failed);
                drives->commanded_offset_rad[i] = moves ? drives->commanded_offset_rad[i] : 0.0f;
                refuse = true;
            }
            drives->is_behind[i] =
                drives->commanded_offset_rad[i] != asked_rad && (stands || !is_commanded || drives->is_behind[i]);
        }
    }
    drives->is_going_back = !moves && !is_back;
    drives->are_commanded = moves || drives->is_going_back;
    drives->refused_us = refuse ? drives->refused_us + tick_us : 0u;
}

bool drives_refuse(const drives_t *drives)
{
    return drives->refused_us >= REFUSED_US;
}
