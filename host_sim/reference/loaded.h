// The limb under load, at finite displacements: rest state, K there, buckling factor. The meaning of the limb is fixed
// by the section 'Under load' of docs/physics.md; the mechanics stand in chain.h. In double precision.
//
// The limb's springs, in the order from base to tip (all of them at once linear, none of them aware of another):
//   base       slides along x and z of the commanded limb's plane, then a hinge about the femur axis
//   coxa joint a hinge about the yaw axis (in space)
//   coxa       a link of its own length along x (in space)
//   femur joint, femur, knee joint, tibia
// and every link, with strength m of its moment transfer:
//   axial slide of m * axial, at the beam's root
//   beam       `parts` equal parts; each has hinges at its two Gauss points, which give it the three end compliances of
//              a uniform beam exactly. In the plane m * 3 bending/L^2 are shared out among them, across it
//              m * 3 lateral/L^2, about the link m * torsion
//   end        slides of (1-m) * axial along, (1-m) * bending across, (1-m) * lateral across the plane, in the link's
//              own frame; then a hinge of (1-m) * torsion
// The link's tilt turns axial and bending: their slides' directions, and the line through the link's end on which the
// plane's hinges lie. Lateral bending and torsion stay with the line of the link. A link without length has no beam.
// At no load the sum of these springs is exactly the C of stiffness.h.
//
// Weight of a link: m of it is carried along the beam, one lump in the middle of each part; 1-m at mid-length. Both lie
// on the line of the link, not on the tilted one, before the end's springs. The knee's weight lies on the knee joint.
#pragma once

#include "reference/chain.h"
#include "reference/elements.h"

namespace brace::reference {

struct Weights {
    double femur_n, tibia_n, knee_n;
    Vector3d direction; // unit vector in the commanded limb's plane frame (x outwards, y sideways, z up)
};

// In the commanded limb's plane frame, origin on the femur axis.
struct Result {
    Vector3d displacement_mm; // of the tip, from its place on the limb without weight and force
    Vector3d force_n; // of the ground on the tip
    Matrix3d k_n_per_mm; // its first 2x2 over x, z in the plane; 3x3 in space
    double buckling_factor; // infinity: none
    Vector3d joint_rad; // deflection of coxa, femur, tibia joint; counter-clockwise, an open knee positive
    Vector3d joint_n_mm; // the moment that turns them so
    double base_x_mm, base_z_mm, base_rad;
};

enum class Outcome { found, no_rest, rigid };

// Parts of every beam. Results of kParts and of 2 kParts parts are extrapolated, their error falling with the square.
constexpr int kParts = 8;

// parts 0: the default and extrapolated; above 0: so many parts, and no extrapolation; below 0: -parts parts with one
// hinge in the middle of each, as physics engines have beams: their bending is exact at no load, their turn 1/(4 n^2)
// too large.
// with_coxa: in space.
Outcome under_force(const Limb &limb, const Posture &posture, const Weights &weights, const Vector3d &force_n,
                    bool with_coxa, int parts, Result &result);
Outcome under_displacement(const Limb &limb, const Posture &posture, const Weights &weights,
                           const Vector3d &displacement_mm, bool with_coxa, int parts, Result &result);

// The chain itself, and which of its springs are the joints and the base's (npos: rigid).
struct LimbChain {
    static constexpr std::size_t npos = static_cast<std::size_t>(-1);
    Chain chain;
    std::size_t joint[3] = {npos, npos, npos}; // coxa, femur, tibia
    std::size_t mark[3] = {npos, npos, npos}; // of the chain's weights: two of nothing, on the joint's axis
    std::size_t base_x = npos, base_z = npos, base_rotation = npos;
};

LimbChain chain_of(const Limb &limb, const Posture &posture, const Weights &weights, bool with_coxa, int parts);

} // namespace brace::reference
