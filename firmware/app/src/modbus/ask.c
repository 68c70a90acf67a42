#include <string.h>

#include "measure/hypothetical.h"
#include "modbus/command.h"

static void unknown(brace_answered_t *answered)
{
    const float nan = __builtin_nanf("");
    *answered = (brace_answered_t){nan, nan, nan, nan, nan, nan, UINT32_MAX};
}

void command_ask_nothing(brace_app_t *app)
{
    const float nan = __builtin_nanf("");
    memcpy(&app->modbus.asked[0], &nan, 4);
    memcpy(&app->modbus.asked[1], &nan, 4);
    unknown(&app->modbus.answered);
}

modbus_exception_t command_ask(brace_app_t *app, uint32_t theta1, uint32_t theta2)
{
    float theta1_rad, theta2_rad;
    brace_stiffness_t k;
    memcpy(&theta1_rad, &theta1, 4);
    memcpy(&theta2_rad, &theta2, 4);
    const brace_status_t status = hypothetical_stiffness(app, theta1_rad, theta2_rad, &k);
    if (status == BRACE_E_MODE) { /* the model is being made anew */
        return MODBUS_E_BUSY;
    }
    if (status == BRACE_E_NOT_FINITE || status == BRACE_E_RANGE) {
        return MODBUS_E_VALUE;
    }
    app->modbus.asked[0] = theta1;
    app->modbus.asked[1] = theta2;
    unknown(&app->modbus.answered);
    if (status == BRACE_OK) {
        app->modbus.answered = (brace_answered_t){.asked_k_xx_n_per_mm = k.k_xx_n_per_mm,
                                                  .asked_k_xz_n_per_mm = k.k_xz_n_per_mm,
                                                  .asked_k_zz_n_per_mm = k.k_zz_n_per_mm,
                                                  .asked_lambda_min_n_per_mm = k.lambda_min_n_per_mm,
                                                  .asked_lambda_max_n_per_mm = k.lambda_max_n_per_mm,
                                                  .asked_stiff_axis_rad = k.stiff_axis_rad,
                                                  .asked_flags = k.flags};
    }
    return MODBUS_FINE;
}
