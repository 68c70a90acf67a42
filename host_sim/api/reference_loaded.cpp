#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "api/checks.h"
#include "api/reference_limb.h"
#include "plant/model_keys.h"
#include "reference/loaded.h"

namespace {

using brace::api::all_finite;
using brace::reference::Outcome;
using brace::reference::Posture;
using brace::reference::Result;
using brace::reference::Vector3d;
using brace::reference::Weights;

constexpr int32_t kMostParts = 1000;
constexpr double kUnitLength = 1e-6; // how far a unit vector's length may be off
constexpr double kQuarterTurn = 1.57079632679489661923;

enum class Given { force, displacement };

// A case in the limb's plane frame, and how its results come back from there.
struct Question {
    Posture posture;
    Weights weights;
    Vector3d force_n, displacement_mm;
    bool with_coxa;
};

Weights weights_of(const brace_plant_model_t &model, const Vector3d &direction)
{
    return {model.gravity.femur_n, model.gravity.tibia_n, model.gravity.knee_n, direction};
}

Question question_of(const brace_plant_model_t &model, const brace_loaded_case_t &given)
{
    const Vector3d down = {std::cos(given.gravity_rad), 0.0, std::sin(given.gravity_rad)};
    return {{given.theta1_rad, given.theta2_rad},
            weights_of(model, down),
            {given.fx_n, 0.0, given.fz_n},
            {given.dx_mm, 0.0, given.dz_mm},
            false};
}

// From the commanded limb's plane to the robot's base frame.
Eigen::Matrix3d yaw(double theta0_rad)
{
    const double cosine = std::cos(theta0_rad), sine = std::sin(theta0_rad);
    Eigen::Matrix3d turn;
    turn << cosine, -sine, 0.0, sine, cosine, 0.0, 0.0, 0.0, 1.0;
    return turn;
}

Question question_of(const brace_plant_model_t &model, const brace_loaded_space_case_t &given)
{
    const Eigen::Matrix3d to_plane = yaw(given.theta0_rad).transpose();
    const Vector3d down = Vector3d(given.gravity_x, given.gravity_y, given.gravity_z).normalized();
    return {{given.theta1_rad, given.theta2_rad},
            weights_of(model, to_plane * down),
            to_plane * Vector3d(given.fx_n, given.fy_n, given.fz_n),
            to_plane * Vector3d(given.dx_mm, given.dy_mm, given.dz_mm),
            true};
}

bool gravity_is_sound(const brace_loaded_case_t &)
{
    return true;
}

bool gravity_is_sound(const brace_loaded_space_case_t &given)
{
    const double length = Vector3d(given.gravity_x, given.gravity_y, given.gravity_z).norm();
    return std::fabs(length - 1.0) <= kUnitLength;
}

void write(const brace_loaded_case_t &, const Result &from, brace_loaded_result_t &to)
{
    const Eigen::Matrix3d &k = from.k_n_per_mm;
    const brace::reference::Spectrum spectrum = brace::reference::spectrum(k, 2);
    double axis_rad = std::atan2(spectrum.vectors(1, 1), spectrum.vectors(0, 1));
    if (axis_rad > kQuarterTurn) {
        axis_rad -= 2.0 * kQuarterTurn;
    } else if (axis_rad <= -kQuarterTurn) {
        axis_rad += 2.0 * kQuarterTurn;
    }
    to.dx_mm = from.displacement_mm.x();
    to.dz_mm = from.displacement_mm.z();
    to.fx_n = from.force_n.x();
    to.fz_n = from.force_n.z();
    to.k_xx = k(0, 0);
    to.k_xz = 0.5 * (k(0, 1) + k(1, 0));
    to.k_zz = k(1, 1);
    to.lambda_min = spectrum.values[0];
    to.lambda_max = spectrum.values[1];
    to.axis_rad = axis_rad;
    to.buckling_factor = from.buckling_factor;
    to.femur_rad = from.joint_rad[1];
    to.tibia_rad = from.joint_rad[2];
    to.femur_n_mm = from.joint_n_mm[1];
    to.tibia_n_mm = from.joint_n_mm[2];
    to.base_x_mm = from.base_x_mm;
    to.base_z_mm = from.base_z_mm;
    to.base_rad = from.base_rad;
}

void write(const brace_loaded_space_case_t &given, const Result &from, brace_loaded_space_result_t &to)
{
    const Eigen::Matrix3d from_plane = yaw(given.theta0_rad);
    const Vector3d displacement_mm = from_plane * from.displacement_mm;
    const Vector3d force_n = from_plane * from.force_n;
    const Eigen::Matrix3d k = from_plane * from.k_n_per_mm * from_plane.transpose();
    to.dx_mm = displacement_mm.x();
    to.dy_mm = displacement_mm.y();
    to.dz_mm = displacement_mm.z();
    to.fx_n = force_n.x();
    to.fy_n = force_n.y();
    to.fz_n = force_n.z();
    to.k_xx = k(0, 0);
    to.k_xy = 0.5 * (k(0, 1) + k(1, 0));
    to.k_xz = 0.5 * (k(0, 2) + k(2, 0));
    to.k_yy = k(1, 1);
    to.k_yz = 0.5 * (k(1, 2) + k(2, 1));
    to.k_zz = k(2, 2);
    to.buckling_factor = from.buckling_factor;
    to.coxa_rad = from.joint_rad[0];
    to.femur_rad = from.joint_rad[1];
    to.tibia_rad = from.joint_rad[2];
    to.coxa_n_mm = from.joint_n_mm[0];
    to.femur_n_mm = from.joint_n_mm[1];
    to.tibia_n_mm = from.joint_n_mm[2];
    to.base_x_mm = from.base_x_mm;
    to.base_z_mm = from.base_z_mm;
    to.base_rad = from.base_rad;
}

// Both structs hold doubles only.
template <typename Struct> double *numbers(Struct &doubles)
{
    static_assert(sizeof(Struct) % sizeof(double) == 0);
    return reinterpret_cast<double *>(&doubles);
}

template <typename Case, typename ResultRow>
int32_t answer(const brace_plant_model_t &model, const brace::reference::Limb &limb, const Case &given, Given what,
               int parts, ResultRow &row)
{
    Case copy = given;
    if (!all_finite(numbers(copy), sizeof(Case) / sizeof(double))) {
        return BRACE_HOST_E_NOT_FINITE;
    }
    if (!gravity_is_sound(given)) {
        return BRACE_HOST_E_RANGE;
    }
    const Question asked = question_of(model, given);
    Result result;
    const Outcome outcome =
        what == Given::force
            ? under_force(limb, asked.posture, asked.weights, asked.force_n, asked.with_coxa, parts, result)
            : under_displacement(limb, asked.posture, asked.weights, asked.displacement_mm, asked.with_coxa, parts,
                                 result);
    if (outcome == Outcome::found) {
        write(given, result, row);
    }
    return outcome == Outcome::found   ? BRACE_HOST_OK
           : outcome == Outcome::rigid ? BRACE_HOST_E_SINGULAR
                                       : BRACE_HOST_E_NO_CONVERGENCE;
}

template <typename Case, typename ResultRow>
int32_t answer_all(const brace_plant_model_t *model, size_t count, const Case *cases, Given what, int32_t parts,
                   ResultRow *results, int32_t *status)
{
    if (model == nullptr || cases == nullptr || results == nullptr) {
        return BRACE_HOST_E_NULL;
    }
    if (parts < -kMostParts || parts > kMostParts) {
        return BRACE_HOST_E_RANGE;
    }
    if (brace::plant::first_fault(*model) != nullptr) {
        return BRACE_HOST_E_PARAMETER;
    }
    const auto limb = brace::api::limb_of(*model);
    int32_t first = BRACE_HOST_OK;
    for (size_t i = 0; i < count; ++i) {
        const int32_t of_case = answer(*model, limb, cases[i], what, parts, results[i]);
        if (of_case != BRACE_HOST_OK) {
            double *const row = numbers(results[i]);
            std::fill(row, row + sizeof(ResultRow) / sizeof(double), std::numeric_limits<double>::quiet_NaN());
            first = first == BRACE_HOST_OK ? of_case : first;
        }
        if (status != nullptr) {
            status[i] = of_case;
        }
    }
    return first;
}

} // namespace

extern "C" int32_t brace_reference_under_force(const brace_plant_model_t *model, size_t count,
                                               const brace_loaded_case_t *cases, int32_t parts,
                                               brace_loaded_result_t *results, int32_t *status)
{
    return answer_all(model, count, cases, Given::force, parts, results, status);
}

extern "C" int32_t brace_reference_under_displacement(const brace_plant_model_t *model, size_t count,
                                                      const brace_loaded_case_t *cases, int32_t parts,
                                                      brace_loaded_result_t *results, int32_t *status)
{
    return answer_all(model, count, cases, Given::displacement, parts, results, status);
}

extern "C" int32_t brace_reference_space_under_force(const brace_plant_model_t *model, size_t count,
                                                     const brace_loaded_space_case_t *cases, int32_t parts,
                                                     brace_loaded_space_result_t *results, int32_t *status)
{
    return answer_all(model, count, cases, Given::force, parts, results, status);
}

extern "C" int32_t brace_reference_space_under_displacement(const brace_plant_model_t *model, size_t count,
                                                            const brace_loaded_space_case_t *cases, int32_t parts,
                                                            brace_loaded_space_result_t *results, int32_t *status)
{
    return answer_all(model, count, cases, Given::displacement, parts, results, status);
}
