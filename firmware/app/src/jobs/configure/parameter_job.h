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
    bool has_staged;                 /* staged holds what was written; it began as a copy of what is in force */
    brace_parameters_t staged;
    uint32_t idle_us;                /* since somebody last asked for anything of CONFIGURATION */
    uint32_t faults;                 /* BRACE_FAULT_PARAMETERS, BRACE_FAULT_STORE: they last until a set is stored */
} parameter_job_t;

/* Takes the parameters in force from the store. Before the first tick. */
void parameter_job_start(parameter_job_t *job, const brace_hal_t *hal);

/* One step of the store. returns whether it has just stored another set: in_force holds it, and comes_in_force is set
 * until the controller has made everything anew that follows from it. At most 2,400 instructions. */
bool parameter_job_step(parameter_job_t *job);

/* Was the set in force just written, so that its slot holds nothing else? False after a roll-back. */
bool parameter_job_is_fresh(const parameter_job_t *job);

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

/* The set that is being written: what is staged, or what is in force while nothing is. */
const brace_parameters_t *parameter_job_staged(const parameter_job_t *job);

/* Stages `count` parameters whose numbers on the wire (brace_parameter_index) follow one another: all of them, or none
 * where one is refused.
 *   words: each as its 32 bits
 * returns BRACE_OK, BRACE_E_UNSUPPORTED (a set is being stored), BRACE_E_RANGE (no such parameter), BRACE_E_PARAMETER,
 *   BRACE_E_NOT_FINITE (not in its own range; what members say together is judged by the commit)
 * At most 450 instructions the first time, and 65 a parameter. */
brace_status_t parameter_job_write(parameter_job_t *job, uint32_t first_number, uint32_t count, const uint32_t *words);

/* Begins to store what is staged. What members say together is judged at once.
 *   wrong_index (out, may be null): as brace_parameters_check
 * returns BRACE_OK, BRACE_E_UNSUPPORTED (a set is being stored), BRACE_E_PARAMETER, BRACE_E_NOT_FINITE.
 * At most 2,000 instructions. */
brace_status_t parameter_job_commit_staged(parameter_job_t *job, uint32_t *wrong_index);

/* Begins to store a whole set; the store checks it in its first steps.
 * returns BRACE_OK, BRACE_E_UNSUPPORTED (a set is being stored) */
brace_status_t parameter_job_commit(parameter_job_t *job, const brace_parameters_t *parameters);

/* Begins to put the set before the one in force back; returns also what brace_store_rollback returns. */
brace_status_t parameter_job_rollback(parameter_job_t *job);

#endif
