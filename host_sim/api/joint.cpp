#include "api/checks.h"
#include "plant/joint_test.h"
#include "plant/model_keys.h"

extern "C" int32_t brace_plant_joint(const brace_plant_model_t *model, const brace_joint_rows_t *rows,
                                     double *out)
{
    using brace::api::all_finite;
    if (model == nullptr || rows == nullptr || out == nullptr || rows->t_s == nullptr
        || rows->input == nullptr) {
        return BRACE_HOST_E_NULL;
    }
    if (!all_finite(rows->t_s, rows->count) || !all_finite(rows->input, rows->count)
        || !brace::api::all_finite_if_given(rows->temp_degc, rows->count)
        || !brace::api::all_finite_if_given(rows->start_torque_n_mm, rows->count)) {
        return BRACE_HOST_E_NOT_FINITE;
    }
    if (rows->joint_index < 0 || rows->joint_index > 2
        || !(rows->reversal_rad >= 0.0 && rows->reversal_rad <= 1.0)) {
        return BRACE_HOST_E_RANGE;
    }
    // Each test has a clock of its own.
    for (size_t i = 1; i < rows->count; ++i) {
        const bool same_test = rows->test == nullptr || rows->test[i] == rows->test[i - 1];
        if (same_test && rows->t_s[i] < rows->t_s[i - 1]) {
            return BRACE_HOST_E_RANGE;
        }
    }
    if (brace::plant::first_fault(*model) != nullptr) {
        return BRACE_HOST_E_PARAMETER;
    }
    if (rows->torque_imposed == 0 && model->joint[rows->joint_index].compliance_rad_per_n_mm == 0.0) {
        return BRACE_HOST_E_SINGULAR;
    }
    brace::plant::play_joint(*model, *rows, out);
    return BRACE_HOST_OK;
}
