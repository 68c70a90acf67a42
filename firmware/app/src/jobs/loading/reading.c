#include "jobs/loading/reading.h"

#include "stiffness/stiffness.h"

void reading_begin(brace_loading_t *test)
{
    test->sums = (brace_loading_sums_t){.count = 0};
}

void reading_add(brace_loading_t *test, const loading_inputs_t *inputs)
{
    brace_loading_sums_t *sums = &test->sums;
    const brace_snapshot_t *now = inputs->now;
    for (int i = 0; i < 2; i++) {
        const joint_t *joint = &inputs->joints->joint[BRACE_FEMUR + i];
        const brace_hal_joint_t *sample = &joint->sample;
        /* Differences from where the test began are small, so that their sums lose no digits. */
        sums->motor_rad[i] += sample->motor_rad - test->start_motor_rad[i];
        /* One encoder cannot tell what the gear gives way by. */
        sums->link_rad[i] += joint->is_link_only ? __builtin_nanf("") : sample->link_rad - sample->motor_rad;
    }
    sums->force_x_n += now->force_x_n;
    sums->force_z_n += now->force_z_n;
    sums->temp_degc += now->temp_degc;
    sums->count++;
    const bool is_first = sums->count == 1u;
    test->result.force_is_sensed = now->force_is_sensed && (is_first || test->result.force_is_sensed);
}

static brace_loading_sums_t mean_of(const brace_loading_sums_t *sums)
{
    const float share = 1.0f / (float)sums->count;
    return (brace_loading_sums_t){.motor_rad = {share * sums->motor_rad[0], share * sums->motor_rad[1]},
                                  .link_rad = {share * sums->link_rad[0], share * sums->link_rad[1]},
                                  .force_x_n = share * sums->force_x_n,
                                  .force_z_n = share * sums->force_z_n,
                                  .temp_degc = share * sums->temp_degc,
                                  .count = sums->count};
}

/* The ground holds the tip still while the joints move. Seen from the limb, the tip is displaced by the opposite of the
 * movement that the joints would give it. */
static void displacement_of(brace_loading_t *test, const float moved_rad[2])
{
    test->dx_mm = -(test->lever_femur.x_mm * moved_rad[0] + test->lever_knee.x_mm * moved_rad[1]);
    test->dz_mm = -(test->lever_femur.z_mm * moved_rad[0] + test->lever_knee.z_mm * moved_rad[1]);
}

/* The preload point: everything counts from here. returns whether there is a valid K to compare with */
static bool begin_at_preload(brace_loading_t *test, const loading_inputs_t *inputs, const brace_loading_sums_t *mean)
{
    const brace_snapshot_t *now = inputs->now;
    for (int i = 0; i < 2; i++) {
        test->start_motor_rad[i] += mean->motor_rad[i];
        test->start_link_rad[i] = mean->link_rad[i];
        test->standing_rad[i] = now->theta_rad[BRACE_FEMUR + i];
    }
    test->result.theta1_rad = inputs->posture->unbent_rad[BRACE_FEMUR] - test->behind_rad[BRACE_FEMUR];
    test->result.theta2_rad = inputs->posture->unbent_rad[BRACE_TIBIA] - test->behind_rad[BRACE_TIBIA];
    test->result.temp_degc = mean->temp_degc;
    test->result.preload_x_n = mean->force_x_n;
    test->result.preload_z_n = mean->force_z_n;
    test->model = now->stiffness.engaged;
    test->dx_mm = test->dz_mm = 0.0f;
    return now->k_is_valid && brace_slope_start(&test->slope, 0.0f, mean->force_x_n, mean->force_z_n) == BRACE_OK;
}

bool reading_add_to_slope(brace_loading_t *test, float fx_n, float fz_n)
{
    const brace_stiffness_t *k = &test->model;
    if (test->result.setup.axis == BRACE_AXIS_X) {
        return brace_slope_step(&test->slope, test->dx_mm, fx_n - k->k_xz_n_per_mm * test->dz_mm,
                                fz_n - k->k_zz_n_per_mm * test->dz_mm) == BRACE_OK;
    }
    return brace_slope_step(&test->slope, test->dz_mm, fx_n - k->k_xx_n_per_mm * test->dx_mm,
                            fz_n - k->k_xz_n_per_mm * test->dx_mm) == BRACE_OK;
}

static void record(const brace_loading_t *test, const brace_loading_sums_t *mean, brace_recorder_t *recorder)
{
    const brace_loading_result_t *result = &test->result;
    const brace_row_t row = {.run = result->run,
                             .config = result->config,
                             .axis = (uint8_t)result->setup.axis,
                             .rep = (uint8_t)result->rep,
                             .step = test->step,
                             .theta1_rad = result->theta1_rad,
                             .theta2_rad = result->theta2_rad,
                             .t_s = 1e-6f * (float)test->test_us,
                             .temp_degc = mean->temp_degc,
                             .dx_mm = test->dx_mm,
                             .dz_mm = test->dz_mm,
                             .fx_n = mean->force_x_n,
                             .fz_n = mean->force_z_n,
                             .enc1_rad = mean->link_rad[0] - test->start_link_rad[0],
                             .enc2_rad = test->start_link_rad[1] - mean->link_rad[1]};
    brace_recorder_add(recorder, &row);
}

bool reading_take(brace_loading_t *test, const loading_inputs_t *inputs, brace_recorder_t *recorder)
{
    if (test->sums.count == 0u) {
        return false;
    }
    const brace_loading_sums_t mean = mean_of(&test->sums);
    bool is_usable;
    if (test->step == 0u) {
        is_usable = begin_at_preload(test, inputs, &mean);
    } else {
        const bool commanded = test->result.setup.source == BRACE_LOADING_COMMANDED;
        const float moved_rad[2] = {commanded ? test->per_mm[0] * test->along_mm : mean.motor_rad[0],
                                    commanded ? test->per_mm[1] * test->along_mm : mean.motor_rad[1]};
        displacement_of(test, moved_rad);
        is_usable = reading_add_to_slope(test, mean.force_x_n, mean.force_z_n);
    }
    if (is_usable) {
        test->fx_n = mean.force_x_n;
        test->fz_n = mean.force_z_n;
        record(test, &mean, recorder);
        test->result.rows++;
    }
    return is_usable;
}

/* A step towards K at the preload point, where the mean of the forces is free of most of the sensor's noise.
 *   k (out): stays as it is where the preload folds the limb
 * returns whether it is there */
static bool k_under_preload(const brace_loading_t *test, const loading_inputs_t *inputs,
                            const brace_loaded_joint_t springs[BRACE_LINK_COUNT], brace_stiffness_t *k)
{
    const brace_limb_t *limb = &inputs->parameters->limb;
    const brace_vec3_t preload_n = {test->result.preload_x_n, inputs->now->load.force_y_n, test->result.preload_z_n};
    model_rest_t rest;
    const int32_t status = inputs->work->is_under_way
                               ? model_loaded_go_on(inputs->model, limb, inputs->work, &rest)
                               : model_loaded_begin(inputs->model, inputs->posture->unbent_rad, springs, preload_n,
                                                    inputs->down, inputs->work);
    if (status == BRACE_OK) {
        *k = rest.plane;
    }
    return status != MODEL_LATER;
}

bool reading_model_now(brace_loading_t *test, const loading_inputs_t *inputs)
{
    brace_loaded_joint_t springs[BRACE_LINK_COUNT];
    bool is_there = true;
    if (inputs->now->load.is_counted) {
        stiffness_springs_of_now(inputs->model, inputs->parameters, inputs->joints, inputs->flank, springs);
        stiffness_hold_measured_joints(inputs->posture, springs);
        is_there = k_under_preload(test, inputs, springs, &test->model);
    }
    test->at_reference = test->model;
    return is_there;
}

bool reading_model_at_reference(brace_loading_t *test, const loading_inputs_t *inputs)
{
    const float unknown = __builtin_nanf(""), temp_degc[BRACE_LINK_COUNT] = {unknown, unknown, unknown};
    brace_loaded_joint_t springs[BRACE_LINK_COUNT];
    if (!inputs->model->springs_change) {
        return true;
    }
    model_springs_at_rest(inputs->parameters, temp_degc, springs);
    stiffness_hold_measured_joints(inputs->posture, springs);
    if (!inputs->now->load.is_counted) {
        float across_n_per_mm;
        (void)model_stiffness(inputs->model, &inputs->parameters->limb, test->result.theta1_rad,
                              test->result.theta2_rad, springs, &test->at_reference, &across_n_per_mm);
        return true;
    }
    return k_under_preload(test, inputs, springs, &test->at_reference);
}

void reading_for_drift(brace_loading_t *test, const loading_inputs_t *inputs, loading_reading_t *reading)
{
    const brace_loading_result_t *result = &test->result;
    const uint32_t unfit = BRACE_FLAG_GAP_OPEN | BRACE_FLAG_UNCALIBRATED;
    const uint32_t side = result->setup.steps_per_side;
    if (test->step == 0u) { /* It shows no displacement: the check loses nothing when it begins with the second. */
        return;
    }
    const float warmer_degc = result->temp_degc - inputs->parameters->slow.reference_degc;
    const bool temperature_is_measured = __builtin_fabsf(warmer_degc) <= 200.0f;
    reading->is_there = true;
    reading->run_ends = test->step == side || test->step == 3u * side;
    reading->is_fit = result->force_is_sensed && (inputs->now->stiffness.now.flags & unfit) == 0u;
    reading->model = test->at_reference;
    reading->reading = (brace_drift_reading_t){.theta1_rad = test->standing_rad[0],
                                               .theta2_rad = test->standing_rad[1],
                                               .dx_mm = test->dx_mm,
                                               .dz_mm = test->dz_mm,
                                               .fx_n = test->fx_n,
                                               .fz_n = test->fz_n,
                                               .warmer_degc = temperature_is_measured ? warmer_degc : 0.0f};
}
