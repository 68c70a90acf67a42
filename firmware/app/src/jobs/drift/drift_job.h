/* The drift check as a job: it takes the loading test's readings in, and keeps what it has learned over restarts.
 *
 * A record of what the check knows is written to the journal (brace/journal.h) in the slot of the parameters in force:
 * after a loading test or a cleared alarm, when the check's state has changed, when its evidence has moved by 4
 * either way, or after 512 readings while it learns and 4,096 while it watches. Evidence that fell is kept as well:
 * otherwise every start would find the old, higher evidence again, until it sums up to an alarm. */
#ifndef BRACE_JOBS_DRIFT_DRIFT_JOB_H
#define BRACE_JOBS_DRIFT_DRIFT_JOB_H

#include <stdbool.h>
#include <stdint.h>

#include "brace/codes.h"
#include "brace/drift.h"
#include "brace/journal.h"
#include "brace/parameters.h"
#include "brace_hal.h"

typedef struct {
    brace_drift_t drift;
    brace_drift_report_t report;  /* of what the check knows now */
    brace_drift_outlook_t outlook; /* what further readings at this posture can show; see has_outlook */
    bool has_outlook;
    /* Work that is due, one piece a step, in this order. */
    bool learns_anew;             /* the limb's parameters have changed */
    bool opens;                   /* the journal in their slot is to be opened */
    bool is_erased;               /* that slot has just been written, so that its journal is empty */
    bool scans;                   /* the journal is being searched for what was known */
    bool has_reading;             /* reading and model wait to be taken in */
    bool run_ends;                /* and the run ends after it */
    bool reports;                 /* the report is older than the check */
    bool foresees;                /* the outlook is older than the check */
    bool looks;                   /* is a record worth writing? */
    brace_drift_reading_t reading;
    brace_stiffness_t model;
    brace_drift_reading_t widest; /* of the readings at this posture, the one of the largest displacement */
    brace_journal_t journal;
    uint8_t ticks_to_write;       /* until the memory may be written to again */
    bool memory_failed;           /* the journal's memory does not keep what is written: BRACE_FAULT_STORE */
    /* What the newest record says. */
    uint8_t kept_state;
    uint32_t kept_steps;
    float kept_evidence[BRACE_DRIFT_CAUSE_COUNT + 1];
} drift_job_t;

/* What a step is given. */
typedef struct {
    const brace_hal_t *hal;
    const brace_parameters_t *parameters;
    uint32_t parameter_crc;
    brace_parameter_origin_t origin;
    bool may_write; /* to the memory: MONITOR or FAULT, and no set is being stored */
} drift_inputs_t;

/* The parameters in force have changed: the check learns anew, or goes on from the journal in their slot.
 *   is_fresh: the set has just been written; else it was there before */
void drift_job_configure(drift_job_t *job, bool is_fresh);

/* Takes a reading of a loading test; a step works it in. Readings come many ticks apart; one that still waits,
 * because the journal is being searched, gives way.
 *   reading, model: as brace_drift_step has them
 *   run_ends: the next reading begins a new run */
void drift_job_take(drift_job_t *job, const brace_drift_reading_t *reading, const brace_stiffness_t *model,
                    bool run_ends);

/* The next reading begins a new run. */
void drift_job_end_run(drift_job_t *job);

/* Does the next piece of the job's work. returns whether there was one. Cost: at most 2,500 instructions, or 1,000 and
 * two calls of the HAL's memory. */
bool drift_job_work(drift_job_t *job, const drift_inputs_t *inputs);

/* Is anything due before the check can be trusted: learning anew, opening the journal, searching it? */
static inline bool drift_job_is_starting(const drift_job_t *job)
{
    return job->learns_anew || job->opens || job->scans;
}

/* Has the limb drifted away from its model? BRACE_FAULT_MODEL_DRIFT. The alarm comes one tick later, with the report,
 * so that a reader gets the cause together with the alarm. */
static inline bool drift_job_alarms(const drift_job_t *job)
{
    return job->drift.state == BRACE_DRIFT_DRIFTED && job->report.state == BRACE_DRIFT_DRIFTED;
}

/* Clears the alarm: the check watches on from the baseline it holds. */
void drift_job_clear(drift_job_t *job);

/* What a person should do next, from what the check knows. */
brace_drift_next_t drift_job_next_step(const drift_job_t *job);

#endif
