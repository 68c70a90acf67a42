#include "reference/kinematics.h"

#include <cmath>

namespace brace::reference {

Vector3 tip_mm(const Lengths &lengths, Real theta0_rad, const Posture &posture)
{
    const Real tibia_angle = posture.theta1_rad - posture.theta2_rad;
    const Real out = lengths.femur_mm * std::cos(posture.theta1_rad) + lengths.tibia_mm * std::cos(tibia_angle);
    const Real up = lengths.femur_mm * std::sin(posture.theta1_rad) + lengths.tibia_mm * std::sin(tibia_angle);
    const Real from_yaw = lengths.coxa_mm + out;
    return {from_yaw * std::cos(theta0_rad), from_yaw * std::sin(theta0_rad), up};
}

bool posture_at(const Lengths &lengths, Real r_mm, Real phi_rad, bool knee_up, Posture &posture)
{
    const Real l1 = lengths.femur_mm;
    const Real l2 = lengths.tibia_mm;
    const Real shortest = std::fabs(l1 - l2);
    if (!(r_mm >= shortest && r_mm <= l1 + l2 && r_mm > 0.0L)) {
        return false;
    }
    // Half-angle form of the cosine rule: exact at both ends of the reach.
    const Real folded = (r_mm - shortest) * (r_mm + shortest);
    const Real straight = (l1 + l2 - r_mm) * (l1 + l2 + r_mm);
    const Real flexion = 2.0L * std::atan2(std::sqrt(straight), std::sqrt(folded));
    const Real theta2 = knee_up ? flexion : -flexion;
    // The femur leads the tip by the angle at the femur axis.
    const Real lead = std::atan2(l2 * std::sin(theta2), l1 + l2 * std::cos(theta2));
    posture = {phi_rad + lead, theta2};
    return true;
}

} // namespace brace::reference
