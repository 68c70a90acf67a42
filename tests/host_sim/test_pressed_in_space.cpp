// The simulated limb in space between its motors and a contact, against the reference: reference/ shares nothing with
// plant/ and node/.
//
// Ellipsoids are the same springs for both, so the tolerance is the reference's 1e-9 mm times a stiffness of up to
// 1000 N/mm, 1e-6 N. So are beams of as many parts without weight. A beam of four parts differs from the uniform one by
// what docs/physics.md allows a plant: 1e-3 of the force is a tenth of the 1 % that a controller may be off.
#include <Eigen/Core>
#include <cmath>

#include "node/drive.h"
#include "node/pressed_limb.h"
#include "plant/structure.h"
#include "rig/noise.h"

extern "C" {
#include "unity.h"
}

using brace::node::Motor;
using brace::node::Pressed;
using brace::node::PressedLimb;
using Eigen::Vector3d;

void setUp(void) {}
void tearDown(void) {}

namespace {

constexpr double kPlanted = INFINITY;
constexpr double kRoom_degc = 22.0;
const Vector3d kPosture = {0.2, 1.0, 1.4}; // theta0, theta1, theta2

class Draw {
public:
    explicit Draw(std::uint64_t seed) : noise_(seed) {}
    double between(double low, double high) { return low + (high - low) * noise_.uniform(); }
    Vector3d direction()
    {
        for (;;) {
            const Vector3d v(between(-1.0, 1.0), between(-1.0, 1.0), between(-1.0, 1.0));
            if (v.norm() > 0.1 && v.norm() <= 1.0) {
                return v.normalized();
            }
        }
    }

private:
    brace::rig::Noise noise_;
};

brace_plant_model_t spatial_limb()
{
    brace_plant_model_t limb;
    brace_plant_model_default(&limb);
    limb.thermal.reference_degc = kRoom_degc;
    limb.link[0].axial_mm_per_n = limb.link[0].bending_mm_per_n = 0.001;
    limb.link[1].axial_mm_per_n = limb.link[2].axial_mm_per_n = 0.001;
    limb.link[1].bending_mm_per_n = limb.link[1].lateral_mm_per_n = 0.06;
    limb.link[2].bending_mm_per_n = limb.link[2].lateral_mm_per_n = 0.25;
    limb.link[0].lateral_mm_per_n = 0.01;
    limb.link[1].torsion_rad_per_n_mm = 2e-6;
    limb.joint[0].compliance_rad_per_n_mm = 8e-6;
    limb.joint[1].compliance_rad_per_n_mm = 1.0e-5;
    limb.joint[2].compliance_rad_per_n_mm = 1.6e-5;
    return limb;
}

// strength: of every link's moment transfer.
brace_plant_model_t random_limb(Draw &draw, double strength, bool weighs)
{
    brace_plant_model_t limb = spatial_limb();
    limb.geometry.coxa_mm = draw.between(30.0, 90.0);
    for (auto &link : limb.link) {
        link.axial_mm_per_n = draw.between(0.001, 0.004);
        link.bending_mm_per_n = draw.between(0.02, 0.2);
        link.lateral_mm_per_n = draw.between(0.02, 0.2);
        link.torsion_rad_per_n_mm = draw.between(0.0, 5e-6);
        link.tilt_rad = draw.between(-0.2, 0.2);
        link.moment_transfer = strength;
    }
    limb.link[0].bending_mm_per_n = draw.between(0.001, 0.005);
    limb.link[0].lateral_mm_per_n = draw.between(0.001, 0.005);
    for (auto &joint : limb.joint) {
        joint.compliance_rad_per_n_mm = draw.between(2e-6, 2e-5);
    }
    limb.base = {draw.between(0.0, 0.02), draw.between(0.0, 0.02), draw.between(0.0, 3e-6)};
    if (weighs) {
        limb.gravity.femur_n = draw.between(0.0, 4.0);
        limb.gravity.tibia_n = draw.between(0.0, 4.0);
        limb.gravity.knee_n = draw.between(0.0, 4.0);
        limb.gravity.direction_rad = draw.between(-3.1, 3.1);
        limb.gravity.lean_rad = draw.between(-1.2, 1.2);
    }
    return limb;
}

// The reference's frame is the limb's plane where theta0 is 0.
brace_loaded_space_result_t reference(const brace_plant_model_t &limb, const Vector3d &posture, const Vector3d &force_n,
                                      int parts)
{
    const double within = std::cos(limb.gravity.lean_rad);
    const brace_loaded_space_case_t asked = {0.0,
                                             posture[1],
                                             posture[2],
                                             force_n.x(),
                                             force_n.y(),
                                             force_n.z(),
                                             0.0,
                                             0.0,
                                             0.0,
                                             within * std::cos(limb.gravity.direction_rad),
                                             std::sin(limb.gravity.lean_rad),
                                             within * std::sin(limb.gravity.direction_rad)};
    brace_loaded_space_result_t expected;
    TEST_ASSERT_EQUAL_INT(BRACE_HOST_OK,
                          brace_reference_space_under_force(&limb, 1, &asked, parts, &expected, nullptr));
    return expected;
}

Pressed settled(PressedLimb &limb, const Vector3d &motor_rad, double t_s = 0.0, double temp_degc = kRoom_degc)
{
    Pressed pressed;
    TEST_ASSERT_TRUE(limb.settle(motor_rad, t_s, temp_degc, pressed));
    TEST_ASSERT_TRUE(pressed.solved);
    return pressed;
}

Pressed pressed_by(const brace_plant_model_t &model, const Vector3d &motor_rad, const Vector3d &press_mm,
                   double hold_n_per_mm = kPlanted, double temp_degc = kRoom_degc)
{
    PressedLimb limb(model);
    limb.take_hold(motor_rad, hold_n_per_mm, press_mm, 0.0, temp_degc);
    return settled(limb, motor_rad, 0.0, temp_degc);
}

void assert_close(double expected, double found, double relative)
{
    TEST_ASSERT_DOUBLE_WITHIN(relative * std::fabs(expected) + 1e-12, expected, found);
}

// Where the reference's tip goes under a force, the plant's tip is held by that force.
void assert_equilibria(std::uint64_t seed, int count, double strength, bool weighs, int parts, double tolerance)
{
    Draw draw(seed);
    for (int i = 0; i < count; ++i) {
        const brace_plant_model_t limb = random_limb(draw, strength, weighs);
        const Vector3d posture(draw.between(-1.0, 1.0), draw.between(-1.2, 1.2), draw.between(0.3, 2.4));
        const Vector3d force_n = draw.between(2.0, 20.0) * draw.direction();
        const brace_loaded_space_result_t expected = reference(limb, posture, force_n, parts);
        if (!(expected.buckling_factor > 2.0)) {
            continue; // near collapse the smallest difference grows
        }
        const Pressed pressed = pressed_by(limb, posture, {expected.dx_mm, expected.dy_mm, expected.dz_mm});
        TEST_ASSERT_DOUBLE_WITHIN(tolerance * force_n.norm() + 1e-6, 0.0, (pressed.force_n - force_n).norm());
        const Vector3d turn_rad(expected.coxa_rad, expected.femur_rad, -expected.tibia_rad);
        TEST_ASSERT_DOUBLE_WITHIN(tolerance * turn_rad.norm() + 1e-9, 0.0,
                                  (pressed.link_rad - posture - turn_rad).norm());
        const Vector3d load_n_mm(-expected.coxa_n_mm, -expected.femur_n_mm, expected.tibia_n_mm);
        TEST_ASSERT_DOUBLE_WITHIN(tolerance * load_n_mm.norm() + 1e-4, 0.0, (pressed.load_n_mm - load_n_mm).norm());
    }
}

void ellipsoids_rest_where_the_reference_does()
{
    assert_equilibria(3, 150, 0.0, true, 1, 0.0);
}

void beams_of_as_many_parts_rest_where_the_reference_does()
{
    assert_equilibria(4, 60, 1.0, false, brace::plant::kBeamParts, 0.0);
    assert_equilibria(5, 60, 0.4, false, brace::plant::kBeamParts, 0.0);
}

void beams_with_weight_are_near_the_uniform_beam()
{
    assert_equilibria(6, 60, 1.0, true, 0, 1e-3);
    assert_equilibria(7, 60, 0.6, true, 0, 1e-3);
}

// The stiffness that the motors feel is the change of their loads with their angles. The base's springs and the weight
// belong to the limb's plane and turn with the coxa's motor, which no tangent of the joint knows: without them.
void the_motors_feel_the_tangent()
{
    Draw draw(8);
    for (int i = 0; i < 30; ++i) {
        brace_plant_model_t model = random_limb(draw, i % 2, false);
        model.base = {};
        const Vector3d posture(0.3, draw.between(-1.0, 1.0), draw.between(0.5, 2.2));
        const Vector3d force_n = 10.0 * draw.direction();
        const brace_loaded_space_result_t expected = reference(model, posture, force_n, brace::plant::kBeamParts);
        PressedLimb limb(model);
        limb.take_hold(posture, 5.0, {expected.dx_mm, expected.dy_mm, expected.dz_mm}, 0.0, kRoom_degc);
        const Pressed here = settled(limb, posture);
        for (const int joint : {0, 1, 2}) {
            const double step_rad = 1e-6;
            const Vector3d step = step_rad * Vector3d::Unit(joint);
            const Vector3d by_difference =
                (settled(limb, posture + step).load_n_mm - settled(limb, posture - step).load_n_mm) / (2.0 * step_rad);
            const Vector3d expected_n_mm = here.stiffness_n_mm_per_rad.col(joint);
            // Rounding of a torque, 1e-7 N mm, over the step; and what the second difference leaves.
            TEST_ASSERT_DOUBLE_WITHIN(1e-4 * expected_n_mm.norm() + 1.0, 0.0, (by_difference - expected_n_mm).norm());
        }
    }
}

void the_contact_stays_where_it_is_while_the_coxa_turns()
{
    const brace_plant_model_t model = spatial_limb();
    PressedLimb limb(model);
    limb.take_hold(kPosture, kPlanted, Vector3d::Zero(), 0.0, kRoom_degc);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, settled(limb, kPosture).force_n.norm());
    const double angle_rad = 0.05;
    const Pressed turned = settled(limb, kPosture + Vector3d(angle_rad, 0.0, 0.0));
    const auto &length = model.geometry;
    const double lever_mm = length.coxa_mm + length.femur_mm * std::cos(1.0) + length.tibia_mm * std::cos(1.0 - 1.4);
    const Vector3d back_mm(lever_mm * (std::cos(angle_rad) - 1.0), -lever_mm * std::sin(angle_rad), 0.0);
    const Pressed pressed = pressed_by(model, kPosture, back_mm);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.0, (turned.force_n - pressed.force_n).norm());
    TEST_ASSERT_TRUE(pressed.force_n.y() < -5.0);
}

void the_contact_yields_in_series()
{
    const brace_plant_model_t model = spatial_limb();
    const Vector3d force_n(2.0, -6.0, 5.0);
    const brace_loaded_space_result_t expected = reference(model, kPosture, force_n, 1);
    const Vector3d moved_mm(expected.dx_mm, expected.dy_mm, expected.dz_mm);
    const Pressed soft = pressed_by(model, kPosture, moved_mm + force_n / 0.5, 0.5);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.0, (soft.force_n - force_n).norm());
    const Pressed loose = pressed_by(model, kPosture, {0.0, 2.0, 0.0}, 0.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-5, 0.0, loose.force_n.norm()); // a free tip
}

void a_free_limb_hangs_under_its_weight()
{
    Draw draw(9);
    for (int i = 0; i < 20; ++i) {
        const brace_plant_model_t model = random_limb(draw, i % 2, true);
        const brace_loaded_space_result_t expected = reference(model, kPosture, Vector3d::Zero(), 0);
        const Pressed hangs = pressed_by(model, kPosture, Vector3d::Zero(), 0.0);
        const Vector3d load_n_mm(-expected.coxa_n_mm, -expected.femur_n_mm, expected.tibia_n_mm);
        // It is held by 1e-6 N/mm over some ten millimetres and a lever of 500 mm: 0.01 N mm.
        TEST_ASSERT_DOUBLE_WITHIN(1e-3 * load_n_mm.norm() + 0.1, 0.0, (hangs.load_n_mm - load_n_mm).norm());
        TEST_ASSERT_TRUE(std::fabs(expected.coxa_n_mm) > 1.0); // some weight is across the plane
    }
}

// Play turns the joint, not the tip's levers of the straight limb: at rest the plane stands turned by half the gap.
void play_acts_in_the_turned_joint()
{
    brace_plant_model_t model = spatial_limb();
    const double gap_rad = 0.2;
    const Vector3d force_n(3.0, 8.0, 4.0);
    // The force's frame is that of the turned plane for the reference.
    const double c = std::cos(0.5 * gap_rad), s = std::sin(0.5 * gap_rad);
    const Vector3d in_turned(c * force_n.x() + s * force_n.y(), c * force_n.y() - s * force_n.x(), force_n.z());
    const brace_loaded_space_result_t expected = reference(model, kPosture, in_turned, 1);
    const auto &length = model.geometry;
    const Vector3d tip_mm(length.coxa_mm + length.femur_mm * std::cos(1.0) + length.tibia_mm * std::cos(-0.4), 0.0,
                          length.femur_mm * std::sin(1.0) + length.tibia_mm * std::sin(-0.4));
    const Vector3d place = tip_mm + Vector3d(expected.dx_mm, expected.dy_mm, expected.dz_mm);
    const Vector3d back(c * place.x() - s * place.y(), s * place.x() + c * place.y(), place.z());
    model.joint[0].gap_rad = gap_rad;
    const Pressed pressed = pressed_by(model, kPosture, back - tip_mm);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.0, (pressed.force_n - force_n).norm());
    TEST_ASSERT_EQUAL_INT(-1, pressed.flank[0]);
    assert_close(kPosture[0] + 0.5 * gap_rad + expected.coxa_rad, pressed.link_rad[0], 1e-9);
    assert_close(-expected.coxa_n_mm, pressed.load_n_mm[0], 1e-6);
}

void play_carries_nothing_until_a_flank_is_reached()
{
    brace_plant_model_t model = spatial_limb();
    model.joint[0].gap_rad = 0.006;
    PressedLimb limb(model);
    limb.take_hold(kPosture, kPlanted, Vector3d::Zero(), 0.0, kRoom_degc);
    for (const double moved : {0.0029, -0.0029, 0.001}) {
        const Pressed open = settled(limb, kPosture + Vector3d(moved, 0.0, 0.0));
        TEST_ASSERT_DOUBLE_WITHIN(1e-3, 0.0, open.load_n_mm[0]);
        TEST_ASSERT_EQUAL_INT(0, open.flank[0]);
        TEST_ASSERT_DOUBLE_WITHIN(1e-8, kPosture[0], open.link_rad[0]); // the tip holds the link where it was
    }
    const Pressed positive = settled(limb, kPosture + Vector3d(0.005, 0.0, 0.0));
    TEST_ASSERT_EQUAL_INT(1, positive.flank[0]);
    TEST_ASSERT_TRUE(positive.load_n_mm[0] > 100.0);
    const Pressed negative = settled(limb, kPosture - Vector3d(0.005, 0.0, 0.0));
    TEST_ASSERT_EQUAL_INT(-1, negative.flank[0]);
    assert_close(-positive.load_n_mm[0], negative.load_n_mm[0], 1e-4); // the limb is the same on both sides
}

// A joint that hardens or rubs carries what its law says of its deflection, in a bent and turned limb too.
void laws_of_joints_hold_in_the_bent_limb()
{
    brace_plant_model_t model = spatial_limb();
    const Vector3d press_mm(6.0, 25.0, -15.0);
    for (auto &joint : model.joint) {
        joint.hardening_n_mm_per_rad3 = 2e7;
    }
    const Pressed hard = pressed_by(model, kPosture, press_mm);
    for (const int i : {0, 1, 2}) {
        const double q = hard.link_rad[i] - kPosture[i];
        assert_close(-(q / model.joint[i].compliance_rad_per_n_mm + 2e7 * q * q * q), hard.load_n_mm[i], 1e-6);
    }
    model = spatial_limb();
    for (auto &joint : model.joint) {
        joint.coulomb_n_mm = 150.0;
    }
    PressedLimb rubbing(model);
    rubbing.take_hold(kPosture, kPlanted, press_mm, 0.0, kRoom_degc);
    for (const double to_rad : {0.0, 0.02, 0.005, -0.03}) {
        const Vector3d motor_rad = kPosture + Vector3d(to_rad, 0.0, 0.0);
        const Pressed rubs = settled(rubbing, motor_rad);
        for (const int i : {0, 1, 2}) {
            const double spring_n_mm = -(rubs.link_rad[i] - motor_rad[i]) / model.joint[i].compliance_rad_per_n_mm;
            TEST_ASSERT_TRUE(std::fabs(rubs.load_n_mm[i] - spring_n_mm) <= 150.0 + 1e-3);
        }
    }
}

void the_joint_has_its_friction_creep_zero_and_temperature()
{
    const Vector3d coxa = Vector3d::UnitX();
    brace_plant_model_t model = spatial_limb();
    model.joint[0].coulomb_n_mm = 300.0;
    PressedLimb rubbing(model);
    rubbing.take_hold(kPosture, kPlanted, Vector3d::Zero(), 0.0, kRoom_degc);
    const double up = settled(rubbing, kPosture + 0.01 * coxa).load_n_mm[0];
    (void)settled(rubbing, kPosture + 0.02 * coxa);
    const double back = settled(rubbing, kPosture + 0.01 * coxa).load_n_mm[0];
    TEST_ASSERT_TRUE(up - back > 100.0); // loading and unloading branches differ

    model = spatial_limb();
    model.joint[0].zero_offset_rad = 0.03;
    model.creep = {0.5, 1.0};
    PressedLimb limb(model);
    limb.take_hold(kPosture, kPlanted, Vector3d::Zero(), 0.0, kRoom_degc);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, kPosture[0] + 0.03, settled(limb, kPosture).link_rad[0]);
    const double at_once = settled(limb, kPosture + 0.01 * coxa).load_n_mm[0];
    TEST_ASSERT_TRUE(settled(limb, kPosture + 0.01 * coxa, 10.0).load_n_mm[0] < 0.9 * at_once);

    model = spatial_limb();
    model.thermal.joint_compliance_per_degc = 0.01;
    const Pressed warm = pressed_by(model, kPosture, {0.0, 1.0, 0.0}, kPlanted, kRoom_degc + 50.0);
    for (auto &joint : model.joint) {
        joint.compliance_rad_per_n_mm *= 1.5;
    }
    assert_close(pressed_by(model, kPosture, {0.0, 1.0, 0.0}).force_n.y(), warm.force_n.y(), 1e-9);
}

void a_limb_with_nothing_across_its_plane_has_no_coxa_joint()
{
    brace_plant_model_t limb;
    brace_plant_model_default(&limb);
    limb.link[0].bending_mm_per_n = 0.1; // in the plane
    limb.joint[0].gap_rad = 0.01; // play alone is no spring
    limb.link[2].torsion_rad_per_n_mm = 1e-6; // the tip lies on this axis
    TEST_ASSERT_FALSE(brace::node::has_coxa_joint(limb));
    limb.link[1].torsion_rad_per_n_mm = 1e-6;
    TEST_ASSERT_TRUE(brace::node::has_coxa_joint(limb));
    limb.link[1] = {};
    limb.link[2].lateral_mm_per_n = 1e-3;
    TEST_ASSERT_TRUE(brace::node::has_coxa_joint(limb));
    limb.link[2] = {};
    limb.joint[0].compliance_rad_per_n_mm = 1e-6;
    TEST_ASSERT_TRUE(brace::node::has_coxa_joint(limb));
}

// A drive whose torque is limited comes to stand where the flank carries as much.
void a_motor_with_a_limit_presses_its_flank_with_that()
{
    brace_plant_model_t model = spatial_limb();
    model.joint[0].gap_rad = 0.006;
    brace_node_drive_t drive[3];
    Motor motor[3];
    for (const int i : {0, 1, 2}) {
        drive[i] = {6e4, NAN, 20.0, 0.0, 8000.0, 0.0, 0.0, 2e-5, 0.5, 0.0, 0.0};
        motor[i].angle_rad = kPosture[i];
        motor[i].limit_n_mm = 8000.0;
    }
    motor[0].limit_n_mm = 900.0;
    PressedLimb limb(model);
    limb.take_hold(kPosture, kPlanted, Vector3d::Zero(), 0.0, kRoom_degc);
    Pressed pressed = settled(limb, kPosture);
    for (int ms = 1; ms <= 3000; ++ms) {
        brace::node::step_motors<3>(drive, 1e-3, kPosture + Vector3d(0.1, 0.0, 0.0), pressed.load_n_mm,
                                    pressed.stiffness_n_mm_per_rad, motor);
        pressed = settled(limb, {motor[0].angle_rad, motor[1].angle_rad, motor[2].angle_rad}, 1e-3 * ms);
    }
    TEST_ASSERT_EQUAL_INT(1, pressed.flank[0]);
    TEST_ASSERT_DOUBLE_WITHIN(1.0, 900.0, pressed.load_n_mm[0]);
    TEST_ASSERT_TRUE(motor[0].angle_rad - kPosture[0] > 0.003 + 900.0 / pressed.stiffness_n_mm_per_rad(0, 0) - 1e-3);
}

} // namespace

int main()
{
    UNITY_BEGIN();
    RUN_TEST(ellipsoids_rest_where_the_reference_does);
    RUN_TEST(beams_of_as_many_parts_rest_where_the_reference_does);
    RUN_TEST(beams_with_weight_are_near_the_uniform_beam);
    RUN_TEST(the_motors_feel_the_tangent);
    RUN_TEST(the_contact_stays_where_it_is_while_the_coxa_turns);
    RUN_TEST(the_contact_yields_in_series);
    RUN_TEST(a_free_limb_hangs_under_its_weight);
    RUN_TEST(play_acts_in_the_turned_joint);
    RUN_TEST(play_carries_nothing_until_a_flank_is_reached);
    RUN_TEST(laws_of_joints_hold_in_the_bent_limb);
    RUN_TEST(the_joint_has_its_friction_creep_zero_and_temperature);
    RUN_TEST(a_limb_with_nothing_across_its_plane_has_no_coxa_joint);
    RUN_TEST(a_motor_with_a_limit_presses_its_flank_with_that);
    return UNITY_END();
}
