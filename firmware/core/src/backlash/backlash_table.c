#include "backlash/backlash_table.h"

#include <stddef.h>

#include "brace/backlash_types.h"

#define ROWS(array) \
    { \
        array, sizeof array / sizeof *array \
    }

enum {
    UNKNOWN = BRACE_BACKLASH_UNKNOWN,
    TAKING_UP = BRACE_BACKLASH_TAKING_UP,
    POSITIVE = BRACE_BACKLASH_ENGAGED_POSITIVE,
    NEGATIVE = BRACE_BACKLASH_ENGAGED_NEGATIVE,
    CROSSING = BRACE_BACKLASH_CROSSING,
    FAULT = BRACE_BACKLASH_FAULT
};

static const transition_t from_unknown[] = {
    {FACT_BAD_SAMPLE, 0, FAULT, 0},
    {FACT_TAKING_UP, 0, TAKING_UP, 0},
    {FACT_POSITIVE, 0, POSITIVE, 0},
    {FACT_NEGATIVE, 0, NEGATIVE, 0},
};
static const transition_t from_taking_up[] = {
    {FACT_BAD_SAMPLE, 0, FAULT, 0},
    {FACT_NOT_TAKING_UP | FACT_POSITIVE, 0, POSITIVE, 0},
    {FACT_NOT_TAKING_UP | FACT_NEGATIVE, 0, NEGATIVE, 0},
    {FACT_NOT_TAKING_UP, 0, UNKNOWN, 0},
    {FACT_ALWAYS, 70000000, UNKNOWN, 0}, /* the take-up's own time is shorter */
};
static const transition_t from_positive[] = {
    {FACT_BAD_SAMPLE, 0, FAULT, 0}, {FACT_TAKING_UP, 0, TAKING_UP, 0}, {FACT_NEGATIVE, 0, NEGATIVE, 0},
    {FACT_LEFT, 0, CROSSING, 0},    {FACT_STALE, 0, UNKNOWN, 0},
};
static const transition_t from_negative[] = {
    {FACT_BAD_SAMPLE, 0, FAULT, 0}, {FACT_TAKING_UP, 0, TAKING_UP, 0}, {FACT_POSITIVE, 0, POSITIVE, 0},
    {FACT_LEFT, 0, CROSSING, 0},    {FACT_STALE, 0, UNKNOWN, 0},
};
static const transition_t from_crossing[] = {
    {FACT_BAD_SAMPLE, 0, FAULT, 0},  {FACT_TAKING_UP, 0, TAKING_UP, 0},  {FACT_POSITIVE, 0, POSITIVE, 0},
    {FACT_NEGATIVE, 0, NEGATIVE, 0}, {FACT_ALWAYS, 2000000, UNKNOWN, 0},
};
static const transition_t from_fault[] = {
    {FACT_BAD_SAMPLE, 0, FAULT, 0}, /* the time in FAULT begins anew */
    {FACT_ALWAYS, 20000, UNKNOWN, 0},
};

const transitions_t backlash_states[BRACE_BACKLASH_STATE_COUNT] = {
    [UNKNOWN] = ROWS(from_unknown),   [TAKING_UP] = ROWS(from_taking_up), [POSITIVE] = ROWS(from_positive),
    [NEGATIVE] = ROWS(from_negative), [CROSSING] = ROWS(from_crossing),   [FAULT] = ROWS(from_fault),
};

enum {
    IDLE = BRACE_TAKEUP_IDLE,
    APPROACH = BRACE_TAKEUP_APPROACH,
    VERIFY = BRACE_TAKEUP_VERIFY,
    HOLD = BRACE_TAKEUP_HOLD,
    LET_GO = BRACE_TAKEUP_LET_GO
};

static const transition_t from_idle[] = {
    {FACT_REQUESTED, 0, APPROACH, BRACE_TAKEUP_RUNNING},
};
static const transition_t from_approach[] = {
    {FACT_BAD_SAMPLE, 0, LET_GO, BRACE_TAKEUP_E_FAULT}, {FACT_LET_GO, 0, LET_GO, BRACE_TAKEUP_NONE},
    {FACT_TORQUE, 0, LET_GO, BRACE_TAKEUP_E_TORQUE},    {FACT_PRELOADED, 0, VERIFY, 0},
    {FACT_TRAVEL, 0, LET_GO, BRACE_TAKEUP_E_TRAVEL},    {FACT_REACH, 0, LET_GO, BRACE_TAKEUP_E_REACH},
    {FACT_TIME, 0, LET_GO, BRACE_TAKEUP_E_TIME},
};
static const transition_t from_verify[] = {
    {FACT_BAD_SAMPLE, 0, LET_GO, BRACE_TAKEUP_E_FAULT}, {FACT_LET_GO, 0, LET_GO, BRACE_TAKEUP_NONE},
    {FACT_TORQUE, 0, LET_GO, BRACE_TAKEUP_E_TORQUE},    {FACT_UNLOADED, 0, LET_GO, BRACE_TAKEUP_E_VERIFY},
    {FACT_MOVED, 0, LET_GO, BRACE_TAKEUP_E_VERIFY},     {FACT_VERIFIED, 0, HOLD, BRACE_TAKEUP_DONE},
    {FACT_TIME, 0, LET_GO, BRACE_TAKEUP_E_TIME},
};
static const transition_t from_hold[] = {
    {FACT_BAD_SAMPLE, 0, LET_GO, BRACE_TAKEUP_E_FAULT},
    {FACT_LET_GO, 0, LET_GO, 0},
    {FACT_UNLOADED, 0, LET_GO, BRACE_TAKEUP_E_LOST},
};
static const transition_t from_let_go[] = {
    {FACT_BACK, 0, IDLE, 0},
};

const transitions_t takeup_phases[BRACE_TAKEUP_PHASE_COUNT] = {
    [IDLE] = ROWS(from_idle), [APPROACH] = ROWS(from_approach), [VERIFY] = ROWS(from_verify),
    [HOLD] = ROWS(from_hold), [LET_GO] = ROWS(from_let_go),
};

const transition_t *transition_find(const transitions_t *from, uint32_t facts, uint32_t in_state_us)
{
    for (uint32_t i = 0; i < from->count; i++) {
        const transition_t *row = &from->rows[i];
        if ((facts & row->facts) == row->facts && in_state_us >= row->after_us) {
            return row;
        }
    }
    return NULL;
}
