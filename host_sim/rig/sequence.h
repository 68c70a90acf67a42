// The order of a loading test: which pose, axis and displacement, when and how warm.
#pragma once

#include <cstddef>
#include <vector>

#include "effects/effect.h"

namespace brace::rig {

struct Reading {
    int run, config, axis, rep, step; // counted from 1; axis 0 x, 1 z; step from 0
    double theta1_rad, theta2_rad, t_s, temp_degc, dx_mm, dz_mm;
};

// The paper's test, still without a pose.
brace_rig_design_t paper_design();

bool is_sound(const brace_rig_design_t &design);
std::size_t reading_count(const brace_rig_design_t &design);
std::vector<Reading> sequence(const brace_rig_design_t &design);

// The displacements of one run, in multiples of the step.
std::vector<int> run_steps(int steps_per_side, bool cyclic);

} // namespace brace::rig
