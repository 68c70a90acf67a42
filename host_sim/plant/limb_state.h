// The limb from one reading to the next: its memory, and its rest state under the next displacement.
//
// At finite displacements a rest state is found by steps of Newton's method: the limb is linearised about a shape
// (condensed.h), the joints that are more than springs find their rest in it exactly (equilibrium.h), and the limb
// moves there. Small displacements are the first of these steps, from the unloaded limb.
#pragma once

#include <Eigen/Core>
#include <array>

#include "plant/condensed.h"
#include "plant/equilibrium.h"
#include "plant/structure.h"

namespace brace::plant {

struct LimbRest {
    Eigen::Vector2d force_n;                    // on the limb's tip
    std::array<double, 2> joint_deflection_rad; // elastic, play and creep
    std::array<double, 2> joint_torque_n_mm;    // of all loads beyond a joint about it, where it is now
    Eigen::Vector2d base_mm;                    // the base moved along x and z
    bool solved;
};

class LimbState {
public:
    LimbState(const Model &model, Displacements displacements) : model_(model), displacements_(displacements) {}

    // Sets posture, time and temperature. False when nothing yields in some direction.
    bool move_to(double theta1_rad, double theta2_rad, double t_s, double temp_degc);

    // Centres the backlash and relaxes friction; removes creep too when asked. Displacements count from the limb's
    // weightless place. From the next posture on the contact that holds the tip yields by so much.
    void start_run(bool creep_gone, double contact_mm_per_n = 0.0);

    // The limb hangs freely under its weight, and displacements count from there. False: it finds no rest.
    bool hang();

    // free_axis: 0 both axes are held, 1 x is free, 2 z is free.
    LimbRest hold_tip(const Eigen::Vector2d &displacement_mm, int free_axis = 0);

    // How the torques on the joints follow the angles of their motors while the contact holds the tip, gaps closed.
    Eigen::Matrix2d torque_per_motor_turn() const;

private:
    void let_creep(double t_s);
    bool prepare();
    bool foresee(const Eigen::Vector2d &target_mm);
    bool lead_to(const Eigen::Vector2d &target_mm, int free_axis);
    bool settle(const Eigen::Vector2d &target_mm, int free_axis);
    // One step of Newton's method. The forces are such as would move the limb along its softest direction so far.
    struct Step {
        bool stable;       // it went to a minimum of the energy
        double moved_n;    // infinite: it lost its way
        double rounding_n; // what rounding may move
    };
    Step take_step(const Eigen::Vector2d &target_mm, int free_axis);

    const Model &model_;
    const Displacements displacements_;
    bool placed_ = false, prepared_ = false;
    double contact_mm_per_n_ = 0.0;
    double theta1_rad_ = 0.0, theta2_rad_ = 0.0, t_s_ = 0.0, temp_degc_ = 0.0;
    Structure structure_{};
    double softest_mm_per_n_ = 0.0; // trace of its compliance without load
    double stops_mm_per_n_ = 0.0;   // yields in series, where all else is rigid while joints stick
    std::array<JointLaw, 2> law_{}; // the compliance of a rigid joint with backlash is its stop's
    std::array<bool, 2> is_unknown_{}; // joints that are more than springs; they are the unknowns of a RestProblem

    // The present rest state, and where it was sought.
    struct Rest {
        Shape shape;
        std::array<double, 2> instant_rad{}; // joints' deflections without creep
        std::array<double, 2> torque_n_mm{};
        Eigen::Vector2d tip_mm = Eigen::Vector2d::Zero(); // from its weightless place
    };
    Rest rest_;
    // Without friction and creep a rest state depends on where the tip is held and on nothing before. A run leads the
    // tip to few places, and to most of them twice.
    struct Known {
        Eigen::Vector2d target_mm;
        int free_axis;
        Rest rest;
    };
    bool forgets() const;
    const Known *known_at(const Eigen::Vector2d &target_mm, int free_axis) const;
    static constexpr int kMostKnown = 20; // places of 9 steps to each side
    std::array<Known, kMostKnown> known_;
    int known_count_ = 0;
    Known earlier_;            // where the tip was held before it came to where rest_ holds it
    bool has_earlier_ = false; // at this posture, in this run
    Condensed condensed_;
    bool is_condensed_ = false;                            // condensed_ is that of the unloaded limb
    Eigen::Vector2d origin_mm_ = Eigen::Vector2d::Zero();  // from where displacements count
    Eigen::Vector2d reached_mm_ = Eigen::Vector2d::Zero(); // where rest_ holds the tip
    Eigen::Vector2d tip_mm_ = Eigen::Vector2d::Zero();     // where the contact has dragged the tip
    std::array<double, 2> before_rad_{};                   // rest_.instant_rad at the last reading
    std::array<double, 2> delayed_rad_{};                  // creep
    double creep_dt_s_ = -1.0, creep_approach_ = 0.0;
};

} // namespace brace::plant
