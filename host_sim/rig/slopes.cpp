#include "rig/slopes.h"

#include <cmath>
#include <vector>

#include "rig/record.h"
#include "rig/sequence.h"

namespace brace::rig {
namespace {

constexpr double kLeastForce_n = 1e-9;

// One run along one axis, read without noise or rounding.
struct Sweep {
    std::vector<double> displacement_mm;
    std::array<std::vector<double>, 2> force_n;
};

brace_rig_design_t exact_design(const double *theta1_rad, const double *theta2_rad, int axis, double step_mm,
                                int steps_per_side, bool cyclic)
{
    brace_rig_design_t design = paper_design();
    design.config_count = 1;
    design.theta1_rad = theta1_rad;
    design.theta2_rad = theta2_rad;
    design.axes = 1 << axis;
    design.repeats = 1;
    design.steps_per_side = steps_per_side;
    design.cyclic = cyclic ? 1 : 0;
    design.step_mm = step_mm;
    design.noise_n = 0.0;
    design.resolution_n = 0.0;
    design.range_n = 1e300;
    return design;
}

brace_host_status_t sweep_along(const brace_rig_design_t &design, const effects::Model &model, int axis, Sweep &sweep)
{
    const std::size_t count = reading_count(design);
    sweep.displacement_mm.resize(count);
    sweep.force_n[0].resize(count);
    sweep.force_n[1].resize(count);
    brace_rig_record_t record{};
    (axis == 0 ? record.dx_mm : record.dz_mm) = sweep.displacement_mm.data();
    record.fx_n = sweep.force_n[0].data();
    record.fz_n = sweep.force_n[1].data();
    return play(design, &model, record);
}

double slope(const std::vector<double> &displacement, const std::vector<double> &force, SlopeRule rule)
{
    double ratios = 0.0;
    double products = 0.0;
    double squares = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 1; i < displacement.size(); ++i) {
        const double moved = displacement[i] - displacement[0];
        if (moved == 0.0) {
            continue;
        }
        const double risen = force[i] - force[0];
        ratios += risen / moved;
        products += risen * moved;
        squares += moved * moved;
        ++count;
    }
    return rule == SlopeRule::MeanOfRatios ? ratios / static_cast<double>(count) : products / squares;
}

// Displacement at which the force first comes to zero between rows from and to, by straight lines; false: nowhere.
// Where the force stays at zero, as within backlash, the line through the readings before is extended.
bool comes_to_zero(const Sweep &sweep, int axis, std::size_t from, std::size_t to, double &at_mm)
{
    const std::vector<double> &force = sweep.force_n[axis];
    const std::vector<double> &moved = sweep.displacement_mm;
    const double nothing = 1e-9 * std::fabs(force[from]);
    if (std::fabs(force[from]) < kLeastForce_n) {
        return false;
    }
    for (std::size_t i = from; i < to; ++i) {
        if (force[i] * force[i + 1] > 0.0 && std::fabs(force[i + 1]) > nothing) {
            continue;
        }
        const bool stays = std::fabs(force[i + 1]) <= nothing && i > from;
        const std::size_t a = stays ? i - 1 : i;
        at_mm = moved[a] + (moved[a + 1] - moved[a]) * force[a] / (force[a] - force[a + 1]);
        return true;
    }
    return false;
}

} // namespace

brace_host_status_t measure_stiffness(const effects::Model &model, double theta1_rad, double theta2_rad, double step_mm,
                                      int steps_per_side, SlopeRule rule, std::array<double, 4> &k)
{
    std::array<double, 4> measured{};
    for (const int axis : {0, 1}) {
        Sweep sweep;
        const brace_rig_design_t design = exact_design(&theta1_rad, &theta2_rad, axis, step_mm, steps_per_side, false);
        const brace_host_status_t status = sweep_along(design, model, axis, sweep);
        if (status != BRACE_HOST_OK) {
            return status;
        }
        measured[axis] = slope(sweep.displacement_mm, sweep.force_n[0], rule);     // k_xx, k_xz
        measured[2 + axis] = slope(sweep.displacement_mm, sweep.force_n[1], rule); // k_zx, k_zz
    }
    k = measured;
    return BRACE_HOST_OK;
}

brace_host_status_t zero_force_shift(const effects::Model &model, double theta1_rad, double theta2_rad, int axis,
                                     double step_mm, int steps_per_side, double &shift_mm)
{
    brace_rig_design_t design = exact_design(&theta1_rad, &theta2_rad, axis, step_mm, steps_per_side, true);
    design.transverse_free = 1;
    Sweep sweep;
    const brace_host_status_t status = sweep_along(design, model, axis, sweep);
    if (status != BRACE_HOST_OK) {
        return status;
    }
    const auto side = static_cast<std::size_t>(steps_per_side);
    double after_negative = 0.0; // unloading from -n on the way up
    double after_positive = 0.0; // unloading from +n on the way down
    if (!comes_to_zero(sweep, axis, side, 3 * side, after_negative)
        || !comes_to_zero(sweep, axis, 3 * side, 5 * side, after_positive)) {
        return BRACE_HOST_E_RANGE;
    }
    shift_mm = after_positive - after_negative;
    return BRACE_HOST_OK;
}

} // namespace brace::rig
