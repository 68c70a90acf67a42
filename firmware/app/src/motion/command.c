#include "motion/command.h"

#include "measure/loading.h"
#include "motion/takeup.h"

void command_send(brace_app_t *app, const brace_snapshot_t *snapshot)
{
    const brace_loading_t *test = &app->loading;
    const bool testing = test->phase != LOADING_IDLE;
    const bool moves = testing || takeup_active(app);
    if (app->hal->joint_command == NULL || !(moves || app->told)) {
        return;
    }
    for (int i = 0; i < BRACE_APP_JOINTS; i++) {
        const brace_backlash_out_t *play = &snapshot->play[BRACE_FEMUR + i];
        brace_hal_joint_command_t command = {play->command_rad, __builtin_inff()};
        if (testing) {
            command.offset_rad += loading_offset(test, i);
            command.torque_limit_n_mm = test->torque_max_n_mm[i];
        }
        if (play->limit_torque && app->play[i].watched) {
            const float most_n_mm = app->play[i].backlash.params.takeup.torque_max_n_mm;
            command.torque_limit_n_mm =
                most_n_mm < command.torque_limit_n_mm ? most_n_mm : command.torque_limit_n_mm;
        }
        if (app->hal->joint_command(app->hal->context, BRACE_FEMUR + i, &command) != BRACE_HAL_OK) {
            app->counters.commands_failed += app->counters.commands_failed < UINT32_MAX;
        }
    }
    app->told = moves;
}
