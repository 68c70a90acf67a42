// The limb in space at one posture without any load, as structure.h has it in the plane: rigid bodies from the base to
// the tip, each behind a hinge or a spring that moves it, or both. In the frame of the commanded limb's plane: x
// outwards, y to the left, z up, origin on the femur joint's axis; the yaw axis stands at x = -coxa.
//
// In the order from base to tip, as docs/physics.md ('Under load') lists them: the base's slides and its hinge about
// the femur axis, coxa joint, coxa link, femur joint, femur, knee, tibia. A link bends in the plane and across it, and
// twists. Its beam is kBeamParts equal parts: at each of a part's two Gauss points a hinge for the plane and one across
// it, and one for the twist between. Turns in space do not commute: the hinges stand in the same order from both ends
// of a part, else the error would fall only with a part's length.
#pragma once

#include <Eigen/Core>
#include <array>

#include "plant/structure.h"

namespace brace::plant {

constexpr int kMostSpaceBodies = 1 + 3 * (2 + 5 * kBeamParts + 2);

struct SpaceBody {
    int joint; // that its hinge is: 0 coxa, 1 femur joint, 2 knee, or kElastic
    Eigen::Vector3d axis; // of the hinge; all directions are those of the limb without deflection
    double hinge_rad_per_n_mm; // of an elastic hinge; 0: there is none
    bool yields; // at its root, within the hinge
    Eigen::Matrix3d mm_per_n;
    Eigen::Vector3d extent_mm; // from its hinge to that of the next body
    double weight_n;
    Eigen::Vector3d weight_arm_mm;
};

struct SpaceStructure {
    int body_count;
    std::array<SpaceBody, kMostSpaceBodies> body;
    std::array<int, 3> joint_body;
    Eigen::Vector3d root_mm; // where the first body begins
    Eigen::Vector3d base_mm_per_n;
    Eigen::Vector3d down; // a unit vector
    double reach_mm;
};

double total_weight_n(const SpaceStructure &structure);

// Of the limb as it is now, at commanded angles; zero offsets are added.
void find_structure(const Model &model, double theta1_rad, double theta2_rad, SpaceStructure &structure);

SpaceStructure without_loads(SpaceStructure structure);

} // namespace brace::plant
