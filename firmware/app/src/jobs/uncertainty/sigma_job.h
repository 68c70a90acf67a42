/* How exactly K of now is known: one sigma of each of its entries, for the snapshot.
 *
 * The job takes the inputs of one tick's K, and works K out anew with one of them changed at a time, as
 * brace/uncertainty_causes.h describes. A K under a load costs a fifth of a tick, so such a round takes about 60 steps
 * in the plane and 290 in space. Then the next round begins.
 *
 * What the joints' loads may be off by changes within a tick, much faster than a round ends. So a round finds how K
 * changes with each joint's load and with its square, and each tick puts in how far its own loads may be off.
 *
 * A round's result holds for ticks in which the limb stands nearly as it did then and is nearly as stiff: there sigma
 * is within 20 % of what a round of that tick would give (docs/trust.md). In all other ticks sigma is not known. */
#ifndef BRACE_JOBS_UNCERTAINTY_SIGMA_JOB_H
#define BRACE_JOBS_UNCERTAINTY_SIGMA_JOB_H

#include <stdbool.h>
#include <stdint.h>

#include "brace/parameters.h"
#include "brace/snapshot.h"
#include "brace/uncertainty_causes.h"
#include "stiffness/model.h"

enum { SIGMA_SIDES = 2 };

/* K's inputs where one joint's load is larger, and where it is smaller. */
typedef struct {
    bool counts;       /* such a load changes K */
    float by_n_mm;     /* > 0 */
    brace_vec3_t tip_n[SIGMA_SIDES];
    brace_loaded_joint_t spring[SIGMA_SIDES][BRACE_LINK_COUNT];
} sigma_load_t;

/* What a round is given. */
typedef struct {
    brace_k_inputs_t k;
    brace_vec3_t down;
    bool is_spatial;
    uint32_t taken_us;  /* when the samples were taken */
    uint32_t kind;      /* open gaps, and where the load comes from: a result holds for ticks of the same kind */
    float load_n_mm[BRACE_LINK_COUNT], temp_degc[BRACE_LINK_COUNT]; /* of the joints; NaN: not known */
    sigma_load_t load[BRACE_LINK_COUNT];
} sigma_inputs_t;

/* What a tick gives, in which the result may hold. */
typedef struct {
    const float *unbent_rad;             /* of each joint */
    float off_n_mm[BRACE_LINK_COUNT];    /* how far its load may be off; NaN: not known */
    uint32_t kind;
    uint32_t now_us;
} sigma_now_t;

/* The result of a round. */
typedef struct {
    bool is_there;
    uint32_t taken_us, kind;
    uint16_t ticks_old;
    float unbent_rad[BRACE_LINK_COUNT];
    brace_k_base_t base;
    brace_k_sigma_t variance;                  /* of all causes but the loads of the joints */
    bool load_counts[BRACE_LINK_COUNT];
    float load_by_n_mm[BRACE_LINK_COUNT];
    brace_k_sigma_t by_load[BRACE_LINK_COUNT];         /* variance for each squared N mm, */
    brace_k_sigma_t by_load_squared[BRACE_LINK_COUNT]; /* and for each fourth power of N mm */
} sigma_result_t;

typedef struct {
    sigma_result_t told;   /* of the last round that has ended */
    sigma_result_t round;  /* that is under way */
    sigma_inputs_t inputs; /* its inputs; whoever begins it writes them */
    bool has_inputs;       /* but for the other loads, which the next step writes */
    bool is_under_way;
    bool is_to_find;       /* the first K is there, and what follows from it has still to be found */
    uint8_t next;          /* the K that is worked out: 0 with nothing changed, then the causes, then the loads */
    uint8_t ticks_waited;  /* since a step */
    brace_stiffness_t larger_plane; /* K with the larger load */
    brace_k3_t larger_space;
    bool is_prepared;      /* the next two belong to the next K */
    brace_k_inputs_t changed_inputs;
    model_t changed;       /* the limb */
    model_work_t work;
} sigma_job_t;

/* Nothing is known: parameters change. */
void sigma_job_forget(sigma_job_t *job);

/* A tick passes. */
void sigma_job_age(sigma_job_t *job);

/* Has a step waited for so long that everything else has to wait for it? */
bool sigma_job_is_overdue(const sigma_job_t *job);

/* Is a round under way? Else sigma_job_begin begins one. */
static inline bool sigma_job_is_under_way(const sigma_job_t *job)
{
    return job->is_under_way;
}

/* Whoever calls it has written the inputs, all but the other loads. */
void sigma_job_take(sigma_job_t *job);

/* Begins a round. Whoever calls it has written all inputs. */
void sigma_job_begin(sigma_job_t *job);

/* A step of the round. At most 1,700 instructions in the plane, 1,500 in space. */
void sigma_job_step(sigma_job_t *job, const brace_parameters_t *parameters);

/* Writes what is known of K's uncertainty into a snapshot with a valid K. At most 300 instructions in the plane, 450 in
 * space. */
void sigma_job_tell(const sigma_job_t *job, const sigma_now_t *now, brace_snapshot_t *snapshot);

#endif
