/* The loading test as a job: a state (brace/loading.h), and bounded steps. */
#ifndef BRACE_JOBS_LOADING_LOADING_H
#define BRACE_JOBS_LOADING_LOADING_H

#include <stdbool.h>

#include "brace/loading.h"
#include "brace/recorder.h"
#include "jobs/loading/inputs.h"

/* Phases of a test, in their order; each reading goes MOVE, DWELL, READ. */
enum {
    LOADING_IDLE = 0,
    LOADING_LISTEN,    /* takes the load's mean */
    LOADING_LEVERS,    /* works out how the motors move the tip under the load of now */
    LOADING_MOVE,
    LOADING_DWELL,
    LOADING_READ,      /* works the reading out: row, slope, and what the drift check gets */
    LOADING_MODEL,     /* after the first reading: the K that the slopes are compared with */
    LOADING_REFERENCE, /* the K that the drift check gets with all other readings */
    LOADING_JUDGE,     /* all readings are there: slopes */
    LOADING_COMPARE,   /* the model's slopes and how sure it is of them */
    LOADING_RETURN     /* back to where the test began */
};

/* Begins a test.
 * returns BRACE_OK, BRACE_E_RANGE (setup), BRACE_E_SINGULAR (no valid K, or the joints cannot move the tip along the
 *   axis at this posture) */
brace_status_t loading_start(brace_loading_t *test, const loading_inputs_t *inputs, const brace_loading_setup_t *setup);

/* Ends a test that runs: the limb goes back to where it began. */
void loading_end(brace_loading_t *test, brace_loading_outcome_t outcome);

/* What loading_start would return now. It changes nothing. */
brace_status_t loading_may_start(const brace_loading_t *test, const loading_inputs_t *inputs,
                                 const brace_loading_setup_t *setup);

static inline bool loading_runs(const brace_loading_t *test)
{
    return test->phase != LOADING_IDLE;
}

/* A tick passes: the test moves on, or averages this tick's samples. At most 200 instructions. */
void loading_step(brace_loading_t *test, const loading_inputs_t *inputs);

/* One step of what the test works out while nothing moves.
 *   reading (out): is_there is written always, all else only with is_there
 * returns whether there was such a step. At most 1,900 instructions. */
bool loading_work(brace_loading_t *test, const loading_inputs_t *inputs, brace_recorder_t *recorder,
                  loading_reading_t *reading);

/* What the test adds to a joint's set-point [rad]. joint_index: BRACE_COXA (0), BRACE_FEMUR, BRACE_TIBIA */
float loading_offset_rad(const brace_loading_t *test, int joint_index);

/* Bound of a joint's torque during the test [N mm]; INFINITY: none. */
float loading_torque_limit_n_mm(const brace_loading_t *test, int joint_index);

#endif
