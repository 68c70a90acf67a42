#include "plant/joint_law.h"

#include <cmath>

#include "effects/thermal_softening.h"

namespace brace::plant {

using namespace effects;

JointLaw joint_law(const Model &model, int joint, double temp_degc)
{
    JointLaw law;
    static_cast<brace_plant_joint_t &>(law) = model.joint[joint];
    law.compliance_rad_per_n_mm *= thermal_softening::factor(model, temp_degc);
    return law;
}

double elastic_under_torque_rad(const JointLaw &law, double torque_n_mm)
{
    const double s = law.compliance_rad_per_n_mm;
    const double h = law.hardening_n_mm_per_rad3;
    if (h == 0.0 || s == 0.0) {
        return s * torque_n_mm;
    }
    // q / s + h q^3 = torque has one real root; Newton from the spring's answer falls on it from above.
    double q = s * std::fabs(torque_n_mm);
    for (int i = 0; i < 200; ++i) {
        const double step = (q / s + h * q * q * q - std::fabs(torque_n_mm)) / (1.0 / s + 3.0 * h * q * q);
        q -= step;
        if (step <= 1e-16 * q) {
            break;
        }
    }
    return std::copysign(q, torque_n_mm);
}

} // namespace brace::plant
