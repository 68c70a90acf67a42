/* What the controller is doing, and how one mode follows another. */
#ifndef BRACE_MODE_MODE_H
#define BRACE_MODE_MODE_H

#include <stdbool.h>
#include <stdint.h>

#include "brace/snapshot.h"

typedef struct {
    brace_mode_t now;
    uint32_t in_start_us; /* how long START has lasted */
} mode_state_t;

/* What the next mode follows from. */
typedef struct {
    bool joints_are_sound;
    uint32_t faults;
    bool tests;     /* a loading test runs */
    bool takes_up;  /* backlash is taken up, held or let go */
    uint32_t tick_us;
} mode_inputs_t;

/* Begins anew in START. */
void mode_start(mode_state_t *mode);

/* The mode after this tick: from START and FAULT to MONITOR, from anywhere to FAULT, back from what has ended.
 * returns whether there is a fault with which whatever moves the limb has to end */
bool mode_update(mode_state_t *mode, const mode_inputs_t *inputs);

/* Is K reported in this mode? */
static inline bool mode_reports_k(brace_mode_t mode)
{
    return mode == BRACE_MODE_MONITOR || mode == BRACE_MODE_TAKING_UP || mode == BRACE_MODE_LOADING_TEST;
}

#endif
