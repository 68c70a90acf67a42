#include "node/coxa_chain.h"

#include <algorithm>
#include <cmath>

#include "effects/contact_play.h"
#include "effects/creep.h"
#include "effects/joint_zero_offset.h"
#include "node/contact.h"
#include "plant/equilibrium.h"

namespace brace::node
{
namespace
{

using effects::kCoxa;
using effects::kFemur;
using effects::kTibia;

// A direction that does not yield gets this share of the chain's compliance, so that its stiffness stays finite.
constexpr double kRigidShare = 1e-9;
constexpr double kStopShare = 1e-8; // the same for a flank of a joint whose spring is rigid

// The tip as a link's far end sees it, in the link's own directions.
struct Arm {
    double along_mm;
    double beside_mm;
};

// One link's sideways compliance at the tip, under a force there. The link bends, the turn of its end moves all that
// lies beyond it, and the link twists under a force beside its axis.
double sideways_mm_per_n(const brace_plant_link_t &link, double length_mm, const Arm &arm)
{
    double compliance = link.lateral_mm_per_n + link.torsion_rad_per_n_mm * arm.beside_mm * arm.beside_mm;
    if (length_mm > 0.0) {
        const double turns_per_mm = link.moment_transfer_ratio * link.lateral_mm_per_n / length_mm;
        compliance += 3.0 * turns_per_mm * arm.along_mm * (1.0 + arm.along_mm / length_mm);
    }
    return compliance;
}

struct Reach {
    double lever_mm; // the tip's distance from the yaw axis
    double links_mm_per_n;
};

Reach reach_at(const plant::Model &model, const PlanePosture &posture)
{
    const auto &geometry = model.geometry;
    const double shin = posture.theta1_rad - posture.theta2_rad;
    const double tibia_x = geometry.tibia_mm * std::cos(shin), tibia_z = geometry.tibia_mm * std::sin(shin);
    const double femur_cos = std::cos(posture.theta1_rad), femur_sin = std::sin(posture.theta1_rad);
    const double tip_x = geometry.femur_mm * femur_cos + tibia_x, tip_z = geometry.femur_mm * femur_sin + tibia_z;
    const Arm from_coxa = {tip_x, tip_z};
    const Arm from_femur = {femur_cos * tibia_x + femur_sin * tibia_z, femur_cos * tibia_z - femur_sin * tibia_x};
    return {geometry.coxa_mm + tip_x,
            sideways_mm_per_n(model.link[kCoxa], geometry.coxa_mm, from_coxa)
                + sideways_mm_per_n(model.link[kFemur], geometry.femur_mm, from_femur)
                + sideways_mm_per_n(model.link[kTibia], geometry.tibia_mm, {0.0, 0.0})};
}

bool is_rigid_without_play(const plant::JointLaw &law)
{
    return law.compliance_rad_per_n_mm == 0.0 && law.gap_rad == 0.0;
}

} // namespace

bool has_coxa_joint(const plant::Model &model)
{
    bool yields = model.joint[kCoxa].compliance_rad_per_n_mm > 0.0;
    for (const int index : {kCoxa, kFemur, kTibia}) {
        const auto &link = model.link[index];
        // The tip lies on the tibia's axis, so no force there twists the tibia.
        yields = yields || link.lateral_mm_per_n > 0.0 || (index != kTibia && link.torsion_rad_per_n_mm > 0.0);
    }
    return yields;
}

double CoxaChain::unbent_rad(double motor_rad) const
{
    return effects::joint_zero_offset::true_angle_rad(model_, kCoxa, motor_rad);
}

void CoxaChain::take_hold(double motor_rad, double hold_n_per_mm, double press_y_mm, double t_s)
{
    contact_mm_per_n_ = contact_yields_mm_per_n(hold_n_per_mm);
    held_rad_ = unbent_rad(motor_rad);
    press_y_mm_ = press_y_mm;
    slipped_mm_ = 0.0;
    instant_rad_ = 0.0;
    t_s_ = t_s;
}

void CoxaChain::let_creep(const plant::JointLaw &law, double t_s)
{
    if (model_.creep.ratio != 0.0) {
        const double approach = effects::creep::approach(model_.creep.time_constant_s, t_s - t_s_);
        delayed_rad_ = effects::creep::delayed_rad(delayed_rad_, model_.creep.ratio,
                                                   plant::elastic_rad(law, instant_rad_), approach);
    }
    t_s_ = t_s;
}

bool CoxaChain::settle(double motor_rad, const PlanePosture &posture, double t_s, double temp_degc,
                       Across &across)
{
    const Reach reach = reach_at(model_, posture);
    plant::JointLaw law = plant::joint_law(model_, kCoxa, temp_degc);
    let_creep(law, t_s);
    const double lever_mm = reach.lever_mm;
    const double links_mm_per_n = reach.links_mm_per_n + contact_mm_per_n_;
    const double whole_mm_per_n = links_mm_per_n + law.compliance_rad_per_n_mm * lever_mm * lever_mm;
    if (!(whole_mm_per_n > 0.0)) {
        return false;
    }
    const double turned_rad = unbent_rad(motor_rad) - held_rad_;
    slipped_mm_ =
        effects::contact_play::dragged_mm(model_, {slipped_mm_, 0.0}, {press_y_mm_ - lever_mm * turned_rad, 0.0}).x();

    // This uses the plane's solver, with the chain along its first axis and nothing along its second.
    plant::RestProblem problem{};
    problem.stiffness_n_per_mm = Eigen::Matrix2d::Identity();
    problem.stiffness_n_per_mm(0, 0) = 1.0 / std::max(links_mm_per_n, kRigidShare * whole_mm_per_n);
    problem.displacement_mm = {slipped_mm_ - lever_mm * delayed_rad_, 0.0};
    problem.joint_count = is_rigid_without_play(law) ? 0 : 1;
    if (law.compliance_rad_per_n_mm == 0.0) {
        law.compliance_rad_per_n_mm = kStopShare * whole_mm_per_n / std::max(lever_mm * lever_mm, 1.0);
    }
    problem.joint[0] = {{lever_mm, 0.0}, law, 0.0, instant_rad_};
    plant::RestState rest{};
    rest.deflection_rad[0] = instant_rad_;
    plant::find_rest(problem, rest);
    instant_rad_ = rest.deflection_rad[0];

    across.force_n = rest.force_n.x();
    across.load_n_mm = -lever_mm * across.force_n;
    across.link_rad = unbent_rad(motor_rad) + instant_rad_ + delayed_rad_;
    across.flank = flank_that_carries(law, across.load_n_mm);
    across.stiffness_n_mm_per_rad = lever_mm * lever_mm / whole_mm_per_n;
    across.solved = rest.solved;
    return true;
}

} // namespace brace::node
