#include "sense/tip_force.h"

#include "brace/kinematics.h"

#define LEAST_DETERMINANT 1e-3f
#define AGE_MOST_US 0x40000000u
#define FORCE_ABSURD_N 1e6f

void tip_force_configure(tip_force_t *force, const brace_hal_t *hal, const brace_sensor_t *sensor)
{
    brace_vec_t turned;
    *force = (tip_force_t){.age_us = AGE_MOST_US};
    if (brace_kinematics_direction(sensor->rotation_rad, &turned) != BRACE_OK) {
        return;
    }
    const float cosine = turned.x, sine = turned.z;
    /* reading = bias + gain R [[1, crosstalk_xz], [crosstalk_zx, 1]] force; docs/physics.md */
    const float xx = sensor->gain * (cosine - sine * sensor->crosstalk_zx);
    const float xz = sensor->gain * (cosine * sensor->crosstalk_xz - sine);
    const float zx = sensor->gain * (sine + cosine * sensor->crosstalk_zx);
    const float zz = sensor->gain * (sine * sensor->crosstalk_xz + cosine);
    const float determinant = xx * zz - xz * zx;
    force->fitted = hal->tip_force_read != NULL && __builtin_fabsf(determinant) > LEAST_DETERMINANT;
    if (force->fitted) {
        force->inverse[0] = zz / determinant;
        force->inverse[1] = -xz / determinant;
        force->inverse[2] = -zx / determinant;
        force->inverse[3] = xx / determinant;
    }
}

static bool is_usable(float reading_n, float saturation_n)
{
    return __builtin_fabsf(reading_n) < saturation_n && __builtin_fabsf(reading_n) < FORCE_ABSURD_N;
}

void tip_force_read(tip_force_t *force, const brace_hal_t *hal, const brace_parameters_t *parameters, uint32_t since_us)
{
    const brace_sensor_t *sensor = &parameters->sensor;
    float x_n = 0.0f, z_n = 0.0f;
    if (!force->fitted) { /* tip_force_configure has set known to false */
        return;
    }
    const int32_t answer = hal->tip_force_read(hal->context, &x_n, &z_n);
    if (answer == BRACE_HAL_OK) {
        force->age_us = 0;
    } else { /* AGAIN repeats the last reading, however old */
        force->age_us = since_us < AGE_MOST_US - force->age_us ? force->age_us + since_us : AGE_MOST_US;
    }
    force->known = (answer == BRACE_HAL_OK || answer == BRACE_HAL_AGAIN) &&
                   force->age_us <= parameters->controller.age_limit_us && is_usable(x_n, sensor->saturation_n) &&
                   is_usable(z_n, sensor->saturation_n);
    if (force->known) {
        const float dx_n = x_n - sensor->bias_x_n, dz_n = z_n - sensor->bias_z_n;
        force->x_n = force->inverse[0] * dx_n + force->inverse[1] * dz_n;
        force->z_n = force->inverse[2] * dx_n + force->inverse[3] * dz_n;
    }
}
