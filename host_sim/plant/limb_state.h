// The limb from one reading to the next: its memory, and its rest state under the next displacement.
//
// At finite displacements a rest state is found by steps of Newton's method: the limb is linearised about a shape
// (condensed.h), the joints that are more than springs find their rest in it exactly (equilibrium.h), and the limb
// moves there. Small displacements are the first of these steps, from the unloaded limb. Limbs that seek their rest
// take their steps alone, or side by side (limbs_abreast.h).
//
// What the limb is at a time and a temperature, and what it remembers, effects/limb_now.h and effects/memory.h say: a
// rest state depends on those numbers, on the posture, on where the tip is held, and on what is remembered.
//
// In the limb's plane, and in space: a world says which axes and joints there are, and how the limb is linearised.
#pragma once

#include <Eigen/Core>
#include <array>

#include "effects/limb_now.h"
#include "plant/condensed.h"
#include "plant/equilibrium.h"
#include "plant/known_rests.h"
#include "plant/search.h"
#include "plant/space_condensed.h"
#include "plant/structure.h"

namespace brace::plant {

// Axes x and z; femur joint and knee.
struct InPlane {
    static constexpr int kAxes = 2;
    static constexpr int kFirstJoint = effects::kFemur;
    using Structure = plant::Structure;
    using Condensed = plant::Condensed;
};

// Axes x, y and z of the commanded limb's plane; coxa joint, femur joint and knee. Displacements are finite there.
struct InSpace {
    static constexpr int kAxes = 3;
    static constexpr int kFirstJoint = effects::kCoxa;
    using Structure = SpaceStructure;
    using Condensed = SpaceCondensed;
};

template <int N> struct LimbRest {
    Vector<N> force_n;                          // on the limb's tip
    std::array<double, N> joint_deflection_rad; // elastic, play and creep
    std::array<double, N> joint_torque_n_mm;    // of all loads beyond a joint about it, where it is now
    Vector<N> base_mm;                          // the base moved so far
    bool solved;
};

// How a limb whose tip is held answers small changes, its gaps closed and its joints no more than springs.
template <int N> struct LimbHeld {
    Matrix<N> torque_n_mm_per_rad;  // torques on the joints by the angles of their motors
    Matrix<N> stiffness_n_per_mm;   // force by the tip's place; joints that friction holds hardly yield
    Vector<N> carried_n;            // tip force and weights together: what the limb brings to its base
    Vector<N> carried_n_mm;         // in space: their moment about the femur joint's unloaded place
};

template <class World> class LimbState {
    static constexpr int N = World::kAxes;
    using Vec = Vector<N>;
    using Mat = Matrix<N>;

public:
    LimbState(const Model &model, Displacements displacements)
        : model_(model), displacements_(displacements), search_(displacements == Displacements::small)
    {
    }

    // Sets posture, time and temperature. False when nothing yields in some direction.
    bool move_to(double theta1_rad, double theta2_rad, const effects::Conditions &conditions);

    // Numbers of the model are others now; the limb goes on from where it is. The next posture sees them.
    void model_changed() { is_changed_ = true; }

    // Centres the backlash and relaxes friction; removes creep too when asked. Displacements count from the limb's
    // weightless place. From the next posture on the contact that holds the tip yields by so much.
    void start_run(bool creep_gone, double contact_mm_per_n = 0.0);

    // The limb hangs freely under its weight, and displacements count from there. False: it finds no rest.
    bool hang();

    // free_axis: 0 all axes are held; in the plane also 1 x is free, 2 z is free.
    LimbRest<N> hold_tip(const Vec &displacement_mm, int free_axis = 0);

    // The same in pieces. begin_hold() says where the tip goes. While seeks() is true, the limb needs another step:
    // seek() takes all of them, or the caller takes them one by one, as below. end_hold() returns the rest state.
    void begin_hold(const Vec &displacement_mm, int free_axis = 0);
    bool seeks() const { return search_.seeks(); }
    void seek();
    LimbRest<N> end_hold();

    // One step by the caller. It linearises the limb with joint_hinges() about shape(), and gives the tangent to
    // take_change(), which returns a change. It finds the shape after this change, and gives it to went_to().
    std::array<JointHinge, N> joint_hinges() const;
    const typename World::Condensed::Shape &shape() const { return rest_.shape; }
    Change<N> take_change(const Tangent<N> &tangent);
    void went_to(const typename World::Condensed::Followed &followed);
    const typename World::Structure &structure() const { return structure_; }
    const JointLaw &law(std::size_t joint) const { return law_[joint]; } // from the world's first joint on
    unsigned structures_found() const { return structures_found_; } // it grows as the structure becomes another

    LimbHeld<N> held() const;

private:
    // A rest state.
    struct Rest {
        typename World::Condensed::Shape shape;
        std::array<double, N> instant_rad{}; // joints' deflections without creep
        std::array<double, N> torque_n_mm{};
        Vec tip_mm = Vec::Zero(); // from its weightless place
    };

    void let_creep(double dt_s);
    void find_unloaded();
    bool prepare();
    bool foresee(const Vec &target_mm);
    void begin_search(const Vec &target_mm, int free_axis);
    void begin_linear();
    bool balance_joints(const Tangent<N> &tangent, const Mat &compliance, const Mat &stiffness, const Vec &lacks_mm,
                        Change<N> &change);
    double turn_of(std::size_t joint) const
    {
        return rest_.shape.turn_rad[static_cast<std::size_t>(structure_.joint_body[joint])];
    }
    bool has_unknowns() const;
    bool remembers() const;

    const Model &model_;
    const Displacements displacements_;
    Model now_{}; // the limb at t_s_ and its temperature
    bool placed_ = false, prepared_ = false, is_changed_ = false;
    double contact_mm_per_n_ = 0.0;
    double theta1_rad_ = 0.0, theta2_rad_ = 0.0, t_s_ = 0.0;
    typename World::Structure structure_{};
    unsigned structures_found_ = 0;
    Vec weight_n_ = Vec::Zero(); // of all its bodies
    Mat joints_rigid_mm_per_n_ = Mat::Zero(); // its compliance without load and with rigid joints
    std::array<Vec, N> unloaded_lever_mm_{}; // of the joints
    double softest_mm_per_n_ = 0.0; // trace of its compliance without load
    double stops_mm_per_n_ = 0.0; // yields in series, where all else is rigid while joints stick
    std::array<JointLaw, N> law_{}; // the compliance of a rigid joint with backlash is its stop's
    std::array<bool, N> is_unknown_{}; // joints that are more than springs; they are the unknowns of a RestProblem

    Rest rest_; // where the limb is
    Search<N, Rest> search_;
    Step step_{}; // that is being taken
    KnownRests<N, Rest> known_; // at this posture and with these joints
    bool is_new_ = false; // nothing known was at the target
    // Where the tip was held before it came to where rest_ holds it, at this posture and in this run.
    Vec earlier_mm_ = Vec::Zero();
    Rest earlier_;
    bool has_earlier_ = false;
    bool leads_on_ = false; // the hold leads the tip to another place
    typename World::Condensed condensed_;
    bool is_condensed_ = false; // condensed_ is that of the unloaded limb
    Vec origin_mm_ = Vec::Zero(); // from where displacements count
    Vec tip_mm_ = Vec::Zero(); // where the contact has dragged the tip
    std::array<double, N> before_rad_{}; // rest_.instant_rad at the last reading
    std::array<bool, N> is_stuck_{}; // friction held the joint at the last reading
    std::array<double, N> delayed_rad_{}; // creep
    double creep_dt_s_ = -1.0, creep_approach_ = 0.0;
};

} // namespace brace::plant
