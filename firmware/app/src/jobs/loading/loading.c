#include "jobs/loading/loading.h"

#include "jobs/loading/levers.h"
#include "jobs/loading/reading.h"

#define TRAVEL_SPARE_RAD 0.01f
#define TORQUE_SHARE 0.95f       /* of the bound: a drive that limits its torque never passes it */
#define FORCE_ABSURD_N 1e7f
#define CORRECTION_US 50000.0f
#define CORRECTION_MOST_RAD 0.3f
#define CRAWL_RAD_PER_S 0.005f   /* at least: a small rest would need seconds to wind up against friction */
#define SETTLE_US 3000000u       /* the servos' time at most; then the step is read where it is */
#define THERE_SHARE 0.01f        /* of a step, of the joint that goes further */
#define NEAR_THERE 3.0f
#define RESTING_US 20000u        /* a motor on its way through the target does not rest this long */
#define TRIM_RATE_RAD_PER_S 0.1f
#define SAME_POSTURE_RAD 0.01f
#define TIME_SPARE_US 2000000u
#define TIME_MOST_US 3.0e9f

/* -------------------------------------------------------------------------------------------- start -- */

static bool is_inside(float value, float low, float high)
{
    return value >= low && value <= high;
}

/* Far out a float's last place is coarser than a tick's way at a slow rate: the shape would stand there for ever. */
static bool moves_everywhere(const brace_loading_setup_t *setup, uint32_t tick_us)
{
    const float furthest_mm = (float)setup->steps_per_side * setup->step_mm;
    return setup->rate_mm_per_s * 1e-6f * (float)tick_us >= BRACE_LOADING_LEAST_WAY * furthest_mm;
}

static bool setup_is_sound(const brace_loading_setup_t *setup)
{
    return (setup->axis == BRACE_AXIS_X || setup->axis == BRACE_AXIS_Z) && setup->steps_per_side >= 2u &&
           setup->steps_per_side <= 60u &&
           is_inside(setup->step_mm, BRACE_LOADING_LEAST_STEP_MM, BRACE_LOADING_MOST_STEP_MM) &&
           setup->dwell_us >= 20000u && setup->dwell_us <= 10000000u &&
           is_inside(setup->rate_mm_per_s, 1e-3f, 1000.0f) && is_inside(setup->force_max_n, 1e-6f, 1e6f) &&
           is_inside(setup->torque_max_n_mm, 1e-6f, 1e6f) &&
           (setup->source == BRACE_LOADING_ENCODED || setup->source == BRACE_LOADING_COMMANDED);
}

/* Numbers the run, the posture and the repeat, as a dataset's rows carry them. */
static void count_run(brace_loading_t *test, brace_axis_t axis, const float theta_rad[BRACE_LINK_COUNT])
{
    brace_loading_counts_t *counts = &test->counts;
    const bool is_elsewhere =
        counts->run == 0u || __builtin_fabsf(theta_rad[BRACE_FEMUR] - counts->config_theta_rad[0]) > SAME_POSTURE_RAD ||
        __builtin_fabsf(theta_rad[BRACE_TIBIA] - counts->config_theta_rad[1]) > SAME_POSTURE_RAD;
    counts->run++;
    if (is_elsewhere) {
        counts->config++;
        counts->rep[0] = counts->rep[1] = 0;
        counts->config_theta_rad[0] = theta_rad[BRACE_FEMUR];
        counts->config_theta_rad[1] = theta_rad[BRACE_TIBIA];
    }
    test->result.run = counts->run;
    test->result.config = counts->config;
    test->result.rep = counts->rep[axis]++;
}

static uint32_t step_count(const brace_loading_t *test)
{
    return 4u * test->result.setup.steps_per_side + 1u;
}

static float smaller_of(float a, float b)
{
    return a < b ? a : b;
}

/* Bounds and start of one joint. furthest_rad: a step of the joint that goes further */
static void prepare_joint(brace_loading_t *test, const loading_inputs_t *inputs, int i, float furthest_rad)
{
    const flank_joint_t *flank = &inputs->flank->joint[BRACE_FEMUR + i];
    const brace_drive_t *drive = &inputs->parameters->drive[BRACE_FEMUR + i];
    const bool held = flank->out.phase == BRACE_TAKEUP_HOLD;
    float most_n_mm = smaller_of(test->result.setup.torque_max_n_mm, drive->torque_range_n_mm);
    if (held) {
        most_n_mm = smaller_of(most_n_mm, flank->machine.params.takeup.torque_max_n_mm);
    }
    test->held[i] = held;
    test->torque_max_n_mm[i] = most_n_mm;
    /* Within this nothing is corrected: an encoder knows no finer, and a servo that sticks would go to and fro. */
    test->there_rad[i] = THERE_SHARE * furthest_rad + drive->angle_step_rad;
    test->start_motor_rad[i] = inputs->joints->joint[BRACE_FEMUR + i].sample.motor_rad;
}

/* The way of a step, by the levers of now. returns false where they do not allow it */
static bool set_out(brace_loading_t *test, const loading_inputs_t *inputs)
{
    const brace_loading_setup_t *setup = &test->result.setup;
    if (!levers_offsets_per_mm(test, &inputs->parameters->limb, setup->axis, test->per_mm)) {
        return false;
    }
    const float femur_rad = __builtin_fabsf(test->per_mm[0]), tibia_rad = __builtin_fabsf(test->per_mm[1]);
    for (int i = 0; i < 2; i++) {
        prepare_joint(test, inputs, i, setup->step_mm * (femur_rad > tibia_rad ? femur_rad : tibia_rad));
    }
    return true;
}

/* The test as it would begin now. returns as loading_start; only with BRACE_OK it can begin */
static brace_status_t made(const brace_loading_t *test, const loading_inputs_t *inputs,
                           const brace_loading_setup_t *setup, brace_loading_t *next)
{
    if (!setup_is_sound(setup) || !moves_everywhere(setup, inputs->parameters->controller.tick_us)) {
        return BRACE_E_RANGE;
    }
    *next = (brace_loading_t){
        .phase = LOADING_LISTEN, .counts = test->counts, .result = {.outcome = BRACE_LOADING_RUNNING, .setup = *setup}};
    levers_begin(next, inputs);
    return inputs->now->k_is_valid && set_out(next, inputs) ? BRACE_OK : BRACE_E_SINGULAR;
}

brace_status_t loading_may_start(const brace_loading_t *test, const loading_inputs_t *inputs,
                                 const brace_loading_setup_t *setup)
{
    brace_loading_t next;
    return made(test, inputs, setup, &next);
}

brace_status_t loading_start(brace_loading_t *test, const loading_inputs_t *inputs, const brace_loading_setup_t *setup)
{
    brace_loading_t next;
    const brace_status_t status = made(test, inputs, setup, &next);
    if (status != BRACE_OK) {
        return status;
    }
    *test = next;
    count_run(test, setup->axis, inputs->posture->unbent_rad);
    const float step_us = 2.0f * ((float)setup->dwell_us + 1e6f * setup->step_mm / setup->rate_mm_per_s);
    const float all_us = (float)step_count(test) * (step_us + (float)SETTLE_US);
    test->limit_us = (uint32_t)smaller_of(all_us, TIME_MOST_US) + TIME_SPARE_US;
    return BRACE_OK;
}

void loading_end(brace_loading_t *test, brace_loading_outcome_t outcome)
{
    if (loading_runs(test)) {
        if (test->result.outcome == BRACE_LOADING_RUNNING) {
            test->result.outcome = outcome;
        }
        test->phase = LOADING_RETURN;
    }
}

/* ----------------------------------------------------------------------------------------- movement -- */

/* Where step `step` of the pass 0 -> +n -> 0 -> -n -> 0 stands, in steps from its middle. */
static int32_t place_of(uint32_t step, uint32_t per_side)
{
    const int32_t at = (int32_t)step, n = (int32_t)per_side;
    return at <= n ? at : at <= 3 * n ? 2 * n - at : at - 4 * n;
}

static float nearer(float value, float target, float step)
{
    return value < target - step ? value + step : value > target + step ? value - step : target;
}

static float limited(float value, float most)
{
    return value > most ? most : value < -most ? -most : value;
}

static float offset_of(const brace_loading_t *test, int i)
{
    return (test->per_mm[i] + test->give_rad_per_mm[i]) * test->along_mm + test->trim_rad[i];
}

float loading_offset_rad(const brace_loading_t *test, int joint_index)
{
    return joint_index == BRACE_COXA ? 0.0f : offset_of(test, joint_index - BRACE_FEMUR);
}

float loading_torque_limit_n_mm(const brace_loading_t *test, int joint_index)
{
    return joint_index == BRACE_COXA ? __builtin_inff() : test->torque_max_n_mm[joint_index - BRACE_FEMUR];
}

/* The bound that this tick's samples break; RUNNING: none. */
static brace_loading_outcome_t broken_bound(const brace_loading_t *test, const loading_inputs_t *inputs)
{
    const brace_snapshot_t *now = inputs->now;
    const float most_n = test->result.setup.force_max_n;
    if (!(__builtin_fabsf(now->force_x_n) <= FORCE_ABSURD_N && __builtin_fabsf(now->force_z_n) <= FORCE_ABSURD_N)) {
        return BRACE_LOADING_E_NO_FORCE;
    }
    if (test->result.rows > 0u && (__builtin_fabsf(now->force_x_n - test->result.preload_x_n) > most_n ||
                                   __builtin_fabsf(now->force_z_n - test->result.preload_z_n) > most_n)) {
        return BRACE_LOADING_E_FORCE;
    }
    for (int i = 0; i < 2; i++) {
        const joint_t *joint = &inputs->joints->joint[BRACE_FEMUR + i];
        const float moved_rad = joint->sample.motor_rad - test->start_motor_rad[i];
        if (test->held[i] && inputs->flank->joint[BRACE_FEMUR + i].out.phase != BRACE_TAKEUP_HOLD) {
            return BRACE_LOADING_E_LOST;
        }
        if (__builtin_fabsf(joint->torque_n_mm) > TORQUE_SHARE * test->torque_max_n_mm[i]) {
            return BRACE_LOADING_E_TORQUE;
        }
        if (__builtin_fabsf(moved_rad) > 2.0f * __builtin_fabsf(offset_of(test, i)) + TRAVEL_SPARE_RAD) {
            return BRACE_LOADING_E_TRAVEL;
        }
    }
    if (!inputs->posture->is_inside_travel) {
        return BRACE_LOADING_E_TRAVEL;
    }
    return test->test_us > test->limit_us ? BRACE_LOADING_E_TIME : BRACE_LOADING_RUNNING;
}

/* Raises the offsets by what the servos give way by under load, so that the motors stand where the step wants them. A
 * linear limb needs the same per millimetre at each step, so what one step has learned serves the next. Where the free
 * shape is at its rest there is nothing per millimetre: what friction holds back there is trimmed.
 * returns whether the motors are there */
static bool correct(brace_loading_t *test, const loading_inputs_t *inputs)
{
    const uint32_t tick_us = inputs->parameters->controller.tick_us;
    const float gain = (float)tick_us / CORRECTION_US, along_mm = test->along_mm;
    const float crawl_rad = CRAWL_RAD_PER_S * 1e-6f * (float)tick_us;
    bool there = true;
    if (test->result.setup.source != BRACE_LOADING_ENCODED) {
        return true;
    }
    for (int i = 0; i < 2; i++) {
        const float moved_rad = inputs->joints->joint[BRACE_FEMUR + i].sample.motor_rad - test->start_motor_rad[i];
        const float off_rad = test->per_mm[i] * along_mm - moved_rad;
        const float near_rad = test->rests[i] ? NEAR_THERE * test->there_rad[i] : test->there_rad[i];
        test->rests[i] = __builtin_fabsf(off_rad) <= near_rad;
        if (test->rests[i]) {
            continue;
        }
        there = false;
        const float more_rad = gain * off_rad + (off_rad > 0.0f ? crawl_rad : -crawl_rad);
        if (along_mm == 0.0f) {
            test->trim_rad[i] = limited(test->trim_rad[i] + more_rad, CORRECTION_MOST_RAD);
        } else {
            test->give_rad_per_mm[i] = limited(test->give_rad_per_mm[i] + more_rad / along_mm,
                                               CORRECTION_MOST_RAD / __builtin_fabsf(along_mm));
        }
    }
    return there;
}

static void move(brace_loading_t *test, const loading_inputs_t *inputs, float step_mm)
{
    const brace_loading_setup_t *setup = &test->result.setup;
    const uint32_t tick_us = inputs->parameters->controller.tick_us;
    /* The free shape goes the other way: the tip stays, and is displaced against it. */
    const float target_mm = -setup->step_mm * (float)place_of(test->step, setup->steps_per_side);
    if (test->along_mm != target_mm) {
        test->along_mm = nearer(test->along_mm, target_mm, step_mm);
        test->rests[0] = test->rests[1] = false;
        test->resting_us = 0;
        test->phase_us = 0;
        return;
    }
    test->phase_us += tick_us;
    test->resting_us = correct(test, inputs) ? test->resting_us + tick_us : 0u;
    if (test->resting_us >= RESTING_US || test->phase_us >= SETTLE_US) {
        test->phase = LOADING_DWELL;
        test->phase_us = 0;
        reading_begin(test);
    }
}

static void dwell(brace_loading_t *test, const loading_inputs_t *inputs)
{
    test->phase_us += inputs->parameters->controller.tick_us;
    if (2u * test->phase_us <= test->result.setup.dwell_us) {
        (void)correct(test, inputs);
    } else {
        reading_add(test, inputs);
    }
    if (test->phase_us >= test->result.setup.dwell_us) {
        test->phase = LOADING_READ;
    }
}

static void go_back(brace_loading_t *test, const loading_inputs_t *inputs, float step_mm)
{
    const float trim_step_rad = TRIM_RATE_RAD_PER_S * 1e-6f * (float)inputs->parameters->controller.tick_us;
    test->along_mm = nearer(test->along_mm, 0.0f, step_mm);
    for (int i = 0; i < 2; i++) {
        test->trim_rad[i] = nearer(test->trim_rad[i], 0.0f, trim_step_rad);
    }
    if (test->along_mm == 0.0f && test->trim_rad[0] == 0.0f && test->trim_rad[1] == 0.0f) {
        test->phase = LOADING_IDLE;
    }
}

static void listen(brace_loading_t *test, const loading_inputs_t *inputs)
{
    if (!levers_listen(test, inputs)) {
        test->phase = LOADING_LEVERS;
    }
}

static void find_levers(brace_loading_t *test, const loading_inputs_t *inputs)
{
    if (!levers_work(test, inputs)) {
        return;
    }
    inputs->work->is_under_way = false; /* also where the load has been lost on the way */
    test->phase = LOADING_MOVE;
    if (!set_out(test, inputs)) {
        loading_end(test, BRACE_LOADING_E_FLAT);
    }
}

/* ---------------------------------------------------------------------------------------- judgement -- */

static void read(brace_loading_t *test, const loading_inputs_t *inputs, brace_recorder_t *recorder,
                 loading_reading_t *reading)
{
    if (!reading_take(test, inputs, recorder)) {
        loading_end(test, BRACE_LOADING_E_NO_FORCE);
        return;
    }
    reading_for_drift(test, inputs, reading);
    const bool is_first = test->step++ == 0u;
    test->phase = is_first ? LOADING_MODEL : test->step < step_count(test) ? LOADING_MOVE : LOADING_JUDGE;
}

static void find_model(brace_loading_t *test, const loading_inputs_t *inputs)
{
    if (reading_model_now(test, inputs)) {
        test->phase = LOADING_REFERENCE;
    }
}

static void find_reference(brace_loading_t *test, const loading_inputs_t *inputs)
{
    if (reading_model_at_reference(test, inputs)) {
        test->phase = LOADING_MOVE;
    }
}

static void judge(brace_loading_t *test)
{
    brace_loading_result_t *result = &test->result;
    const brace_slope_t *slope = &test->slope;
    const bool has_slopes = brace_slope_column(slope, BRACE_SLOPE_LEAST_SQUARES, &result->least_squares) == BRACE_OK &&
                            brace_slope_column(slope, BRACE_SLOPE_MEAN_OF_RATIOS, &result->mean_of_ratios) == BRACE_OK;
    if (has_slopes) {
        test->phase = LOADING_COMPARE;
    } else {
        loading_end(test, BRACE_LOADING_E_FLAT);
    }
}

/* (measured - model) over the sigma of both; NaN where the sigma is not known. */
static float deviation(float measured, float sigma_measured, float model, float sigma_model)
{
    const float variance = sigma_measured * sigma_measured + sigma_model * sigma_model;
    return variance > 0.0f ? (measured - model) / __builtin_sqrtf(variance) : __builtin_nanf("");
}

static void compare(brace_loading_t *test, const brace_limb_t *limb)
{
    brace_loading_result_t *result = &test->result;
    const bool along_x = result->setup.axis == BRACE_AXIS_X;
    const brace_stiffness_t *model = &test->model;
    const brace_slope_column_t *measured = &result->least_squares;
    brace_stiffness_sigma_t sigma;
    if (brace_uncertainty_known(limb, result->theta1_rad, result->theta2_rad, model, &sigma) != BRACE_OK) {
        sigma.k_xx_n_per_mm = sigma.k_xz_n_per_mm = sigma.k_zz_n_per_mm = __builtin_nanf("");
    }
    result->model_k_x_n_per_mm = along_x ? model->k_xx_n_per_mm : model->k_xz_n_per_mm;
    result->model_k_z_n_per_mm = along_x ? model->k_xz_n_per_mm : model->k_zz_n_per_mm;
    result->sigma_model_k_x_n_per_mm = along_x ? sigma.k_xx_n_per_mm : sigma.k_xz_n_per_mm;
    result->sigma_model_k_z_n_per_mm = along_x ? sigma.k_xz_n_per_mm : sigma.k_zz_n_per_mm;
    result->z_x = deviation(measured->k_x_n_per_mm, measured->sigma_k_x_n_per_mm, result->model_k_x_n_per_mm,
                            result->sigma_model_k_x_n_per_mm);
    result->z_z = deviation(measured->k_z_n_per_mm, measured->sigma_k_z_n_per_mm, result->model_k_z_n_per_mm,
                            result->sigma_model_k_z_n_per_mm);
}

void loading_step(brace_loading_t *test, const loading_inputs_t *inputs)
{
    const uint32_t tick_us = inputs->parameters->controller.tick_us;
    const float step_mm = test->result.setup.rate_mm_per_s * 1e-6f * (float)tick_us;
    test->test_us += loading_runs(test) ? tick_us : 0u;
    if (test->phase == LOADING_MOVE || test->phase == LOADING_DWELL) {
        const brace_loading_outcome_t broken = broken_bound(test, inputs);
        if (broken != BRACE_LOADING_RUNNING) {
            loading_end(test, broken);
            return;
        }
    }
    switch (test->phase) {
    case LOADING_LISTEN: listen(test, inputs); break;
    case LOADING_MOVE: move(test, inputs, step_mm); break;
    case LOADING_DWELL: dwell(test, inputs); break;
    case LOADING_RETURN: go_back(test, inputs, step_mm); break;
    default: break; /* nothing moves while loading_work works */
    }
}

bool loading_work(brace_loading_t *test, const loading_inputs_t *inputs, brace_recorder_t *recorder,
                  loading_reading_t *reading)
{
    reading->is_there = false;
    switch (test->phase) {
    case LOADING_LEVERS: find_levers(test, inputs); return true;
    case LOADING_READ: read(test, inputs, recorder, reading); return true;
    case LOADING_MODEL: find_model(test, inputs); return true;
    case LOADING_REFERENCE: find_reference(test, inputs); return true;
    case LOADING_JUDGE: judge(test); return true;
    case LOADING_COMPARE:
        compare(test, &inputs->parameters->limb);
        loading_end(test, BRACE_LOADING_DONE);
        return true;
    default: return false;
    }
}
