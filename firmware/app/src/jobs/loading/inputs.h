/* What a step of the loading test is given, and what it hands on. */
#ifndef BRACE_JOBS_LOADING_INPUTS_H
#define BRACE_JOBS_LOADING_INPUTS_H

#include <stdbool.h>

#include "brace/drift.h"
#include "brace/snapshot.h"
#include "flank/flank.h"
#include "posture/posture.h"
#include "sense/joints.h"
#include "stiffness/model.h"

/* What a step is given. */
typedef struct {
    const brace_snapshot_t *now; /* of this tick, K included */
    const joints_t *joints;
    const flank_t *flank;
    const posture_t *posture;
    model_t *model;
    model_work_t *work;          /* the test's own */
    const brace_parameters_t *parameters;
    brace_vec3_t down;            /* where the weight pulls */
} loading_inputs_t;

/* What a step hands to the drift check. */
typedef struct {
    bool is_there;           /* a reading has been worked out in this step; always written */
    bool run_ends;           /* later readings belong to a new run: friction has turned round with the motion */
    bool is_fit;             /* the force was sensed, no gap was open, the limb is calibrated: reading counts */
    brace_drift_reading_t reading;
    brace_stiffness_t model; /* K at the reading's posture, at the reference temperature */
} loading_reading_t;

#endif
