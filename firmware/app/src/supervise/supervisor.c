#include "supervise/supervisor.h"

#include "measure/loading.h"
#include "motion/takeup.h"

#define OVER_US 100000u
#define LATE_OVER_US 1000000u
#define TICK_LATE_BIT 3

_Static_assert(1 << TICK_LATE_BIT == BRACE_FAULT_TICK_LATE, "the bit of the fault");

/* Faults that come and go with their cause; the others are latched or lasting. */
#define COMING_AND_GOING ((uint32_t)(BRACE_FAULTS_NO_K | BRACE_FAULT_TICK_LATE | BRACE_FAULT_CAN_BUS_OFF))

static void with_hysteresis(brace_app_t *app, uint32_t cause, uint32_t bit)
{
    const uint32_t fault = 1u << bit;
    uint32_t *away_us = &app->supervisor.away_us[bit];
    *away_us = (cause & fault) != 0u ? 0u : *away_us + app->tick_us;
    if (*away_us >= (fault == (uint32_t)BRACE_FAULT_TICK_LATE ? LATE_OVER_US : OVER_US)) {
        app->faults &= ~fault;
    }
}

void supervisor_faults(brace_app_t *app, bool late)
{
    const uint32_t cause = (app->joint[0].sound ? 0u : (uint32_t)BRACE_FAULT_SENSOR_FEMUR) |
                           (app->joint[1].sound ? 0u : (uint32_t)BRACE_FAULT_SENSOR_TIBIA) |
                           (app->joint[0].stuck || app->joint[1].stuck ? (uint32_t)BRACE_FAULT_ENCODER_STUCK : 0u) |
                           (late ? (uint32_t)BRACE_FAULT_TICK_LATE : 0u) |
                           (app->bus.bus_off ? (uint32_t)BRACE_FAULT_CAN_BUS_OFF : 0u);
    app->faults |= app->mode == BRACE_MODE_START ? 0u : cause; /* there nothing has been seen yet: no new fault */
    for (uint32_t left = app->faults & COMING_AND_GOING; left != 0u; left &= left - 1u) { /* at most one a fault */
        with_hysteresis(app, cause, (uint32_t)__builtin_ctz(left));
    }
    const uint32_t lasting = (uint32_t)BRACE_FAULT_PARAMETERS | (uint32_t)BRACE_FAULT_STORE;
    app->faults = (app->faults & ~lasting) | app->lasting_faults | app->supervisor.latched;
}

void supervisor_late(brace_app_t *app, bool late)
{
    if (late) {
        app->faults |= BRACE_FAULT_TICK_LATE;
        app->supervisor.away_us[TICK_LATE_BIT] = 0;
    }
}

void supervisor_latch(brace_app_t *app, uint32_t fault)
{
    app->supervisor.latched |= fault;
    app->faults |= fault;
}

/* A fault ends whatever moves the limb; it goes back in order all the same. */
static void abandon(brace_app_t *app)
{
    loading_end(app, BRACE_LOADING_E_LOST);
    takeup_let_go(app);
    app->mode = BRACE_MODE_FAULT;
}

void supervisor_mode(brace_app_t *app)
{
    const bool sound = app->joint[0].sound && app->joint[1].sound;
    const bool no_k = (app->faults & BRACE_FAULTS_NO_K) != 0u;
    const bool tests = app->loading.phase != LOADING_IDLE;
    switch (app->mode) {
    case BRACE_MODE_START:
        app->start_us += app->tick_us;
        if (sound && !no_k) { /* START after CONFIGURATION may have brought a fault along */
            app->mode = BRACE_MODE_MONITOR;
        } else if (app->start_us >= OVER_US) {
            app->mode = BRACE_MODE_FAULT; /* the next tick names the joints */
        }
        break;
    case BRACE_MODE_FAULT:
        if (!no_k && sound) {
            app->mode = tests ? BRACE_MODE_LOADING_TEST
                              : takeup_active(app) ? BRACE_MODE_TAKING_UP : BRACE_MODE_MONITOR;
        }
        break;
    case BRACE_MODE_MONITOR:
    case BRACE_MODE_TAKING_UP:
    case BRACE_MODE_LOADING_TEST:
        if (no_k) {
            abandon(app);
        } else {
            app->mode = tests ? BRACE_MODE_LOADING_TEST
                              : takeup_active(app) ? BRACE_MODE_TAKING_UP : BRACE_MODE_MONITOR;
        }
        break;
    case BRACE_MODE_CONFIGURATION:
    default:
        break;
    }
}
