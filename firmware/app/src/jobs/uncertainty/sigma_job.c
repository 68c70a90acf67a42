#include "jobs/uncertainty/sigma_job.h"

#include "stiffness/stiffness.h"

#define CAUSES_FROM 1u
#define LOADS_FROM (CAUSES_FROM + BRACE_CAUSE_COUNT)
#define KS_OF_A_ROUND (LOADS_FROM + (uint32_t)(SIGMA_SIDES * BRACE_LINK_COUNT))
#define WAITS_TICKS_MOST \
    3u  /* so a round of 300 steps ends within 1,200 ticks where questions never end, and within
                              * 1,500 in a flood of commands, which leaves it each fifth tick, */
#define TRIES_IN_A_STEP 8u   /* of the causes that this limb may not have */
#define OLDEST_TICKS 3000u   /* and what it tells holds until the next has ended */
#define MOVED_MOST_RAD 0.05f /* of all joints together, since the samples that sigma comes from */
#define STIFFER_MOST 0.15f   /* K's change since then, as a share of K */
#define BEYOND_MOST 10.0f    /* times the load that a round has looked at: beyond nobody knows K */

void sigma_job_forget(sigma_job_t *job)
{
    job->told.is_there = job->has_inputs = job->is_under_way = job->work.is_under_way = false;
}

void sigma_job_age(sigma_job_t *job)
{
    job->ticks_waited = (uint8_t)(job->ticks_waited + (job->ticks_waited < UINT8_MAX));
    job->told.ticks_old = (uint16_t)(job->told.ticks_old + (job->told.ticks_old < UINT16_MAX));
    job->round.ticks_old = (uint16_t)(job->round.ticks_old + (job->round.ticks_old < UINT16_MAX));
}

bool sigma_job_is_overdue(const sigma_job_t *job)
{
    return job->ticks_waited > WAITS_TICKS_MOST;
}

void sigma_job_take(sigma_job_t *job)
{
    job->ticks_waited = 0;
    job->has_inputs = true;
}

void sigma_job_begin(sigma_job_t *job)
{
    const sigma_inputs_t *inputs = &job->inputs;
    job->ticks_waited = 0;
    job->next = 0;
    job->is_under_way = true;
    job->is_to_find = job->is_prepared = job->work.is_under_way = false;
    sigma_result_t *round = &job->round;
    round->taken_us = inputs->taken_us;
    round->kind = inputs->kind;
    round->ticks_old = 0;
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        round->unbent_rad[i] = inputs->k.angle_rad[i];
        round->load_counts[i] = inputs->load[i].counts;
        round->load_by_n_mm[i] = inputs->load[i].by_n_mm;
        round->by_load[i] = round->by_load_squared[i] = (brace_k_sigma_t){0};
    }
}

/* Without a K for one of the changed inputs nobody knows what K may be. */
static void end_round(sigma_job_t *job, bool is_there)
{
    job->round.is_there = is_there;
    job->told = job->round;
    job->is_under_way = job->work.is_under_way = false;
}

/* Changes the inputs for the next K. returns false where this leaves K as it is */
static bool change(const sigma_job_t *job, brace_k_inputs_t *inputs)
{
    if (job->next < CAUSES_FROM) {
        return true;
    }
    if (job->next < LOADS_FROM) {
        return brace_cause_change(job->next - CAUSES_FROM, job->inputs.is_spatial, inputs);
    }
    const uint32_t side = (job->next - LOADS_FROM) % (uint32_t)SIGMA_SIDES;
    const sigma_load_t *load = &job->inputs.load[(job->next - LOADS_FROM) / (uint32_t)SIGMA_SIDES];
    inputs->tip_n = load->tip_n[side];
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        inputs->spring[i] = load->spring[side][i];
    }
    return load->counts;
}

/* Prepares the limb of the next K that is another one, if it is among the next few. */
static void prepare_next(sigma_job_t *job, const brace_parameters_t *parameters)
{
    const uint32_t tried_before = job->next + TRIES_IN_A_STEP;
    job->changed_inputs = job->inputs.k;
    while (job->next < KS_OF_A_ROUND && !change(job, &job->changed_inputs)) {
        job->next++;
        if (job->next == tried_before) {
            return;
        }
    }
    if (job->next >= KS_OF_A_ROUND) {
        end_round(job, true);
        return;
    }
    model_configure_loaded(&job->changed, &job->changed_inputs.limb, &parameters->gravity, job->inputs.is_spatial);
    job->is_prepared = true;
}

static void begin_next(sigma_job_t *job)
{
    const brace_k_inputs_t *inputs = &job->changed_inputs;
    job->is_prepared = false;
    if (model_loaded_begin(&job->changed, inputs->angle_rad, inputs->spring, inputs->tip_n, job->inputs.down,
                           &job->work) != MODEL_LATER) {
        end_round(job, false);
    }
}

static brace_k3_t between(const brace_k3_t *a, const brace_k3_t *b)
{
    return (brace_k3_t){0.5f * (a->xx_n_per_mm + b->xx_n_per_mm), 0.5f * (a->xy_n_per_mm + b->xy_n_per_mm),
                        0.5f * (a->xz_n_per_mm + b->xz_n_per_mm), 0.5f * (a->yy_n_per_mm + b->yy_n_per_mm),
                        0.5f * (a->yz_n_per_mm + b->yz_n_per_mm), 0.5f * (a->zz_n_per_mm + b->zz_n_per_mm)};
}

/* K with a joint's load larger and smaller by the same: what lies between them changes with the load, and how far their
 * mean is from K changes with its square. The axis counts as changing with the load alone. */
static void take_in_load(sigma_job_t *job, uint32_t joint, const model_rest_t *smaller)
{
    sigma_result_t *round = &job->round;
    const float by_n_mm = job->inputs.load[joint].by_n_mm;
    const brace_stiffness_t *a = &job->larger_plane, *b = &smaller->plane;
    brace_k_base_t from_smaller = round->base;
    from_smaller.plane = *b;
    from_smaller.space = smaller->space;
    brace_sigma_add(&from_smaller, a, &job->larger_space, 2.0f * by_n_mm, &round->by_load[joint]);
    const brace_stiffness_t plane = {.k_xx_n_per_mm = 0.5f * (a->k_xx_n_per_mm + b->k_xx_n_per_mm),
                                     .k_xz_n_per_mm = 0.5f * (a->k_xz_n_per_mm + b->k_xz_n_per_mm),
                                     .k_zz_n_per_mm = 0.5f * (a->k_zz_n_per_mm + b->k_zz_n_per_mm),
                                     .lambda_min_n_per_mm = 0.5f * (a->lambda_min_n_per_mm + b->lambda_min_n_per_mm),
                                     .lambda_max_n_per_mm = 0.5f * (a->lambda_max_n_per_mm + b->lambda_max_n_per_mm),
                                     .stiff_axis_rad = round->base.plane.stiff_axis_rad};
    const brace_k3_t space = between(&job->larger_space, &smaller->space);
    brace_sigma_add(&round->base, &plane, &space, by_n_mm * by_n_mm, &round->by_load_squared[joint]);
}

/* Takes in the K that has been worked out. */
static void take_in(sigma_job_t *job, const model_rest_t *rest)
{
    sigma_result_t *round = &job->round;
    if (job->next >= LOADS_FROM) {
        const uint32_t number = job->next - LOADS_FROM;
        if (number % (uint32_t)SIGMA_SIDES == 0u) {
            job->larger_plane = rest->plane;
            job->larger_space = rest->space;
        } else {
            take_in_load(job, number / (uint32_t)SIGMA_SIDES, rest);
        }
    } else if (job->next >= CAUSES_FROM) {
        brace_sigma_add(&round->base, &rest->plane, &rest->space, BRACE_CAUSE_SIGMAS, &round->variance);
    } else {
        round->base.plane = rest->plane;
        round->base.space = rest->space;
        job->is_to_find = true;
    }
    job->next++;
}

/* What all changes of K are seen from. */
static void find_base(sigma_job_t *job)
{
    sigma_result_t *round = &job->round;
    const brace_stiffness_t plane = round->base.plane;
    const brace_k3_t space = round->base.space;
    const brace_k_inputs_t *inputs = &job->inputs.k;
    brace_k_base_find(&plane, &space, inputs->angle_rad[BRACE_COXA], job->inputs.is_spatial, &round->base);
    brace_sigma_begin(&round->base, inputs->angle_sigma_rad[BRACE_COXA], &round->variance);
    job->is_to_find = false;
}

void sigma_job_step(sigma_job_t *job, const brace_parameters_t *parameters)
{
    model_rest_t rest;
    job->ticks_waited = 0;
    if (job->is_to_find) {
        find_base(job);
        return;
    }
    if (!job->work.is_under_way) {
        if (job->is_prepared) {
            begin_next(job);
        } else {
            prepare_next(job, parameters);
        }
        return;
    }
    const int32_t status = model_loaded_go_on(&job->changed, &parameters->limb, &job->work, &rest);
    if (status == BRACE_OK) {
        take_in(job, &rest);
    } else if (status != MODEL_LATER) {
        end_round(job, false);
    }
}

/* --- what a tick says ------------------------------------------------------------------------------------------- */

static bool is_near(float now, float then, float most)
{
    return __builtin_fabsf(now - then) <= most;
}

/* Is the limb nearly as it was when the round began? */
static bool holds(const sigma_result_t *told, const sigma_now_t *now, const brace_stiffness_t *k)
{
    const brace_stiffness_t *then = &told->base.plane;
    const float xx_most = STIFFER_MOST * then->k_xx_n_per_mm, zz_most = STIFFER_MOST * then->k_zz_n_per_mm;
    float moved_rad = 0.0f;
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        const float moved = now->unbent_rad[i] - told->unbent_rad[i];
        moved_rad += i == BRACE_COXA && !told->base.is_spatial ? 0.0f : __builtin_fabsf(moved);
    }
    return told->is_there && told->kind == now->kind && told->ticks_old <= OLDEST_TICKS &&
           moved_rad <= MOVED_MOST_RAD && is_near(k->k_xx_n_per_mm, then->k_xx_n_per_mm, xx_most) &&
           is_near(k->k_zz_n_per_mm, then->k_zz_n_per_mm, zz_most) &&
           is_near(k->k_xz_n_per_mm, then->k_xz_n_per_mm, __builtin_sqrtf(xx_most * zz_most)) &&
           is_near(k->lambda_min_n_per_mm, then->lambda_min_n_per_mm, STIFFER_MOST * then->lambda_min_n_per_mm);
}

/* Adds what the loads of the joints may be off by: K may be anywhere up to where that load leads, to one side.
 * returns false: a bound is not known, or too far beyond what the round has looked at */
static bool add_loads(const sigma_result_t *told, const sigma_now_t *now, brace_k_sigma_t *variance)
{
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        if (!told->load_counts[i]) {
            continue;
        }
        const float off_n_mm = now->off_n_mm[i], square = off_n_mm * off_n_mm;
        if (!(__builtin_fabsf(off_n_mm) <= BEYOND_MOST * told->load_by_n_mm[i])) {
            return false;
        }
        brace_sigma_add_scaled(&told->by_load[i], square * (1.0f / 3.0f), variance);
        brace_sigma_add_scaled(&told->by_load_squared[i], square * square * (1.0f / 3.0f), variance);
    }
    return true;
}

void sigma_job_tell(const sigma_job_t *job, const sigma_now_t *now, brace_snapshot_t *snapshot)
{
    const sigma_result_t *told = &job->told;
    const brace_stiffness_t *k = &snapshot->stiffness.engaged;
    brace_k_sigma_t variance = told->variance, sigma;
    stiffness_unknown_sigma(snapshot);
    if (!holds(told, now, k) || !add_loads(told, now, &variance)) {
        return;
    }
    brace_sigma_end(&variance, &sigma);
    snapshot->sigma_is_known = true;
    snapshot->sigma_age_us = now->now_us - told->taken_us;
    snapshot->sigma = sigma.plane;
    snapshot->sigma.flags |= k->flags;
    if (told->base.is_spatial) {
        snapshot->sigma_space = sigma.space;
    }
}
