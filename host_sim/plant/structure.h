// The limb at one posture without any load, as the plant sees it: rigid bodies, each behind a hinge, from the base to
// the tip. A body may yield, at its end (a link's ellipsoid) or at its root (a beam's axial spring). The base's
// translations come before the first hinge. Turns and torques are positive counter-clockwise: at the knee, against the
// sense of theta2.
//
// A link whose moment transfer has the strength m is m of a uniform beam and 1 - m of an ellipsoid (docs/physics.md,
// 'Under load'). The beam is kBeamParts equal parts, each with hinges at its two Gauss points; what lies between two
// hinges has its weight in its middle. There a force, a moment and the beam's own weight bend it just as they bend the
// uniform beam, so that small displacements have no error; that of larger ones falls with the square of a part's
// length.
#pragma once

#include <Eigen/Core>
#include <array>

#include "effects/effect.h"

namespace brace::plant {

using effects::Model;

// finite: the springs turn the limb by any angle, and weights load all of them.
// small: levers stay those of the commanded posture, and weights load the joints only.
enum class Displacements { finite, small };

// Four parts leave at most 0.006 N (median 3e-5 N) at the paper's stroke of 2.54 mm, a tenth of its sensor's
// resolution: limbs like the paper's with beams for links, forces within the sensor's 145 N. Two parts would leave four
// times that.
constexpr int kBeamParts = 4;
constexpr int kMostBodies = 1 + 2 * (1 + 2 * kBeamParts);

constexpr int kElastic = -1; // a hinge that is no joint: of the base or of a beam

enum class Yields { nowhere, at_root, at_end };

template <class Number> struct BodyOf {
    using Vec = Eigen::Matrix<Number, 2, 1>;

    int joint; // that its hinge is: 0 femur joint, 1 knee, or kElastic
    Number hinge_rad_per_n_mm; // of an elastic hinge. A joint's spring depends on the temperature: it is not in here
    Vec extent_mm; // from its hinge to its end, in the robot's frame
    Number weight_n; // pulls along `down` at `weight_arm_mm` from its hinge
    Vec weight_arm_mm;
    Number end_weight_n; // pulls along `down` at its end, behind what yields there
    Yields yields; // by this compliance in the body's own frame:
    Number mean_mm_per_n; // half of its trace
    Vec deviation_mm_per_n; // (xx - zz) / 2 and xz
};
using Body = BodyOf<double>;

template <class Number> struct StructureOf {
    using Vec = Eigen::Matrix<Number, 2, 1>;

    int body_count;
    std::array<BodyOf<Number>, kMostBodies> body;
    std::array<int, 2> joint_body; // the bodies behind femur joint and knee
    Vec base_mm_per_n; // along x and z
    Vec down; // where weights pull to; shorter than 1 where the limb's plane leans
    Vec joint_load_n_mm; // torque on the joints besides that of the bodies' weights and the tip force
    Number reach_mm; // of the straight limb
};
using Structure = StructureOf<double>;

double total_weight_n(const Structure &structure);

// Of the limb as it is now, at commanded angles; zero offsets are added.
void find_structure(const Model &model, Displacements displacements, double theta1_rad, double theta2_rad,
                    Structure &structure);

Structure without_loads(Structure structure);

} // namespace brace::plant
