// The limb from one reading to the next: its memory, and its rest state under the next displacement.
#pragma once

#include <Eigen/Core>
#include <array>

#include "plant/equilibrium.h"
#include "plant/structure.h"

namespace brace::plant {

struct LimbRest {
    Eigen::Vector2d force_n;                    // on the limb's tip
    std::array<double, 2> joint_deflection_rad; // elastic, play and creep
    bool solved;
};

class LimbState {
public:
    explicit LimbState(const Model &model) : model_(model) {}

    // Sets posture, time and temperature. False when nothing yields in some direction.
    bool move_to(double theta1_rad, double theta2_rad, double t_s, double temp_degc);

    // Centres the backlash and relaxes friction; removes creep too when asked.
    void start_run(bool creep_gone);

    // free_axis: 0 both axes are held, 1 x is free, 2 z is free.
    LimbRest hold_tip(const Eigen::Vector2d &displacement_mm, int free_axis = 0);

    // The rest state at the last posture.
    const Structure &structure() const { return structure_; }

private:
    void let_creep(double t_s);
    bool prepare();

    const Model &model_;
    bool placed_ = false;
    double theta1_rad_ = 0.0, theta2_rad_ = 0.0, t_s_ = 0.0, temp_degc_ = 0.0;
    Structure structure_{};
    Eigen::Matrix2d compliance_mm_per_n_; // compliance of the structure and of the joints that are springs alone
    static constexpr int kNotHeld = -1;
    int held_free_axis_ = kNotHeld; // the free axis for which problem_ has its stiffness
    RestProblem problem_{};               // its unknowns are the other joints
    std::array<int, 2> unknown_joint_{};  // the joint of each unknown
    std::array<JointLaw, 2> law_{};
    std::array<bool, 2> is_spring_{};
    Eigen::Vector2d tip_mm_ = Eigen::Vector2d::Zero(); // where the contact has dragged the tip
    std::array<double, 2> instant_rad_{};              // deflection without creep
    std::array<double, 2> delayed_rad_{};              // creep
    double creep_dt_s_ = -1.0, creep_approach_ = 0.0;
};

} // namespace brace::plant
