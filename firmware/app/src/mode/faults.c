#include "mode/faults.h"

#define OVER_US 100000u
#define LATE_OVER_US 1000000u

/* Faults that stand as long as somebody says so. Every other fault comes and goes with its cause. */
#define LASTING \
    ((uint32_t)(BRACE_FAULT_PARAMETERS | BRACE_FAULT_STORE | BRACE_FAULT_MODEL_DRIFT | BRACE_FAULT_CRASHED | \
                BRACE_FAULT_OLD_PARAMETERS | BRACE_FAULT_JUMP_COXA | BRACE_FAULT_JUMP_FEMUR | BRACE_FAULT_JUMP_TIBIA))

void faults_update(faults_t *faults, uint32_t causes, uint32_t lasting, bool may_begin, uint32_t tick_us)
{
    uint32_t now = (faults->now | (may_begin ? causes : 0u)) & ~LASTING;
    for (uint32_t left = now; left != 0u; left &= left - 1u) { /* at most BRACE_FAULT_COUNT */
        const uint32_t bit = (uint32_t)__builtin_ctz(left), fault = 1u << bit;
        const uint32_t over_us = fault == (uint32_t)BRACE_FAULT_TICK_LATE ? LATE_OVER_US : OVER_US;
        faults->away_us[bit] = (causes & fault) != 0u ? 0u : faults->away_us[bit] + tick_us;
        if (faults->away_us[bit] >= over_us) {
            now &= ~fault;
        }
    }
    faults->now = now | lasting;
}
