#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "api/checks.h"
#include "api/reference_limb.h"
#include "plant/model_keys.h"
#include "reference/kinematics.h"
#include "reference/stiffness.h"

namespace {

using brace::api::all_finite;
using brace::api::lengths_of;
using brace::api::limb_of;
using brace::reference::Limb;
using brace::reference::Posture;

brace_host_status_t check(const brace_plant_model_t *model, size_t count, const double *theta1, const double *theta2,
                          const double *out)
{
    if (model == nullptr || theta1 == nullptr || theta2 == nullptr || out == nullptr) {
        return BRACE_HOST_E_NULL;
    }
    if (brace::plant::first_fault(*model) != nullptr) {
        return BRACE_HOST_E_PARAMETER;
    }
    return all_finite(theta1, count) && all_finite(theta2, count) ? BRACE_HOST_OK : BRACE_HOST_E_NOT_FINITE;
}

/* Writes a row for every posture, or none: if one of them has no K, out is untouched. */
template <size_t Entries, typename RowAt> int32_t all_rows(size_t count, double *out, RowAt row_at)
{
    std::vector<std::array<double, Entries>> rows(count);
    for (size_t i = 0; i < count; ++i) {
        if (!row_at(i, rows[i])) {
            return BRACE_HOST_E_SINGULAR;
        }
    }
    for (const auto &row : rows) {
        out = std::copy(row.begin(), row.end(), out);
    }
    return BRACE_HOST_OK;
}

} // namespace

extern "C" int32_t brace_reference_planar(const brace_plant_model_t *model, size_t count, const double *theta1_rad,
                                          const double *theta2_rad, double *out)
{
    const brace_host_status_t status = check(model, count, theta1_rad, theta2_rad, out);
    if (status != BRACE_HOST_OK) {
        return status;
    }
    const Limb limb = limb_of(*model);
    return all_rows<9>(count, out, [&](size_t i, std::array<double, 9> &row) {
        return brace::reference::planar(limb, Posture{theta1_rad[i], theta2_rad[i]}, row);
    });
}

extern "C" int32_t brace_reference_planar_many(const brace_plant_model_t *models, size_t model_count, size_t count,
                                               const double *theta1_rad, const double *theta2_rad, double *out,
                                               int32_t *status)
{
    if (models == nullptr || theta1_rad == nullptr || theta2_rad == nullptr || out == nullptr) {
        return BRACE_HOST_E_NULL;
    }
    int32_t worst = BRACE_HOST_OK;
    for (size_t m = 0; m < model_count; ++m) {
        double *const part = out + 9 * m * count;
        const int32_t one =
            brace_reference_planar(&models[m], count, theta1_rad + m * count, theta2_rad + m * count, part);
        if (one != BRACE_HOST_OK) {
            std::fill_n(part, 9 * count, std::numeric_limits<double>::quiet_NaN());
        }
        if (status != nullptr) {
            status[m] = one;
        }
        worst = worst == BRACE_HOST_OK ? one : worst;
    }
    return worst;
}

extern "C" int32_t brace_reference_spatial(const brace_plant_model_t *model, size_t count, const double *theta0_rad,
                                           const double *theta1_rad, const double *theta2_rad, double *out)
{
    if (theta0_rad == nullptr) {
        return BRACE_HOST_E_NULL;
    }
    const brace_host_status_t status = check(model, count, theta1_rad, theta2_rad, out);
    if (status != BRACE_HOST_OK) {
        return status;
    }
    if (!all_finite(theta0_rad, count)) {
        return BRACE_HOST_E_NOT_FINITE;
    }
    const Limb limb = limb_of(*model);
    return all_rows<18>(count, out, [&](size_t i, std::array<double, 18> &row) {
        return brace::reference::spatial(limb, theta0_rad[i], Posture{theta1_rad[i], theta2_rad[i]}, row);
    });
}

extern "C" int32_t brace_reference_tip(const brace_plant_model_t *model, size_t count, const double *theta0_rad,
                                       const double *theta1_rad, const double *theta2_rad, double *out)
{
    if (theta0_rad == nullptr) {
        return BRACE_HOST_E_NULL;
    }
    const brace_host_status_t status = check(model, count, theta1_rad, theta2_rad, out);
    if (status != BRACE_HOST_OK) {
        return status;
    }
    if (!all_finite(theta0_rad, count)) {
        return BRACE_HOST_E_NOT_FINITE;
    }
    for (size_t i = 0; i < count; ++i) {
        const auto tip = brace::reference::tip_mm(lengths_of(*model), theta0_rad[i], {theta1_rad[i], theta2_rad[i]});
        for (int axis = 0; axis < 3; ++axis) {
            out[3 * i + axis] = static_cast<double>(tip[axis]);
        }
    }
    return BRACE_HOST_OK;
}

extern "C" int32_t brace_reference_posture(const brace_plant_model_t *model, double r_mm, double phi_rad,
                                           int32_t knee_up, double *theta_rad)
{
    const brace_host_status_t status = check(model, 1, &r_mm, &phi_rad, theta_rad);
    if (status != BRACE_HOST_OK) {
        return status;
    }
    Posture posture{};
    if (!brace::reference::posture_at(lengths_of(*model), r_mm, phi_rad, knee_up != 0, posture)) {
        return BRACE_HOST_E_UNREACHABLE;
    }
    theta_rad[0] = static_cast<double>(posture.theta1_rad);
    theta_rad[1] = static_cast<double>(posture.theta2_rad);
    return BRACE_HOST_OK;
}
