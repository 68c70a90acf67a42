#include "truth.h"

#include <algorithm>
#include <array>
#include <cmath>

extern "C" {
#include "api/brace_host.h"
#include "brace/app.h"
#include "brace/uncertainty.h"
}

namespace soak {
namespace {

constexpr double kSigmas = 3.0, kLoadedShare = 6e-3;

using Entries = std::array<double, 3>; // k_xx, k_xz, k_zz [N/mm]

// The angle of a joint with its spring unloaded: what turns the link beside play is the spring under the joint's load.
double unbent_rad(const Limb &limb, const brace_node_truth_t &truth, int joint)
{
    return truth.link_rad[joint] + limb.there.plant.joint[joint].compliance_rad_per_n_mm * truth.load_n_mm[joint];
}

bool true_k(const Limb &limb, const brace_node_truth_t &truth, bool is_loaded, Entries &k)
{
    const brace_plant_model_t &plant = limb.there.plant;
    const double share = is_loaded ? 1.0 : 0.0;
    const double fx_n = share * truth.force_x_n, fz_n = share * truth.force_z_n;
    const double theta1_rad = unbent_rad(limb, truth, kFemur), theta2_rad = unbent_rad(limb, truth, kTibia);
    if (truth.has_coxa_joint != 0) {
        const double fy_n = share * truth.force_y_n;
        brace_loaded_space_case_t at{0.0, theta1_rad, theta2_rad, fx_n, fy_n, fz_n, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
        at.gravity_z = -1.0;
        brace_loaded_space_result_t result;
        const bool is_there = brace_reference_space_under_force(&plant, 1, &at, 0, &result, nullptr) == BRACE_HOST_OK;
        k = {result.k_xx, result.k_xz, result.k_zz};
        return is_there;
    }
    const brace_loaded_case_t at = {theta1_rad, theta2_rad, fx_n, fz_n, 0.0, 0.0, plant.gravity.direction_rad};
    brace_loaded_result_t result;
    const bool is_there = brace_reference_under_force(&plant, 1, &at, 0, &result, nullptr) == BRACE_HOST_OK;
    k = {result.k_xx, result.k_xz, result.k_zz};
    return is_there;
}

} // namespace

bool denies_gap(const Limb &limb, const brace_node_truth_t &truth, const brace_snapshot_t &reported)
{
    bool is_open = false;
    for (const int joint : {kFemur, kTibia}) {
        is_open = is_open || (limb.there.plant.joint[joint].gap_rad > 0.0 && truth.flank[joint] == 0);
    }
    return is_open && (reported.stiffness.now.flags & BRACE_FLAG_GAP_OPEN) == 0u;
}

Agreement agreement(const Limb &limb, const brace_node_truth_t &truth, brace_app_t *app)
{
    Agreement found;
    const brace_snapshot_t &reported = *brace_app_snapshot(app);
    found.is_reported = reported.k_is_valid;
    Entries true_n_per_mm;
    brace_stiffness_sigma_t by_parameters;
    const brace_stiffness_sigma_t &sigma = reported.sigma;
    const auto largest = [](const brace_stiffness_sigma_t &of) {
        return static_cast<double>(std::max({of.k_xx_n_per_mm, of.k_xz_n_per_mm, of.k_zz_n_per_mm}));
    };
    if (!found.is_reported || !true_k(limb, truth, reported.load.is_counted, true_n_per_mm) ||
        !reported.sigma_is_known ||
        brace_uncertainty_stiffness(&brace_app_parameters(app)->limb, reported.theta_rad[kFemur],
                                    reported.theta_rad[kTibia], &reported.stiffness.engaged,
                                    &by_parameters) != BRACE_OK) {
        return found;
    }
    const brace_stiffness_t &k = reported.stiffness.engaged;
    found.is_judged = true;
    const Entries entries = {k.k_xx_n_per_mm, k.k_xz_n_per_mm, k.k_zz_n_per_mm};
    const auto sigmas = [](const brace_stiffness_sigma_t &of) {
        return Entries{of.k_xx_n_per_mm, of.k_xz_n_per_mm, of.k_zz_n_per_mm};
    };
    const double norm = std::sqrt(entries[0] * entries[0] + 2.0 * entries[1] * entries[1] + entries[2] * entries[2]);
    found.reported = largest(sigma) / norm;
    found.by_parameters = largest(by_parameters) / norm;
    found.is_sensed = reported.force_is_sensed;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const double error = std::fabs(entries[i] - true_n_per_mm[i]), loaded = kLoadedShare * norm;
        found.share = std::max(found.share, error / (kSigmas * sigmas(sigma)[i] + loaded));
        found.share_by_parameters =
            std::max(found.share_by_parameters, error / (kSigmas * sigmas(by_parameters)[i] + loaded));
    }
    return found;
}

} // namespace soak
