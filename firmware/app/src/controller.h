/* The controller's memory: every part of it but the wires. app.c and the files that answer what is asked of it know it
 * (motions.c, owners.c, questions.c, requests.c, sigma.c); no part knows it.
 *
 * A brace_app_t begins with it (brace/app_memory.h; app.c asserts that), and whoever asks has a pointer to the whole.
 * So what answers finds its memory without knowing the wires, which ask. */
#ifndef BRACE_CONTROLLER_H
#define BRACE_CONTROLLER_H

#include "brace/recorder.h"
#include "brace/snapshot.h"
#include "brace_hal.h"
#include "command/drives.h"
#include "flank/flank.h"
#include "flank/takeup.h"
#include "guard/guard.h"
#include "interval/interval.h"
#include "jobs/configure/parameter_job.h"
#include "jobs/drift/drift_job.h"
#include "jobs/loading/loading.h"
#include "jobs/question/question_job.h"
#include "jobs/uncertainty/sigma_job.h"
#include "mode/faults.h"
#include "mode/mode.h"
#include "posture/gravity.h"
#include "posture/posture.h"
#include "sense/joints.h"
#include "sense/tip_force.h"
#include "session/ownership.h"
#include "stiffness/model.h"
#include "stiffness/softening.h"
#include "watch/frozen.h"

/* Parts of the memory that guard looks over: app.c lists them. */
enum { GUARDED_GRAVITY = 4, GUARDED_JOINTS = 5, GUARDED_SPANS = GUARDED_JOINTS + BRACE_LINK_COUNT };

/* Something that an owner may ask for. */
typedef enum { MOTION_TAKE_UP, MOTION_LET_GO, MOTION_LOADING_TEST, MOTION_END_TEST } asked_motion_kind_t;

typedef struct {
    asked_motion_kind_t kind;
    int32_t joint, flank;        /* of a take-up */
    brace_loading_setup_t setup; /* of a loading test */
} asked_motion_t;

typedef struct {
    const brace_hal_t *hal;
    uint32_t now_us;       /* of this tick */
    uint32_t since_us;     /* how long the tick before is ago; 0 in the first tick */
    bool has_ticked;
    brace_app_counters_t counters;
    bool has_crashed;      /* the processor started after a crash that nobody has cleared: BRACE_FAULT_CRASHED */

    joints_t joints;
    tip_force_t tip_force;
    flank_t flank;
    takeup_t takeup;
    posture_t posture;
    interval_t interval;
    gravity_t gravity;
    model_t model;
    softening_t softening;
    brace_loading_t loading;
    model_work_t loading_k; /* that the test works out */
    brace_recorder_t recorder;
    drift_job_t drift;
    question_job_t question;
    sigma_job_t sigma;
    parameter_job_t parameters;
    uint8_t configure_part;  /* of putting parameters in force, the next one */
    guard_t guard;
    bool memory_is_wrong;    /* parameters or their constants have changed by themselves, until they are made anew */
    faults_t faults;
    mode_state_t mode;
    drives_t drives;
    ownership_t ownership;
    asked_motion_t asked;          /* what has been asked for over a wire; ownership.waits: it has not begun */
    frozen_t frozen;
    uint32_t parts_done;           /* of the tick, in their order: app.c */

    uint32_t sequence;             /* of the newest snapshot */
    brace_snapshot_t snapshot[2];  /* the newest, and the one that the next tick writes */
    uint8_t newest;
    uint8_t ticks_unwatched;       /* a job has worked in so many after one another */
} controller_t;

struct brace_app;

static inline controller_t *controller_of(struct brace_app *app)
{
    return (controller_t *)app;
}

static inline const controller_t *controller_in(const struct brace_app *app)
{
    return (const controller_t *)app;
}

/* Is the connection of that master closed? */
bool controller_has_hung_up(const controller_t *controller, brace_who_t who);

/* Does a take-up add to the set-points, or what is left of one? */
static inline bool controller_takes_up(const controller_t *controller)
{
    return takeup_runs(&controller->takeup) || controller->drives.is_going_back;
}

/* Begins what has waited, if it is still possible. */
void controller_begin(controller_t *controller);

/* What the loading test is given.
 *   now: the snapshot that it works from */
static inline loading_inputs_t controller_loading_inputs(controller_t *controller, const brace_snapshot_t *now)
{
    return (loading_inputs_t){.now = now,
                              .joints = &controller->joints,
                              .flank = &controller->flank,
                              .posture = &controller->posture,
                              .model = &controller->model,
                              .work = &controller->loading_k,
                              .parameters = &controller->parameters.in_force,
                              .down = controller->gravity.down};
}

#endif
