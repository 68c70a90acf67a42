#include "command/drives.h"

#include <stddef.h>

#define REFUSED_US 50000u /* a drive that starts anew may refuse for a while */

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

/* Within what the board allows, whatever the parameters say. */
static void limit(const drives_t *drives, const brace_hal_ceiling_t *ceiling, uint32_t tick_us, int index,
                  brace_hal_joint_command_t *command)
{
    const float way_rad = ceiling[index].speed_most_rad_per_s * 1e-6f * (float)tick_us;
    const float before_rad = drives->told_rad[index], offset_rad = command->offset_rad;
    command->offset_rad = offset_rad > before_rad + way_rad   ? before_rad + way_rad
                          : offset_rad < before_rad - way_rad ? before_rad - way_rad
                                                              : offset_rad;
    if (command->torque_limit_n_mm > ceiling[index].torque_most_n_mm) {
        command->torque_limit_n_mm = ceiling[index].torque_most_n_mm;
    }
}

void drives_start(drives_t *drives)
{
    *drives = (drives_t){.are_commanded = false};
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        drives->limit_n_mm[i] = __builtin_inff();
    }
}

void drives_command(drives_t *drives, const brace_hal_t *hal, const joints_t *joints, const flank_t *flank,
                    bool takes_up, const drives_test_t *test, uint32_t tick_us, uint32_t *commands_failed)
{
    const bool moves = takes_up || test->runs;
    bool refuse = false;
    if (hal->joint_command == NULL || !(moves || drives->are_commanded)) {
        drives->refused_us = 0;
        return;
    }
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        if (joints->joint[i].fitted) {
            brace_hal_joint_command_t command = command_of(&flank->joint[i], test, i);
            if (hal->ceiling != NULL && moves) {
                limit(drives, hal->ceiling, tick_us, i, &command);
            }
            drives->told_rad[i] = command.offset_rad;
            drives->limit_n_mm[i] = command.torque_limit_n_mm;
            if (hal->joint_command(hal->context, i, &command) != BRACE_HAL_OK) {
                brace_count(commands_failed);
                refuse = true;
            }
        }
    }
    drives->are_commanded = moves;
    drives->refused_us = refuse ? drives->refused_us + tick_us : 0u;
}

bool drives_refuse(const drives_t *drives)
{
    return drives->refused_us >= REFUSED_US;
}
