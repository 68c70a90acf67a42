#include "flank/takeup.h"

static flank_joint_t *joint_at(const takeup_t *takeup, flank_t *flank, uint32_t place)
{
    return &flank->joint[takeup->order[place]];
}

brace_status_t takeup_may_request(const takeup_t *takeup, const flank_t *flank, int32_t joint_index, int32_t flank_sign)
{
    if (joint_index < BRACE_COXA || joint_index > BRACE_TIBIA || (flank_sign != 1 && flank_sign != -1)) {
        return BRACE_E_RANGE;
    }
    if (!flank->joint[joint_index].watched) {
        return BRACE_E_UNSUPPORTED;
    }
    if (takeup->letting_go) {
        return BRACE_E_MODE;
    }
    for (uint32_t i = 0; i < takeup->count; i++) {
        if ((int)takeup->order[i] == joint_index) {
            return BRACE_E_RANGE;
        }
        if (flank->joint[takeup->order[i]].machine.phase != BRACE_TAKEUP_HOLD) {
            return BRACE_E_MODE; /* one at a time, because the second joint leans on the first */
        }
    }
    brace_backlash_t machine = flank->joint[joint_index].machine; /* only asked */
    return brace_takeup_request(&machine, flank_sign);
}

brace_status_t takeup_request(takeup_t *takeup, flank_t *flank, int32_t joint_index, int32_t flank_sign)
{
    brace_status_t status = takeup_may_request(takeup, flank, joint_index, flank_sign);
    if (status == BRACE_OK) {
        status = brace_takeup_request(&flank->joint[joint_index].machine, flank_sign);
        takeup->order[takeup->count++] = (uint8_t)joint_index;
        takeup->begun = false;
    }
    return status;
}

void takeup_let_go(takeup_t *takeup)
{
    takeup->letting_go = takeup->count > 0u;
}

bool takeup_holds(const takeup_t *takeup, const flank_t *flank)
{
    bool holds = takeup->count > 0u && !takeup->letting_go;
    for (uint32_t i = 0; i < takeup->count; i++) {
        holds = holds && flank->joint[takeup->order[i]].machine.phase == BRACE_TAKEUP_HOLD;
    }
    return holds;
}

void takeup_step(takeup_t *takeup, flank_t *flank)
{
    for (uint32_t i = 0; i < takeup->count; i++) {
        const brace_backlash_out_t *out = &joint_at(takeup, flank, i)->out;
        const bool is_last = i + 1u == takeup->count;
        takeup->begun = takeup->begun || (is_last && out->phase != BRACE_TAKEUP_IDLE);
        /* Until the last joint has begun, its result is that of the take-up before. */
        const bool failed = out->takeup < 0 && (takeup->begun || !is_last);
        takeup->letting_go = takeup->letting_go || failed;
    }
    if (!takeup->letting_go) {
        return;
    }
    flank_joint_t *last = joint_at(takeup, flank, takeup->count - 1u);
    if (last->out.phase == BRACE_TAKEUP_IDLE && !last->machine.requested) {
        takeup->count--;
        takeup->begun = true;
        takeup->letting_go = takeup->count > 0u;
    } else {
        (void)brace_takeup_let_go(&last->machine);
    }
}
