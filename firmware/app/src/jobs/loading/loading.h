/* The loading test as a job: a state (brace/loading.h), and one bounded step in each tick. */
#ifndef BRACE_JOBS_LOADING_LOADING_H
#define BRACE_JOBS_LOADING_LOADING_H

#include <stdbool.h>

#include "brace/loading.h"
#include "brace/recorder.h"
#include "jobs/loading/inputs.h"

/* Phases of a test, in their order; each reading goes MOVE, DWELL, READ. */
enum {
    LOADING_IDLE = 0,
    LOADING_LEVERS = 1,  /* works out how the motors move the tip under the load of now */
    LOADING_MOVE = 2,
    LOADING_DWELL = 3,
    LOADING_READ = 4,    /* works the reading out: row, slope, and what the drift check gets */
    LOADING_MODEL = 5,   /* after the first reading: the K that the slopes are compared with */
    LOADING_REFERENCE = 6, /* the K that the drift check gets with all other readings */
    LOADING_JUDGE = 7,   /* all readings are there: slopes */
    LOADING_COMPARE = 8, /* the model's slopes and how sure it is of them */
    LOADING_RETURN = 9   /* back to where the test began */
};

/* Begins a test.
 * returns BRACE_OK, BRACE_E_RANGE (setup), BRACE_E_SINGULAR (no valid K, or the joints cannot move the tip along the
 *   axis at this posture) */
brace_status_t loading_start(brace_loading_t *test, const loading_inputs_t *inputs, const brace_loading_setup_t *setup);

/* Ends a test that runs: the limb goes back to where it began. */
void loading_end(brace_loading_t *test, brace_loading_outcome_t outcome);

/* Takes back a test that has not moved anything yet. */
void loading_forget(brace_loading_t *test);

static inline bool loading_runs(const brace_loading_t *test)
{
    return test->phase != LOADING_IDLE;
}

/* One step, with this tick's samples. Nothing is to do in IDLE. A dear step waits for a tick in which it may work.
 *   reading (out): has_worked and is_there are written always, all else only with is_there
 * At most 2,900 instructions (LEVERS; of a limb in space 4,500); in MOVE and DWELL 200. */
void loading_step(brace_loading_t *test, const loading_inputs_t *inputs, brace_recorder_t *recorder,
                  loading_reading_t *reading);

/* What the test adds to a joint's set-point [rad]. joint_index: BRACE_COXA (0), BRACE_FEMUR, BRACE_TIBIA */
float loading_offset_rad(const brace_loading_t *test, int joint_index);

/* Bound of a joint's torque during the test [N mm]; INFINITY: none. */
float loading_torque_limit_n_mm(const brace_loading_t *test, int joint_index);

#endif
