#include "plant/joint_law.h"

#include <cmath>

#include "effects/backlash.h"
#include "effects/coulomb_friction.h"
#include "effects/joint_compliance.h"
#include "effects/joint_hardening.h"
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

bool is_linear(const JointLaw &law)
{
    return law.gap_rad == 0.0 && !law.rubs() && law.hardening_n_mm_per_rad3 == 0.0;
}

double elastic_rad(const JointLaw &law, double deflection_rad)
{
    return backlash::beyond_rad(deflection_rad, law.gap_rad);
}

double spring_torque_n_mm(const JointLaw &law, double deflection_rad)
{
    const double elastic = elastic_rad(law, deflection_rad);
    return joint_compliance::torque_n_mm(law.compliance_rad_per_n_mm, elastic)
           + joint_hardening::torque_n_mm(law.hardening_n_mm_per_rad3, elastic);
}

double spring_stiffness_n_mm_per_rad(const JointLaw &law, double deflection_rad)
{
    const double elastic = elastic_rad(law, deflection_rad);
    if (law.gap_rad > 0.0 && elastic == 0.0) {
        return 0.0;
    }
    return 1.0 / law.compliance_rad_per_n_mm
           + joint_hardening::stiffness_n_mm_per_rad(law.hardening_n_mm_per_rad3, elastic);
}

double friction_n_mm(const JointLaw &law, double deflection_rad)
{
    return coulomb_friction::most_n_mm(law.coulomb_n_mm, law.coulomb_per_load_ratio,
                                       spring_torque_n_mm(law, deflection_rad));
}

double friction_slope_n_mm_per_rad(const JointLaw &law, double deflection_rad)
{
    return std::copysign(law.coulomb_per_load_ratio * spring_stiffness_n_mm_per_rad(law, deflection_rad),
                         deflection_rad);
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
