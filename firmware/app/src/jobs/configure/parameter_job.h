/* The parameters in force, and the job that stores another set and puts it in force.
 *
 * A set is written member by member (staged) or comes as a whole. It is in force only once the store has written it and
 * has read it back. */
#ifndef BRACE_JOBS_CONFIGURE_PARAMETER_JOB_H
#define BRACE_JOBS_CONFIGURE_PARAMETER_JOB_H

#include <stdbool.h>
#include <stdint.h>

#include "brace/parameters.h"
#include "brace/store.h"
#include "brace_hal.h"

typedef struct {
    brace_parameters_t in_force;
    uint32_t crc;                    /* brace_parameters_crc of in_force */
    brace_parameter_origin_t origin;
    brace_store_t store;
    bool storing;                    /* the store is at work */
    bool comes_in_force;             /* in_force is another set, and what follows from it is still being made anew */
    bool has_staged;                 /* staged is in use: a copy of the set in force, changed by writes */
    brace_parameters_t staged;
    uint32_t apart_us;               /* since the last erase, up to 10 s */
    uint32_t commits_refused;        /* too soon, or another set than was named */
    uint32_t idle_us;                /* since somebody last asked for anything of CONFIGURATION */
    uint32_t faults;                 /* BRACE_FAULT_PARAMETERS, BRACE_FAULT_STORE: they last until a set is stored;
                                        BRACE_FAULT_OLD_PARAMETERS: until then, or until somebody accepts the set */
    bool is_accepted;                /* somebody has cleared that fault since the start */
} parameter_job_t;

/* Takes the parameters in force from the store. Before the first tick. */
void parameter_job_start(parameter_job_t *job, const brace_hal_t *hal);

/* One step of the store. returns whether it has just stored another set: in_force holds it, and comes_in_force is set
 * until the controller has made everything anew that follows from it. At most 2,400 instructions. */
bool parameter_job_step(parameter_job_t *job);

/* Takes the set in force from the store again; without one, the defaults. Nothing while the job is busy. */
void parameter_job_reload(parameter_job_t *job);

/* Was the set in force just written, so that its slot holds nothing else? False after a roll-back and a reload. */
bool parameter_job_is_fresh(const parameter_job_t *job);

/* Is the set in force the one that was stored last, as far as anybody knows? Not the defaults, and not one that is in
 * force only because the set after it has rotted. */
bool parameter_job_is_calibrated(const parameter_job_t *job);

/* Somebody has looked at the set in force and takes it until the next start, though another one was stored after it. */
void parameter_job_accept(parameter_job_t *job);

/* Is a set being stored or put in force? */
static inline bool parameter_job_is_busy(const parameter_job_t *job)
{
    return job->storing || job->comes_in_force;
}

/* CONFIGURATION has been entered: what was staged is forgotten. */
void parameter_job_open(parameter_job_t *job);

/* Somebody asked for something: CONFIGURATION lasts its patience from here. */
void parameter_job_keep_open(parameter_job_t *job);

/* For how long nobody has asked for anything [us]. Each tick of CONFIGURATION.
 *   since_us: since the tick before, which an erase may have delayed */
uint32_t parameter_job_idle_us(parameter_job_t *job, uint32_t since_us);

/* Each tick. since_us: since the tick before */
void parameter_job_age(parameter_job_t *job, uint32_t since_us);

/* How long no commit is taken yet [ms]. */
uint32_t parameter_job_wait_ms(const parameter_job_t *job);

/* The set that is being written: what is staged, or what is in force while nothing is. */
const brace_parameters_t *parameter_job_staged(const parameter_job_t *job);

/* These four do what brace_app_parameters_stage, _commit_staged, _commit and _rollback promise (brace/requests.h). Only
 * while the job is not busy. */
brace_status_t parameter_job_write(parameter_job_t *job, uint32_t first_number, uint32_t count, const uint32_t *words);
brace_status_t parameter_job_commit_staged(parameter_job_t *job, uint32_t *wrong_index);
brace_status_t parameter_job_commit(parameter_job_t *job, const brace_parameters_t *parameters);
brace_status_t parameter_job_rollback(parameter_job_t *job);

#endif
