// The limb at one posture, as the plant sees it: its compliance, proportional to the tip force, and the levers.
// A joint's deflection, like its torque, is positive counter-clockwise: at the knee, against the sense of
// theta2.
#pragma once

#include <Eigen/Core>
#include <array>

#include "effects/effect.h"

namespace brace::plant {

using effects::Model;

struct Structure {
    Eigen::Matrix2d compliance_mm_per_n;     // links and base, joints locked
    std::array<Eigen::Vector2d, 2> lever_mm; // tip displacement per deflection of femur joint and knee
    Eigen::Vector2d gravity_n_mm;            // torques of the weights about femur joint and knee
};

// At commanded angles; zero offsets are added. t_s decides whether a link has changed.
Structure structure_at(const Model &model, double theta1_rad, double theta2_rad, double t_s);

} // namespace brace::plant
