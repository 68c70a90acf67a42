// The compliance chain as physics.md writes it: elements, each a compliance S in its own frame and the map T from the
// tip force to the wrench at the element; C = sum T' S T. The code is written apart from the firmware's, in long
// double.
//
// Wrench and motion at an element, in its own frame: [along, across, sideways; twist, turn in plane, turn
// sideways]: forces (motions) along the element's axis, across it in the limb's plane, along y; moments
// (turns) about the axis, about y, and about the remaining axis, each positive where it moves a point further
// along the axis the positive way.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "reference/kinematics.h"

namespace brace::reference {

using Matrix3 = Eigen::Matrix<Real, 3, 3>;
using Matrix6 = Eigen::Matrix<Real, 6, 6>;
using WrenchMap = Eigen::Matrix<Real, 6, 3>;

struct LinkCompliance {
    Real axial_mm_per_n, bending_mm_per_n, tilt_rad, lateral_mm_per_n, torsion_rad_per_n_mm, moment_transfer;
};

struct Limb {
    Lengths lengths;
    LinkCompliance coxa, femur, tibia;
    Real coxa_joint_rad_per_n_mm, femur_joint_rad_per_n_mm, tibia_joint_rad_per_n_mm;
    Real base_x_mm_per_n, base_z_mm_per_n, base_rotation_rad_per_n_mm;
};

struct Element {
    Matrix6 s;
    WrenchMap t;
};

// Elements of the limb in its own plane frame (x outwards, y sideways, z up). A planar limb has no coxa.
std::vector<Element> elements_of(const Limb &limb, const Posture &posture, bool with_coxa);

// C in the limb's plane frame. Only spatial limbs have entries for y.
Matrix3 compliance(const std::vector<Element> &elements);

} // namespace brace::reference
