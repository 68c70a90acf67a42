#include "measure/force.h"

#include "motion/joints.h"

#define SENSOR_SIGMAS 6.0f
#define LEAST_DETERMINANT 1e-3f
#define LEAST_KNEE_SINE 0.1f
#define AGE_MOST_US 0x40000000u

void force_configure(brace_app_t *app)
{
    const brace_sensor_t *sensor = &app->parameters.sensor;
    brace_app_sensor_t *ours = &app->sensor;
    /* cosine and sine of the mounting's turn from a pose of the same angle: no libm here */
    const brace_limb_t ruler = {.femur_mm = 1.0f, .tibia_mm = 1.0f};
    brace_pose_t pose;
    if (brace_kinematics_forward(&ruler, sensor->rotation_rad, 0.0f, &pose) != BRACE_OK) {
        ours->fitted = false;
        return;
    }
    const float cosine = pose.knee.x_mm, sine = pose.knee.z_mm;
    /* reading = bias + gain R [[1, xz], [zx, 1]] force */
    const float a = sensor->gain * (cosine - sine * sensor->crosstalk_zx);
    const float b = sensor->gain * (cosine * sensor->crosstalk_xz - sine);
    const float c = sensor->gain * (sine + cosine * sensor->crosstalk_zx);
    const float d = sensor->gain * (sine * sensor->crosstalk_xz + cosine);
    const float determinant = a * d - b * c;
    ours->fitted = app->hal->tip_force_read != NULL && __builtin_fabsf(determinant) > LEAST_DETERMINANT;
    if (ours->fitted) {
        ours->inverse[0] = d / determinant;
        ours->inverse[1] = -b / determinant;
        ours->inverse[2] = -c / determinant;
        ours->inverse[3] = a / determinant;
    }
    ours->known = false;
    ours->age_us = AGE_MOST_US; /* no reading yet */
}

void force_sense(brace_app_t *app, brace_snapshot_t *snapshot)
{
    brace_app_sensor_t *ours = &app->sensor;
    float x_n = 0.0f, z_n = 0.0f;
    ours->known = snapshot->force_is_sensed = false;
    if (!ours->fitted) {
        return;
    }
    const int32_t answer = app->hal->tip_force_read(app->hal->context, &x_n, &z_n);
    const float saturation_n = app->parameters.sensor.saturation_n;
    if (answer == BRACE_HAL_OK) {
        ours->age_us = 0;
    } else if (ours->age_us < AGE_MOST_US) { /* AGAIN is the last reading, however old */
        ours->age_us += app->tick_us;
    }
    if ((answer == BRACE_HAL_OK || answer == BRACE_HAL_AGAIN) &&
        ours->age_us <= app->parameters.controller.age_limit_us && __builtin_fabsf(x_n) < saturation_n &&
        __builtin_fabsf(z_n) < saturation_n && __builtin_fabsf(x_n) < 1e6f && __builtin_fabsf(z_n) < 1e6f) {
        const float dx_n = x_n - app->parameters.sensor.bias_x_n, dz_n = z_n - app->parameters.sensor.bias_z_n;
        ours->x_n = ours->inverse[0] * dx_n + ours->inverse[1] * dz_n;
        ours->z_n = ours->inverse[2] * dx_n + ours->inverse[3] * dz_n;
        snapshot->force_x_n = ours->x_n;
        snapshot->force_z_n = ours->z_n;
        ours->known = snapshot->force_is_sensed = true;
    }
}

float force_gravity(const brace_app_t *app, int index)
{
    const brace_gravity_t *weight = &app->parameters.gravity;
    const float knee_mm = app->pose.knee.x_mm, shank_mm = 0.5f * (app->pose.tip.x_mm - knee_mm);
    /* theta2 is flexion: it turns the tibia clockwise, and its motor holds the other way */
    return index == 0
               ? (0.5f * weight->femur_n + weight->knee_n + weight->tibia_n) * knee_mm + weight->tibia_n * shank_mm
               : -weight->tibia_n * shank_mm;
}

void force_expect(const brace_app_t *app, int index, brace_backlash_sample_t *sample)
{
    const brace_app_sensor_t *ours = &app->sensor;
    if (!ours->known || !app->posed || app->play[index].backlash.phase != BRACE_TAKEUP_IDLE) {
        return; /* a take-up proves its flank by the load itself */
    }
    const brace_point_t lever = index == 0 ? app->pose.lever_femur : app->pose.lever_tibia;
    const float by_tip_n_mm = lever.x_mm * ours->x_n + lever.z_mm * ours->z_n;
    const float expected_n_mm = force_gravity(app, index) + (index == 0 ? -by_tip_n_mm : by_tip_n_mm);
    const brace_uncertainty_t *trust = &app->parameters.limb.uncertainty;
    const brace_drive_t *drive = &app->parameters.drive[BRACE_FEMUR + index];
    /* friction holds up to coulomb + ratio * |spring|, and the spring carries up to the load and that friction */
    const float friction_n_mm = (drive->coulomb_n_mm + drive->coulomb_per_load_ratio * __builtin_fabsf(expected_n_mm)) /
                                (1.0f - drive->coulomb_per_load_ratio);
    const float off_n_mm =
        SENSOR_SIGMAS * app->parameters.sensor.noise_n * (__builtin_fabsf(lever.x_mm) + __builtin_fabsf(lever.z_mm)) +
        (0.02f + SENSOR_SIGMAS * trust->gain_rel) * __builtin_fabsf(expected_n_mm) + friction_n_mm;
    sample->load_is_expected = true;
    sample->expected_n_mm = expected_n_mm;
    sample->expected_off_n_mm = off_n_mm;
}

void force_tell(const brace_app_t *app, brace_snapshot_t *snapshot)
{
    if (snapshot->force_is_sensed) {
        return;
    }
    const brace_point_t femur = app->pose.lever_femur, tibia = app->pose.lever_tibia;
    const float cross = femur.x_mm * tibia.z_mm - femur.z_mm * tibia.x_mm;
    snapshot->force_x_n = snapshot->force_z_n = __builtin_nanf("");
    if (__builtin_fabsf(cross) >= LEAST_KNEE_SINE * app->parameters.limb.femur_mm * app->parameters.limb.tibia_mm) {
        const float a = force_gravity(app, 0) - joints_load(snapshot, 0); /* lever_femur . force */
        const float b = joints_load(snapshot, 1) - force_gravity(app, 1); /* lever_tibia . force */
        snapshot->force_x_n = (a * tibia.z_mm - b * femur.z_mm) / cross;
        snapshot->force_z_n = (b * femur.x_mm - a * tibia.x_mm) / cross;
    }
}
