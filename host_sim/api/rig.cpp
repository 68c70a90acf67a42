#include <algorithm>
#include <array>
#include <vector>

#include "api/checks.h"
#include "plant/model_keys.h"
#include "rig/record.h"
#include "rig/sequence.h"
#include "rig/slopes.h"

extern "C" void brace_rig_design_default(brace_rig_design_t *design)
{
    if (design != nullptr) {
        *design = brace::rig::paper_design();
    }
}

extern "C" size_t brace_rig_row_count(const brace_rig_design_t *design)
{
    return design != nullptr && brace::rig::is_sound(*design) ? brace::rig::reading_count(*design) : 0;
}

extern "C" int32_t brace_rig_play(const brace_rig_design_t *design, const brace_plant_model_t *model,
                                  const brace_rig_record_t *record)
{
    if (design == nullptr || record == nullptr) {
        return BRACE_HOST_E_NULL;
    }
    if (!brace::rig::is_sound(*design)) {
        return BRACE_HOST_E_RANGE;
    }
    if (model != nullptr && brace::plant::first_fault(*model) != nullptr) {
        return BRACE_HOST_E_PARAMETER;
    }
    return brace::rig::play(*design, model, *record);
}

extern "C" int32_t brace_rig_slopes(const brace_plant_model_t *model, size_t count, const double *theta1_rad,
                                    const double *theta2_rad, double step_mm, int32_t steps_per_side,
                                    int32_t least_squares, double *k)
{
    using brace::rig::SlopeRule;
    if (model == nullptr || theta1_rad == nullptr || theta2_rad == nullptr || k == nullptr) {
        return BRACE_HOST_E_NULL;
    }
    if (!brace::api::all_finite(theta1_rad, count) || !brace::api::all_finite(theta2_rad, count)) {
        return BRACE_HOST_E_NOT_FINITE;
    }
    if (!(step_mm > 0.0 && step_mm <= 100.0) || steps_per_side < 1 || steps_per_side > 10000) {
        return BRACE_HOST_E_RANGE;
    }
    if (brace::plant::first_fault(*model) != nullptr) {
        return BRACE_HOST_E_PARAMETER;
    }
    const SlopeRule rule = least_squares != 0 ? SlopeRule::LeastSquares : SlopeRule::MeanOfRatios;
    std::vector<std::array<double, 4>> measured(count);
    for (size_t i = 0; i < count; ++i) {
        const brace_host_status_t status = brace::rig::measure_stiffness(*model, theta1_rad[i], theta2_rad[i], step_mm,
                                                                         steps_per_side, rule, measured[i]);
        if (status != BRACE_HOST_OK) {
            return status;
        }
    }
    for (size_t i = 0; i < count; ++i) {
        std::copy(measured[i].begin(), measured[i].end(), k + 4 * i);
    }
    return BRACE_HOST_OK;
}

extern "C" int32_t brace_rig_zero_force_shift(const brace_plant_model_t *model, double theta1_rad, double theta2_rad,
                                              int32_t axis, double step_mm, int32_t steps_per_side, double *shift_mm)
{
    if (model == nullptr || shift_mm == nullptr) {
        return BRACE_HOST_E_NULL;
    }
    if (!std::isfinite(theta1_rad) || !std::isfinite(theta2_rad)) {
        return BRACE_HOST_E_NOT_FINITE;
    }
    if (axis < 0 || axis > 1 || !(step_mm > 0.0 && step_mm <= 100.0) || steps_per_side < 1 || steps_per_side > 10000) {
        return BRACE_HOST_E_RANGE;
    }
    if (brace::plant::first_fault(*model) != nullptr) {
        return BRACE_HOST_E_PARAMETER;
    }
    return brace::rig::zero_force_shift(*model, theta1_rad, theta2_rad, axis, step_mm, steps_per_side, *shift_mm);
}
