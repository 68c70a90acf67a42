#include "mode/mode.h"

#define START_PATIENCE_US 100000u

void mode_start(mode_state_t *mode)
{
    *mode = (mode_state_t){.now = BRACE_MODE_START};
}

/* The mode of a controller that works. */
static brace_mode_t working_mode(const mode_inputs_t *inputs)
{
    return inputs->tests ? BRACE_MODE_LOADING_TEST : inputs->takes_up ? BRACE_MODE_TAKING_UP : BRACE_MODE_MONITOR;
}

bool mode_update(mode_state_t *mode, const mode_inputs_t *inputs)
{
    const bool no_k = (inputs->faults & BRACE_FAULTS_NO_K) != 0u;
    const bool may_work = inputs->joints_are_sound && !no_k;
    const bool may_move = !no_k && (inputs->faults & (uint32_t)BRACE_FAULT_DRIVE_REFUSES) == 0u;
    switch (mode->now) {
    case BRACE_MODE_START:
        mode->in_start_us += inputs->tick_us;
        if (may_work) { /* START after CONFIGURATION may have brought a fault along */
            mode->now = BRACE_MODE_MONITOR;
        } else if (mode->in_start_us >= START_PATIENCE_US) {
            mode->now = BRACE_MODE_FAULT; /* the next tick's faults name the joints */
        }
        return false;
    case BRACE_MODE_FAULT: mode->now = may_work ? working_mode(inputs) : mode->now; return false;
    case BRACE_MODE_MONITOR:
    case BRACE_MODE_TAKING_UP:
    case BRACE_MODE_LOADING_TEST: mode->now = no_k ? BRACE_MODE_FAULT : working_mode(inputs); return !may_move;
    case BRACE_MODE_CONFIGURATION:
    default: return false;
    }
}
