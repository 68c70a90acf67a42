#include "motion/takeup.h"

static brace_app_play_t *play_of(brace_app_t *app, uint8_t joint_index)
{
    return &app->play[joint_index - BRACE_FEMUR];
}

brace_status_t takeup_request(brace_app_t *app, int32_t joint_index, int32_t flank)
{
    brace_app_takeup_t *takeup = &app->takeup;
    if ((joint_index != BRACE_FEMUR && joint_index != BRACE_TIBIA) || (flank != 1 && flank != -1)) {
        return BRACE_E_RANGE;
    }
    if (app->hal->joint_command == NULL || !play_of(app, (uint8_t)joint_index)->watched) {
        return BRACE_E_UNSUPPORTED;
    }
    if (takeup->letting_go) {
        return BRACE_E_MODE;
    }
    for (uint8_t i = 0; i < takeup->count; i++) {
        if (takeup->order[i] == joint_index) {
            return BRACE_E_RANGE;
        }
        if (play_of(app, takeup->order[i])->backlash.phase != BRACE_TAKEUP_HOLD) {
            return BRACE_E_MODE; /* one at a time: the second leans on the first */
        }
    }
    const brace_status_t status = brace_takeup_request(&play_of(app, (uint8_t)joint_index)->backlash, flank);
    if (status == BRACE_OK) {
        takeup->order[takeup->count++] = (uint8_t)joint_index;
        takeup->begun = false;
    }
    return status;
}

void takeup_let_go(brace_app_t *app)
{
    app->takeup.letting_go = app->takeup.count > 0;
}

bool takeup_active(const brace_app_t *app)
{
    return app->takeup.count > 0;
}

bool takeup_holds(const brace_app_t *app)
{
    bool holds = app->takeup.count > 0 && !app->takeup.letting_go;
    for (uint8_t i = 0; i < app->takeup.count; i++) {
        holds = holds && app->play[app->takeup.order[i] - BRACE_FEMUR].backlash.phase == BRACE_TAKEUP_HOLD;
    }
    return holds;
}

void takeup_advance(brace_app_t *app, const brace_snapshot_t *snapshot)
{
    brace_app_takeup_t *takeup = &app->takeup;
    if (takeup->count == 0) {
        return;
    }
    for (uint8_t i = 0; i < takeup->count; i++) {
        const brace_backlash_out_t *out = &snapshot->play[takeup->order[i]];
        const bool last = i + 1u == takeup->count;
        takeup->begun = takeup->begun || (last && out->phase != BRACE_TAKEUP_IDLE);
        const bool failed = out->takeup < 0 && (takeup->begun || !last);
        takeup->letting_go = takeup->letting_go || failed;
    }
    if (!takeup->letting_go) {
        return;
    }
    const uint8_t last = takeup->order[takeup->count - 1u];
    if (snapshot->play[last].phase == BRACE_TAKEUP_IDLE && !play_of(app, last)->backlash.requested) {
        takeup->count--;
        takeup->begun = true;
        takeup->letting_go = takeup->count > 0;
    } else {
        (void)brace_takeup_let_go(&play_of(app, last)->backlash);
    }
}
