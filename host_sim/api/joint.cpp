#include <algorithm>
#include <limits>

#include "api/checks.h"
#include "plant/joint_test.h"
#include "plant/model_keys.h"

namespace {

using brace::plant::JointReading;

bool is_reversal(double rad)
{
    return rad >= 0.0 && rad <= 1.0;
}

brace_host_status_t check_joint_rows(const brace_joint_rows_t &rows)
{
    using brace::api::all_finite;
    using brace::api::all_finite_if_given;
    if (rows.t_s == nullptr || rows.input == nullptr) {
        return BRACE_HOST_E_NULL;
    }
    if (!all_finite(rows.t_s, rows.count) || !all_finite(rows.input, rows.count)
        || !all_finite_if_given(rows.temp_degc, rows.count)
        || !all_finite_if_given(rows.start_torque_n_mm, rows.count)) {
        return BRACE_HOST_E_NOT_FINITE;
    }
    if (rows.joint_index < 0 || rows.joint_index > 2 || !is_reversal(rows.reversal_rad)) {
        return BRACE_HOST_E_RANGE;
    }
    // Each test has a clock of its own.
    for (size_t i = 1; i < rows.count; ++i) {
        const bool same_test = rows.test == nullptr || rows.test[i] == rows.test[i - 1];
        if (same_test && rows.t_s[i] < rows.t_s[i - 1]) {
            return BRACE_HOST_E_RANGE;
        }
    }
    return BRACE_HOST_OK;
}

// One model on sound rows.
brace_host_status_t play_one(const brace_plant_model_t &model, const brace_joint_rows_t &rows,
                             const JointReading &reading, double *out)
{
    if (!is_reversal(reading.reversal_rad)) {
        return BRACE_HOST_E_RANGE;
    }
    if (!std::isfinite(reading.torque_offset_n_mm)) {
        return BRACE_HOST_E_NOT_FINITE;
    }
    if (brace::plant::first_fault(model) != nullptr) {
        return BRACE_HOST_E_PARAMETER;
    }
    if (rows.torque_imposed == 0 && model.joint[rows.joint_index].compliance_rad_per_n_mm == 0.0) {
        return BRACE_HOST_E_SINGULAR;
    }
    brace::plant::play_joint(model, rows, reading, out);
    return BRACE_HOST_OK;
}

} // namespace

extern "C" int32_t brace_plant_joint(const brace_plant_model_t *model, const brace_joint_rows_t *rows, double *out)
{
    if (model == nullptr || rows == nullptr || out == nullptr) {
        return BRACE_HOST_E_NULL;
    }
    const brace_host_status_t sound = check_joint_rows(*rows);
    return sound != BRACE_HOST_OK ? sound : play_one(*model, *rows, {rows->reversal_rad, 0.0}, out);
}

extern "C" int32_t brace_plant_joint_many(const brace_plant_model_t *models, size_t model_count,
                                          const brace_joint_rows_t *rows, const double *reversal_rad,
                                          const double *torque_offset_n_mm, double *out, int32_t *status)
{
    if (models == nullptr || rows == nullptr || reversal_rad == nullptr || torque_offset_n_mm == nullptr
        || out == nullptr) {
        return BRACE_HOST_E_NULL;
    }
    const brace_host_status_t sound = check_joint_rows(*rows);
    if (sound != BRACE_HOST_OK) {
        return sound;
    }
    brace_host_status_t worst = BRACE_HOST_OK;
    for (size_t m = 0; m < model_count; ++m) {
        double *const part = out + m * rows->count;
        const brace_host_status_t one = play_one(models[m], *rows, {reversal_rad[m], torque_offset_n_mm[m]}, part);
        if (one != BRACE_HOST_OK) {
            std::fill_n(part, rows->count, std::numeric_limits<double>::quiet_NaN());
        }
        if (status != nullptr) {
            status[m] = one;
        }
        worst = worst == BRACE_HOST_OK ? one : worst;
    }
    return worst;
}
