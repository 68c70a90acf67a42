#include "measure/loading_read.h"

#include "configure/keeping.h"
#include "measure/model.h"
#include "supervise/supervisor.h"

/* What is averaged. */
enum { MOTOR = 0, LINK = 2, FORCE_X = 4, FORCE_Z = 5, TEMP = 6, SUMS = 7 };

void loading_read_begin(brace_loading_t *test)
{
    for (int i = 0; i < SUMS; i++) {
        test->sum[i] = 0.0f;
    }
    test->summed = 0;
}

void loading_read_sample(brace_app_t *app, const brace_snapshot_t *snapshot)
{
    brace_loading_t *test = &app->loading;
    for (int i = 0; i < BRACE_APP_JOINTS; i++) {
        /* from where the test began: sums of differences lose nothing */
        test->sum[MOTOR + i] += snapshot->motor_rad[BRACE_FEMUR + i] - test->start_motor_rad[i];
        test->sum[LINK + i] += app->joint[i].sample.link_rad - app->joint[i].sample.motor_rad;
    }
    test->sum[FORCE_X] += snapshot->force_x_n;
    test->sum[FORCE_Z] += snapshot->force_z_n;
    test->sum[TEMP] += snapshot->temp_degc;
    test->summed++;
    test->result.force_is_sensed = snapshot->force_is_sensed && (test->summed == 1u || test->result.force_is_sensed);
}

/* Displacement of the tip against the limb: minus what the joints moved, through the levers. */
static void displaced(const brace_app_t *app, const float moved_rad[2], float *dx_mm, float *dz_mm)
{
    const brace_loading_t *test = &app->loading;
    *dx_mm = -(test->lever[0] * moved_rad[0] + test->lever[1] * moved_rad[1]);
    *dz_mm = -(test->lever[2] * moved_rad[0] + test->lever[3] * moved_rad[1]);
}

/* The preload point: everything counts from here. */
static bool begin(brace_app_t *app, const float mean[SUMS])
{
    brace_loading_t *test = &app->loading;
    const brace_snapshot_t *now = brace_app_snapshot(app);
    const brace_point_t femur = app->pose.lever_femur, tibia = app->pose.lever_tibia;
    test->lever[0] = femur.x_mm;
    test->lever[1] = -tibia.x_mm; /* theta2 is flexion */
    test->lever[2] = femur.z_mm;
    test->lever[3] = -tibia.z_mm;
    for (int i = 0; i < BRACE_APP_JOINTS; i++) {
        test->start_motor_rad[i] += mean[MOTOR + i];
        test->start_link_rad[i] = mean[LINK + i];
    }
    test->result.theta1_rad = now->theta_rad[BRACE_FEMUR];
    test->result.theta2_rad = now->theta_rad[BRACE_TIBIA];
    test->result.temp_degc = mean[TEMP];
    test->result.preload_x_n = mean[FORCE_X];
    test->result.preload_z_n = mean[FORCE_Z];
    test->model = now->stiffness.engaged;
    return now->k_is_valid && brace_slope_start(&test->slope, 0.0f, mean[FORCE_X], mean[FORCE_Z]) == BRACE_OK;
}

bool loading_add_to_slope(brace_loading_t *test, float fx_n, float fz_n)
{
    const brace_stiffness_t *k = &test->model;
    if (test->result.setup.axis == BRACE_AXIS_X) {
        return brace_slope_step(&test->slope, test->dx_mm, fx_n - k->k_xz_n_per_mm * test->dz_mm,
                                fz_n - k->k_zz_n_per_mm * test->dz_mm) == BRACE_OK;
    }
    return brace_slope_step(&test->slope, test->dz_mm, fx_n - k->k_xx_n_per_mm * test->dx_mm,
                            fz_n - k->k_xz_n_per_mm * test->dx_mm) == BRACE_OK;
}

static void record(brace_app_t *app, const float mean[SUMS])
{
    const brace_loading_t *test = &app->loading;
    const brace_loading_result_t *result = &test->result;
    const brace_row_t row = {.run = result->run, .config = result->config, .axis = (uint8_t)result->setup.axis,
                             .rep = (uint8_t)result->rep, .step = test->step,
                             .theta1_rad = result->theta1_rad, .theta2_rad = result->theta2_rad,
                             .t_s = 1e-6f * (float)test->test_us, .temp_degc = mean[TEMP],
                             .dx_mm = test->dx_mm, .dz_mm = test->dz_mm, .fx_n = mean[FORCE_X], .fz_n = mean[FORCE_Z],
                             .enc1_rad = mean[LINK] - test->start_link_rad[0],
                             .enc2_rad = test->start_link_rad[1] - mean[LINK + 1]};
    brace_recorder_add(&app->recorder, &row);
}

bool loading_read(brace_app_t *app)
{
    brace_loading_t *test = &app->loading;
    float mean[SUMS], moved_rad[BRACE_APP_JOINTS];
    if (test->summed == 0u) {
        return false;
    }
    const float share = 1.0f / (float)test->summed;
    for (int i = 0; i < SUMS; i++) {
        mean[i] = share * test->sum[i];
    }
    bool sound = true;
    if (test->step == 0u) {
        sound = begin(app, mean);
        test->dx_mm = test->dz_mm = 0.0f;
    } else {
        const bool commanded = test->result.setup.source == BRACE_LOADING_COMMANDED;
        for (int i = 0; i < BRACE_APP_JOINTS; i++) {
            moved_rad[i] = commanded ? test->per_mm[i] * test->along_mm : mean[MOTOR + i];
        }
        displaced(app, moved_rad, &test->dx_mm, &test->dz_mm);
        sound = loading_add_to_slope(test, mean[FORCE_X], mean[FORCE_Z]);
    }
    if (sound) {
        test->fx_n = mean[FORCE_X];
        test->fz_n = mean[FORCE_Z];
        record(app, mean);
        test->result.rows++;
    }
    return sound;
}

/* K as the detector wants it: at the reference temperature, whatever the joints' springs are now. */
static void model_at_reference(brace_app_t *app)
{
    brace_loading_t *test = &app->loading;
    const float unknown[BRACE_APP_JOINTS] = {__builtin_nanf(""), __builtin_nanf("")};
    float spring_rad_per_n_mm[BRACE_APP_JOINTS];
    test->at_reference = test->model;
    if (!app->model.collapsed) {
        model_springs_at_rest(&app->model, unknown, spring_rad_per_n_mm);
        (void)model_stiffness(&app->model, test->result.theta1_rad, test->result.theta2_rad, spring_rad_per_n_mm,
                              &test->at_reference);
    }
}

void loading_drift(brace_app_t *app)
{
    const brace_loading_t *test = &app->loading;
    const brace_loading_result_t *result = &test->result;
    if (test->step == 0u) {
        model_at_reference(app);
        return; /* the first reading shows no displacement: it costs the detector nothing to begin with the second */
    }
    const uint32_t unfit = BRACE_FLAG_GAP_OPEN | BRACE_FLAG_UNCALIBRATED;
    if (!result->force_is_sensed || (brace_app_snapshot(app)->stiffness.now.flags & unfit) != 0u) {
        (void)brace_drift_run(&app->drift); /* the readings after it need not go on where those before it were */
        return;
    }
    const float warmer_degc = result->temp_degc - app->parameters.slow.reference_degc;
    const bool measured = __builtin_fabsf(warmer_degc) <= 200.0f;
    const brace_drift_reading_t reading = {
        .theta1_rad = result->theta1_rad, .theta2_rad = result->theta2_rad, .dx_mm = test->dx_mm,
        .dz_mm = test->dz_mm, .fx_n = test->fx_n, .fz_n = test->fz_n, .warmer_degc = measured ? warmer_degc : 0.0f};
    (void)brace_drift_step(&app->drift, &app->parameters.limb, &test->at_reference, &reading);
    keeping_look(app);
    const uint32_t side = result->setup.steps_per_side;
    if (test->step == side || test->step == 3u * side) {
        (void)brace_drift_run(&app->drift); /* friction turns round with the motion */
    }
    if (app->drift.state == BRACE_DRIFT_DRIFTED) {
        supervisor_latch(app, BRACE_FAULT_MODEL_DRIFT);
    }
}

/* (measured - model) over the sigma of both. */
static float deviation(float measured, float sigma_measured, float model, float sigma_model)
{
    const float variance = sigma_measured * sigma_measured + sigma_model * sigma_model;
    return variance > 0.0f ? (measured - model) / __builtin_sqrtf(variance) : 0.0f;
}

bool loading_judge(brace_app_t *app)
{
    const brace_slope_t *slope = &app->loading.slope;
    brace_loading_result_t *result = &app->loading.result;
    return brace_slope_column(slope, BRACE_SLOPE_LEAST_SQUARES, &result->least_squares) == BRACE_OK &&
           brace_slope_column(slope, BRACE_SLOPE_MEAN_OF_RATIOS, &result->mean_of_ratios) == BRACE_OK;
}

void loading_compare(brace_app_t *app)
{
    brace_loading_result_t *result = &app->loading.result;
    const bool along_x = result->setup.axis == BRACE_AXIS_X;
    const brace_stiffness_t *model = &app->loading.model;
    brace_stiffness_sigma_t sigma;
    if (brace_uncertainty_known(&app->parameters.limb, result->theta1_rad, result->theta2_rad, model, &sigma) !=
        BRACE_OK) {
        sigma.k_xx_n_per_mm = sigma.k_xz_n_per_mm = sigma.k_zz_n_per_mm = __builtin_nanf("");
    }
    result->model_k_x_n_per_mm = along_x ? model->k_xx_n_per_mm : model->k_xz_n_per_mm;
    result->model_k_z_n_per_mm = along_x ? model->k_xz_n_per_mm : model->k_zz_n_per_mm;
    result->sigma_model_k_x_n_per_mm = along_x ? sigma.k_xx_n_per_mm : sigma.k_xz_n_per_mm;
    result->sigma_model_k_z_n_per_mm = along_x ? sigma.k_xz_n_per_mm : sigma.k_zz_n_per_mm;
}

void loading_tell(brace_app_t *app)
{
    brace_loading_result_t *result = &app->loading.result;
    result->z_x = deviation(result->least_squares.k_x_n_per_mm, result->least_squares.sigma_k_x_n_per_mm,
                            result->model_k_x_n_per_mm, result->sigma_model_k_x_n_per_mm);
    result->z_z = deviation(result->least_squares.k_z_n_per_mm, result->least_squares.sigma_k_z_n_per_mm,
                            result->model_k_z_n_per_mm, result->sigma_model_k_z_n_per_mm);
}
