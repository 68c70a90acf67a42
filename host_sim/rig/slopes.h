// Two results of the paper's loading tests: K by slopes, and the shift of the zero-force point.
#pragma once

#include <array>

#include "effects/effect.h"

namespace brace::rig {

enum class SlopeRule { MeanOfRatios, LeastSquares };

// k_xx k_xz k_zx k_zz at commanded angles, from readings at 1..steps_per_side steps on both sides. The reading before
// the first step is subtracted from each.
brace_host_status_t measure_stiffness(const effects::Model &model, double theta1_rad, double theta2_rad, double step_mm,
                                      int steps_per_side, SlopeRule rule, std::array<double, 4> &k);

brace_host_status_t zero_force_shift(const effects::Model &model, double theta1_rad, double theta2_rad, int axis,
                                     double step_mm, int steps_per_side, double &shift_mm);

} // namespace brace::rig
