#include "posture/gravity.h"

#include "brace/kinematics.h"
#include "brace/ranges.h"

static void point(gravity_t *gravity, float direction_rad, float lean_rad)
{
    brace_vec_t down = {0.0f, -1.0f}, lean = {1.0f, 0.0f}; /* within their ranges, so the calls succeed */
    (void)brace_kinematics_direction(direction_rad, &down);
    (void)brace_kinematics_direction(lean_rad, &lean);
    gravity->direction_rad = direction_rad;
    gravity->lean_rad = lean_rad;
    gravity->down = (brace_vec3_t){lean.x * down.x, lean.z, lean.x * down.z};
}

void gravity_configure(gravity_t *gravity, const brace_gravity_t *parameters)
{
    if (!gravity->is_sent) {
        point(gravity, parameters->direction_rad, parameters->lean_rad);
    }
}

static bool is_within(float value, float least, float most)
{
    return value >= least && value <= most;
}

brace_status_t gravity_set(gravity_t *gravity, const brace_gravity_t *parameters, float direction_rad, float lean_rad)
{
    const bool has_direction = direction_rad == direction_rad, has_lean = lean_rad == lean_rad;
    if (has_direction != has_lean) {
        return BRACE_E_NOT_FINITE;
    }
    if (has_direction &&
        (!is_within(direction_rad, BRACE_RANGE_GRAVITY_DIRECTION_RAD_MIN, BRACE_RANGE_GRAVITY_DIRECTION_RAD_MAX) ||
         !is_within(lean_rad, BRACE_RANGE_GRAVITY_LEAN_RAD_MIN, BRACE_RANGE_GRAVITY_LEAN_RAD_MAX))) {
        return BRACE_E_RANGE;
    }
    gravity->is_sent = has_direction;
    if (has_direction) {
        point(gravity, direction_rad, lean_rad);
    } else {
        gravity_configure(gravity, parameters);
    }
    return BRACE_OK;
}
