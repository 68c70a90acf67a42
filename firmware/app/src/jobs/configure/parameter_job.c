#include "jobs/configure/parameter_job.h"

#include <string.h>

#include "brace/snapshot.h"

#define APART_US 10000000u /* between two commits: each erases a slot, and a slot takes some 10,000 of them */

/* Where the set in force comes from, and the faults that last as long as it does. */
static void judge(parameter_job_t *job)
{
    brace_store_status_t status;
    brace_store_status(&job->store, &status);
    job->origin = status.in_force;
    job->faults = (status.in_force == BRACE_PARAMETERS_DEFAULT ? (uint32_t)BRACE_FAULT_PARAMETERS : 0u) |
                  (status.memory_fault ? (uint32_t)BRACE_FAULT_STORE : 0u) |
                  (status.is_old && !job->is_accepted ? (uint32_t)BRACE_FAULT_OLD_PARAMETERS : 0u);
}

bool parameter_job_is_calibrated(const parameter_job_t *job)
{
    return job->origin != BRACE_PARAMETERS_DEFAULT && (job->faults & (uint32_t)BRACE_FAULT_OLD_PARAMETERS) == 0u;
}

void parameter_job_accept(parameter_job_t *job)
{
    job->is_accepted = true;
    judge(job);
}

void parameter_job_start(parameter_job_t *job, const brace_hal_t *hal)
{
    job->storing = job->comes_in_force = job->has_staged = job->is_accepted = false;
    job->idle_us = 0;
    job->apart_us = APART_US;
    (void)brace_store_start(&job->store, hal, &job->in_force);
    job->crc = brace_parameters_crc(&job->in_force);
    judge(job);
}

bool parameter_job_step(parameter_job_t *job)
{
    const uint32_t erases = job->store.erases;
    const brace_store_state_t state = job->storing ? brace_store_step(&job->store) : BRACE_STORE_BUSY;
    job->apart_us = erases != job->store.erases ? 0u : job->apart_us;
    if (state == BRACE_STORE_BUSY) {
        return false;
    }
    const bool is_in_force = state == BRACE_STORE_DONE;
    if (is_in_force) {
        (void)brace_store_take(&job->store, &job->in_force, &job->crc);
        job->has_staged = false;
        job->comes_in_force = true;
    }
    if (!is_in_force && job->store.failure == BRACE_STORE_E_REFUSED && job->store.refusal == BRACE_E_CHECKSUM) {
        brace_count(&job->commits_refused);
    }
    job->storing = false;
    judge(job);
    return is_in_force;
}

bool parameter_job_is_fresh(const parameter_job_t *job)
{
    return !job->store.rolling_back && !job->store.reloading;
}

void parameter_job_reload(parameter_job_t *job)
{
    if (parameter_job_is_busy(job)) {
        return;
    }
    if (job->store.in_force == BRACE_PARAMETERS_DEFAULT) {
        brace_parameters_default(&job->in_force);
        job->crc = brace_parameters_crc(&job->in_force);
        judge(job);
        job->comes_in_force = true;
    } else {
        job->storing = brace_store_reload(&job->store) == BRACE_OK;
    }
}

void parameter_job_open(parameter_job_t *job)
{
    job->has_staged = false;
    job->idle_us = 0;
}

void parameter_job_keep_open(parameter_job_t *job)
{
    job->idle_us = 0;
}

uint32_t parameter_job_idle_us(parameter_job_t *job, uint32_t since_us)
{
    job->idle_us = parameter_job_is_busy(job) ? 0u : job->idle_us + since_us;
    return job->idle_us;
}

void parameter_job_age(parameter_job_t *job, uint32_t since_us)
{
    const uint32_t left_us = APART_US - job->apart_us;
    job->apart_us += since_us < left_us ? since_us : left_us;
}

uint32_t parameter_job_wait_ms(const parameter_job_t *job)
{
    return (APART_US - job->apart_us + 999u) / 1000u;
}

const brace_parameters_t *parameter_job_staged(const parameter_job_t *job)
{
    return job->has_staged ? &job->staged : &job->in_force;
}

brace_status_t parameter_job_write(parameter_job_t *job, uint32_t first_number, uint32_t count, const uint32_t *words)
{
    for (uint32_t i = 0; i < count; i++) { /* at most BRACE_PARAMETER_COUNT: no more are in range */
        const brace_status_t status = brace_parameter_in_range(brace_parameter_index(first_number + i), words[i]);
        if (status != BRACE_OK) {
            return status;
        }
    }
    if (!job->has_staged) {
        job->staged = job->in_force;
        job->has_staged = true;
    }
    /* A set is a run of 32-bit members: brace/parameters.h. */
    for (uint32_t i = 0; i < count; i++) { /* at most BRACE_PARAMETER_COUNT */
        const uint32_t index = brace_parameter_index(first_number + i);
        if (index < (uint32_t)BRACE_PARAMETER_COUNT) { /* the loop above refuses others: for the compiler */
            memcpy((uint8_t *)&job->staged + 4u * index, &words[i], sizeof words[i]);
        }
    }
    return BRACE_OK;
}

brace_status_t parameter_job_commit_staged(parameter_job_t *job, uint32_t *wrong_index)
{
    const brace_parameters_t *set = parameter_job_staged(job);
    /* Every member is in its range: those in force were judged at the start, those that were written when they came. */
    const brace_status_t together = brace_parameters_check_piece(set, BRACE_CHECK_TOGETHER, wrong_index);
    return together == BRACE_OK ? parameter_job_commit(job, set) : together;
}

brace_status_t parameter_job_commit(parameter_job_t *job, const brace_parameters_t *parameters)
{
    const brace_status_t status = brace_store_offer(&job->store, parameters);
    job->storing = job->storing || status == BRACE_OK;
    return status;
}

brace_status_t parameter_job_rollback(parameter_job_t *job)
{
    const brace_status_t status = brace_store_rollback(&job->store);
    job->storing = job->storing || status == BRACE_OK;
    return status;
}
