// The limb across its plane: the coxa joint, the sideways compliance of the links, and the contact that holds the tip.
//
// Across the plane a limb is a chain in one dimension. Its motor turns the plane about the yaw axis; the joint's play
// and spring turn it further; the links bend and twist sideways; the contact holds the tip. The lever is the tip's
// distance from the yaw axis.
#pragma once

#include "plant/joint_law.h"
#include "plant/structure.h"

namespace brace::node
{

// True angles of the joints in the plane.
struct PlanePosture {
    double theta1_rad;
    double theta2_rad;
};

struct Across {
    double force_n = 0.0;                // force of the contact on the tip, along y of the limb's plane
    double load_n_mm = 0.0;              // torque of the motor on the link
    double link_rad = 0.0;               // true joint angle
    int flank = 0;                       // flank that carries; 0: the gap is open
    double stiffness_n_mm_per_rad = 0.0; // change of load with motor angle, the gap closed
    bool solved = true;
};

// A limb has a coxa joint when something yields across its plane.
bool has_coxa_joint(const plant::Model &model);

class CoxaChain
{
public:
    explicit CoxaChain(const plant::Model &model) : model_(model) {}
    CoxaChain(const CoxaChain &) = delete;
    CoxaChain &operator=(const CoxaChain &) = delete;

    // Holds the tip at press_y_mm beside its unloaded place at this motor angle. 0 stiffness: the tip is free.
    void take_hold(double motor_rad, double hold_n_per_mm, double press_y_mm, double t_s);

    // Finds the rest state at a motor angle. False: nothing yields.
    bool settle(double motor_rad, const PlanePosture &posture, double t_s, double temp_degc, Across &across);

    // The true joint angle of a motor angle, with nothing bent.
    double unbent_rad(double motor_rad) const;

private:
    void let_creep(const plant::JointLaw &law, double t_s);

    const plant::Model &model_;
    double contact_mm_per_n_ = 0.0;
    double held_rad_ = 0.0, press_y_mm_ = 0.0; // the contact holds the tip beside the plane at this angle
    double slipped_mm_ = 0.0;                  // slip of the tip in the contact's backlash
    double instant_rad_ = 0.0;                 // deflection of the joint without creep
    double delayed_rad_ = 0.0;                 // creep
    double t_s_ = 0.0;
};

} // namespace brace::node
