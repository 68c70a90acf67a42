#include "plant/contact.h"

#include <cmath>
#include <limits>

namespace brace::plant {

using Eigen::Matrix2d;
using Eigen::Vector2d;

Elastic elastic_of(const Matrix2d &compliance)
{
    const double a = compliance(0, 0);
    const double b = 0.5 * (compliance(0, 1) + compliance(1, 0));
    const double c = compliance(1, 1);
    const double determinant = a * c - b * b;
    Matrix2d stiffness;
    stiffness << c / determinant, -b / determinant, -b / determinant, a / determinant;
    return {compliance, stiffness};
}

ContactForce contact_force(const Elastic &structure, const Vector2d &half, const Vector2d &displacement)
{
    if (half.isZero(0.0)) {
        return {structure.stiffness_n_per_mm * displacement, structure.stiffness_n_per_mm};
    }
    const Matrix2d &compliance = structure.compliance_mm_per_n;
    // Both axes taken up: the force on each must press the side it is on.
    const bool any_free = !half.allFinite();
    for (const double side_x : {1.0, -1.0}) {
        for (const double side_z : {1.0, -1.0}) {
            if (any_free) {
                break;
            }
            const Vector2d slip(side_x * half.x(), side_z * half.y());
            const Vector2d force = structure.stiffness_n_per_mm * (displacement - slip);
            if (force.x() * side_x >= 0.0 && force.y() * side_z >= 0.0) {
                return {force, structure.stiffness_n_per_mm};
            }
        }
    }
    // One axis taken up, the other free and so without force. Of the two, the one whose free slip stays within
    // the clearance; rounding must not let both miss it.
    ContactForce result{Vector2d::Zero(), Matrix2d::Zero()};
    double least_excess = std::numeric_limits<double>::infinity();
    for (const int taken : {0, 1}) {
        const double beyond = std::fabs(displacement[taken]) - half[taken];
        if (beyond <= 0.0) {
            continue;
        }
        const int free = 1 - taken;
        const double force = std::copysign(beyond / compliance(taken, taken), displacement[taken]);
        const double excess = std::fabs(displacement[free] - compliance(free, taken) * force) - half[free];
        if (excess < least_excess) {
            least_excess = excess;
            result = {Vector2d::Zero(), Matrix2d::Zero()};
            result.force_n[taken] = force;
            result.stiffness_n_per_mm(taken, taken) = 1.0 / compliance(taken, taken);
        }
    }
    return result;
}

}  // namespace brace::plant
