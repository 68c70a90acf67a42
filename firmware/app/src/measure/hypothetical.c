#include "measure/hypothetical.h"

#include "measure/control.h"
#include "measure/model.h"

static bool inside(const brace_app_t *app, int joint, float theta_rad)
{
    const brace_drive_t *drive = &app->parameters.drive[joint];
    return theta_rad >= drive->angle_min_rad && theta_rad <= drive->angle_max_rad;
}

brace_status_t hypothetical_stiffness(brace_app_t *app, float theta1_rad, float theta2_rad,
                                      brace_stiffness_t *stiffness)
{
    float temp_degc[BRACE_APP_JOINTS], spring_rad_per_n_mm[BRACE_APP_JOINTS];
    if (app->configure_piece != 0u) {
        return BRACE_E_MODE;
    }
    control_temperatures(app, temp_degc);
    model_springs_at_rest(&app->model, temp_degc, spring_rad_per_n_mm);
    const brace_status_t status =
        model_stiffness(&app->model, theta1_rad, theta2_rad, spring_rad_per_n_mm, stiffness);
    if (status == BRACE_OK) {
        const bool travels = inside(app, BRACE_FEMUR, theta1_rad) && inside(app, BRACE_TIBIA, theta2_rad);
        stiffness->flags |= (travels ? 0u : (uint32_t)BRACE_FLAG_OUT_OF_RANGE) |
                            (app->origin == BRACE_PARAMETERS_DEFAULT ? (uint32_t)BRACE_FLAG_UNCALIBRATED : 0u);
    }
    return status;
}
