#include "plant/limb_state.h"

#include <Eigen/LU>
#include <algorithm>

#include "effects/contact_play.h"
#include "effects/creep.h"
#include "effects/thermal_softening.h"

namespace brace::plant {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

// A rigid joint with backlash gets this share of the limb's compliance, so that its stop is a spring.
constexpr double kStopCompliance = 1e-8;

// When a structure is rigid in one direction while its joints stick, it gets this share of the limb's compliance.
constexpr double kRigidCompliance = 1e-9;

bool has_changed(const Model &model, double t_s)
{
    return t_s >= model.change.at_s;
}

double determinant_ratio(const Matrix2d &compliance)
{
    const double trace = compliance.trace();
    return trace > 0.0 ? compliance.determinant() / (trace * trace) : 0.0;
}

// K where the tip is held along both axes, or along one with no force along the other.
Matrix2d stiffness_held(const Matrix2d &compliance, int free_axis)
{
    if (free_axis == 0) {
        return compliance.inverse();
    }
    const int held = 2 - free_axis;
    Matrix2d stiffness = Matrix2d::Zero();
    stiffness(held, held) = 1.0 / compliance(held, held);
    return stiffness;
}

} // namespace

bool LimbState::move_to(double theta1_rad, double theta2_rad, double t_s, double temp_degc)
{
    const bool same_structure = placed_ && theta1_rad == theta1_rad_ && theta2_rad == theta2_rad_
                                && has_changed(model_, t_s) == has_changed(model_, t_s_);
    const bool same_joints =
        placed_ && (temp_degc == temp_degc_ || model_.thermal.joint_compliance_per_degc == 0.0);
    if (placed_) {
        let_creep(t_s);
    }
    theta1_rad_ = theta1_rad;
    theta2_rad_ = theta2_rad;
    t_s_ = t_s;
    temp_degc_ = temp_degc;
    placed_ = true;
    if (!same_structure) {
        structure_ = structure_at(model_, theta1_rad, theta2_rad, t_s);
    }
    if (!same_joints) {
        for (const int i : {0, 1}) {
            law_[i] = joint_law(model_, effects::kFemur + i, temp_degc);
            is_spring_[i] = is_linear(law_[i]);
        }
    }
    return (same_structure && same_joints) || prepare();
}

// Springs go into the structure. A joint that is more than a spring becomes an unknown, unless it is rigid and without
// backlash.
bool LimbState::prepare()
{
    Matrix2d compliance = structure_.compliance_mm_per_n;
    Matrix2d whole = compliance;
    for (const int i : {0, 1}) {
        const Vector2d &lever = structure_.lever_mm[i];
        const Matrix2d turned = law_[i].compliance_rad_per_n_mm * lever * lever.transpose();
        whole += turned;
        if (is_spring_[i]) {
            compliance += turned;
        }
    }
    if (!(determinant_ratio(whole) > 1e-15)) {
        return false;
    }
    problem_.joint_count = 0;
    for (const int i : {0, 1}) {
        const Vector2d &lever = structure_.lever_mm[i];
        const bool rigid = law_[i].compliance_rad_per_n_mm == 0.0;
        if (is_spring_[i] || (rigid && law_[i].gap_rad == 0.0)) {
            continue;
        }
        JointUnknown &unknown = problem_.joint[problem_.joint_count];
        unknown_joint_[problem_.joint_count++] = i;
        unknown.lever_mm = lever;
        unknown.law = law_[i];
        unknown.load_n_mm = structure_.gravity_n_mm[i];
        if (rigid) {
            unknown.law.compliance_rad_per_n_mm =
                kStopCompliance * whole.trace() / std::max(lever.squaredNorm(), 1.0);
        }
    }
    if (problem_.joint_count > 0 && !(determinant_ratio(compliance) > 1e-12)) {
        compliance += kRigidCompliance * whole.trace() * Matrix2d::Identity();
    }
    compliance_mm_per_n_ = compliance;
    held_free_axis_ = kNotHeld;
    return true;
}

void LimbState::start_run(bool creep_gone)
{
    tip_mm_ = Vector2d::Zero();
    instant_rad_ = {};
    if (creep_gone) {
        delayed_rad_ = {};
    }
}

void LimbState::let_creep(double t_s)
{
    if (model_.creep.ratio == 0.0) {
        return;
    }
    const double dt = t_s - t_s_;
    if (dt != creep_dt_s_) {
        creep_dt_s_ = dt;
        creep_approach_ = effects::creep::approach(model_.creep.time_constant_s, dt);
    }
    for (const int i : {0, 1}) {
        const double elastic = elastic_rad(law_[i], instant_rad_[i]);
        delayed_rad_[i] =
            effects::creep::delayed_rad(delayed_rad_[i], model_.creep.ratio, elastic, creep_approach_);
    }
}

LimbRest LimbState::hold_tip(const Vector2d &displacement_mm, int free_axis)
{
    tip_mm_ = effects::contact_play::dragged_mm(model_, tip_mm_, displacement_mm);
    if (free_axis != held_free_axis_) { // inverts once a pose, not once a row
        held_free_axis_ = free_axis;
        problem_.stiffness_n_per_mm = stiffness_held(compliance_mm_per_n_, free_axis);
    }
    Vector2d rest_mm = tip_mm_; // the part that the force has to make
    for (const int i : {0, 1}) {
        double without_force = delayed_rad_[i];
        if (is_spring_[i]) {
            without_force += law_[i].compliance_rad_per_n_mm * structure_.gravity_n_mm[i];
        }
        rest_mm -= without_force * structure_.lever_mm[i];
    }
    RestState state{};
    if (problem_.joint_count == 0) {
        state.force_n = problem_.stiffness_n_per_mm * rest_mm;
        state.solved = true;
    } else {
        problem_.displacement_mm = rest_mm;
        for (int k = 0; k < problem_.joint_count; ++k) {
            problem_.joint[k].before_rad = instant_rad_[unknown_joint_[k]];
            state.deflection_rad[k] = instant_rad_[unknown_joint_[k]];
        }
        find_rest(problem_, state);
    }
    for (const int i : {0, 1}) {
        if (is_spring_[i]) {
            const double torque = structure_.lever_mm[i].dot(state.force_n) + structure_.gravity_n_mm[i];
            instant_rad_[i] = law_[i].compliance_rad_per_n_mm * torque;
        }
    }
    for (int k = 0; k < problem_.joint_count; ++k) {
        instant_rad_[unknown_joint_[k]] = state.deflection_rad[k];
    }
    return {
        state.force_n, {instant_rad_[0] + delayed_rad_[0], instant_rad_[1] + delayed_rad_[1]}, state.solved};
}

} // namespace brace::plant
