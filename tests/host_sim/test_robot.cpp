// A simulated robot on its feet (brace_robot.h): equilibrium, Coulomb's law with history, lifted feet, grip, the fall.
//
// Equilibrium is judged from outside: the truth's forces and places against weights and payload, whose sums must vanish
// at rest. Motors stand still under their friction and the body's viscosity is gone after 0.2 s, 50 time constants, so
// 1e-6 of the weight is far above what is left. The ground's law is judged by De Saxce's natural map, which the
// simulation does not use.
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <vector>

#include "node/feet.h"
#include "node/pressed_limb.h"
#include "rig/noise.h"

extern "C" {
#include "api/brace_robot.h"
#include "unity.h"
}

using Eigen::Matrix3d;
using Eigen::Vector3d;

void setUp(void) {}
void tearDown(void) {}

namespace {

constexpr double kWeight_n = 30.0, kPi = 3.14159265358979323846;
constexpr double kBalance = 1e-6; // of the weight
const std::vector<double> kCorners = {0.25 * kPi, -0.25 * kPi, 0.75 * kPi, -0.75 * kPi};

struct Destroy {
    void operator()(brace_node_t *node) const { brace_node_destroy(node); }
};
using Node = std::unique_ptr<brace_node_t, Destroy>;

Vector3d vector_of(const double *numbers)
{
    return {numbers[0], numbers[1], numbers[2]};
}

void set(double *numbers, const Vector3d &vector)
{
    Eigen::Map<Vector3d>{numbers} = vector;
}

brace_node_limb_t leg()
{
    brace_node_limb_t limb;
    brace_node_limb_default(&limb);
    brace_plant_model_default(&limb.plant);
    limb.plant.geometry.coxa_mm = 55.0;
    limb.plant.geometry.femur_mm = 110.0;
    limb.plant.geometry.tibia_mm = 130.0;
    limb.plant.link[1].bending_mm_per_n = limb.plant.link[1].lateral_mm_per_n = 0.05;
    limb.plant.link[2].bending_mm_per_n = limb.plant.link[2].lateral_mm_per_n = 0.1;
    for (int joint = 0; joint < 3; ++joint) {
        limb.plant.joint[joint].compliance_rad_per_n_mm = 1e-5;
        limb.drive[joint].servo_n_mm_per_rad = 1e7;
    }
    limb.theta_rad[0] = 0.0;
    limb.theta_rad[1] = 0.4;
    limb.theta_rad[2] = 1.6;
    return limb;
}

struct Stance {
    std::vector<brace_node_limb_t> limbs;
    brace_robot_t robot{};

    // A leg at each yaw, on a floor.
    explicit Stance(const std::vector<double> &yaws, double friction = 0.9, double grip_n = 0.0)
    {
        robot.weight_n = kWeight_n;
        robot.down[2] = -1.0;
        for (const double yaw : yaws) {
            brace_robot_foot_t &foot = robot.foot[limbs.size()];
            limbs.push_back(leg());
            const Matrix3d turn = Eigen::AngleAxisd(yaw, Vector3d::UnitZ()).toRotationMatrix();
            set(foot.mount_mm, turn * Vector3d(150.0, 0.0, 0.0));
            Eigen::Map<Matrix3d>{foot.mount_turn} = turn.transpose();
            const Vector3d tip_mm(55.0 + 110.0 * std::cos(0.4) + 130.0 * std::cos(-1.2), 0.0,
                                  110.0 * std::sin(0.4) + 130.0 * std::sin(-1.2));
            set(foot.foothold_mm, vector_of(foot.mount_mm) + turn * tip_mm);
            foot.normal[2] = 1.0;
            foot.friction_ratio = friction;
            foot.grip_n = grip_n;
        }
    }

    void push(const Vector3d &payload_n, const Vector3d &at_mm)
    {
        set(robot.payload_n, payload_n);
        set(robot.payload_at_mm, at_mm);
    }

    Node made() const
    {
        brace_node_failure_t failure{};
        Node node(brace_robot_create(limbs.data(), static_cast<int32_t>(limbs.size()), &robot, nullptr, 1, &failure));
        TEST_ASSERT_NOT_NULL_MESSAGE(node.get(), "the robot is made");
        return node;
    }
};

brace_robot_truth_t after(const Node &node, double seconds)
{
    (void)brace_node_step(node.get(), static_cast<std::uint64_t>(1e6 * seconds));
    brace_robot_truth_t truth;
    TEST_ASSERT_EQUAL_INT(0, brace_robot_truth(node.get(), &truth));
    return truth;
}

Vector3d force(const brace_robot_truth_t &truth, int limb)
{
    return vector_of(truth.foot[limb].force_n);
}

Matrix3d turned(const brace_robot_truth_t &truth)
{
    const Vector3d rotation = vector_of(truth.rotation_rad);
    return Eigen::AngleAxisd(rotation.norm(), rotation.normalized()).toRotationMatrix();
}

// The forces of the ground, of the body's weight and of the payload balance. These limbs weigh nothing.
void balanced(const Stance &stance, const brace_robot_truth_t &truth)
{
    const Matrix3d turn = turned(truth);
    const Vector3d body_mm = vector_of(truth.displacement_mm);
    const Vector3d weight_n = stance.robot.weight_n * vector_of(stance.robot.down);
    const Vector3d payload_n = truth.payload_factor * vector_of(stance.robot.payload_n);
    Vector3d left_n = weight_n + payload_n;
    Vector3d left_n_mm = (body_mm + turn * vector_of(stance.robot.com_mm)).cross(weight_n) +
                         (body_mm + turn * vector_of(stance.robot.payload_at_mm)).cross(payload_n);
    for (int i = 0; i < truth.limb_count; ++i) {
        const Vector3d force_n = turn * force(truth, i);
        left_n += force_n;
        left_n_mm += vector_of(truth.foot[i].foot_mm).cross(force_n);
    }
    TEST_ASSERT_DOUBLE_WITHIN(kBalance * kWeight_n, 0.0, left_n.norm());
    TEST_ASSERT_DOUBLE_WITHIN(kBalance * kWeight_n * 200.0, 0.0, left_n_mm.norm());
    TEST_ASSERT_DOUBLE_WITHIN(kBalance, 0.0, truth.unbalanced_ratio);
}

// --------------------------------------------------------------------------------------------------- standing

void test_four_like_limbs_carry_a_quarter_each(void)
{
    const Stance stance(kCorners);
    const Node node = stance.made();
    const brace_robot_truth_t truth = after(node, 0.5);
    balanced(stance, truth);
    const double side_n = force(truth, 0).head<2>().norm();
    for (int i = 0; i < 4; ++i) {
        TEST_ASSERT_DOUBLE_WITHIN(kBalance * kWeight_n, 0.25 * kWeight_n, force(truth, i).z());
        TEST_ASSERT_DOUBLE_WITHIN(kBalance * kWeight_n, side_n, force(truth, i).head<2>().norm());
        TEST_ASSERT_EQUAL_INT(BRACE_ROBOT_STICKS, truth.foot[i].contact);
    }
    TEST_ASSERT_TRUE(truth.displacement_mm[2] < -0.5);
    TEST_ASSERT_TRUE(truth.fallen_s < 0.0);
}

// Legs that weigh something, on a slope, with a payload aside: the sum of all forces is the weight of all.
void test_the_ground_bears_the_weight_of_all(void)
{
    Stance stance(kCorners, 2.0);
    for (brace_node_limb_t &limb : stance.limbs) {
        limb.plant.gravity.femur_n = 0.5;
        limb.plant.gravity.knee_n = 0.8;
        limb.plant.gravity.tibia_n = 0.4;
    }
    set(stance.robot.down, {0.2, -0.1, -1.0});
    stance.push({4.0, 1.0, -2.0}, {20.0, -10.0, 30.0});
    const Node node = stance.made();
    TEST_ASSERT_EQUAL_INT(0, brace_robot_payload(node.get(), 0.1, 1.5, 0.2));
    const brace_robot_truth_t truth = after(node, 0.8);
    Vector3d borne_n = Vector3d::Zero();
    for (int i = 0; i < 4; ++i) {
        borne_n += turned(truth) * force(truth, i);
    }
    const Vector3d all_n =
        (kWeight_n + 4.0 * 1.7) * vector_of(stance.robot.down).normalized() + 1.5 * vector_of(stance.robot.payload_n);
    TEST_ASSERT_DOUBLE_WITHIN(kBalance * kWeight_n, 0.0, (borne_n + all_n).norm());
    TEST_ASSERT_DOUBLE_WITHIN(kBalance, 0.0, truth.unbalanced_ratio);
}

void test_the_same_robot_twice_is_the_same(void)
{
    Stance stance(kCorners, 0.5);
    stance.push({6.0, 2.0, -2.0}, {20.0, 0.0, 30.0});
    double first[3] = {};
    for (int i = 0; i < 2; ++i) {
        const Node node = stance.made();
        (void)brace_robot_payload(node.get(), 0.1, 1.0, 0.5);
        const brace_robot_truth_t truth = after(node, 0.4);
        if (i == 0) {
            set(first, vector_of(truth.displacement_mm));
        } else {
            TEST_ASSERT_EQUAL_MEMORY(first, truth.displacement_mm, sizeof first);
        }
    }
}

// A rest of feet that stick does not depend on how fast the payload came.
void test_the_rest_of_feet_that_stick_has_no_pace(void)
{
    Stance stance(kCorners, 2.0);
    for (brace_node_limb_t &limb : stance.limbs) { // motors that friction holds would remember
        for (brace_node_drive_t &drive : limb.drive) {
            drive.friction_n_mm = 0.0;
        }
    }
    stance.push({4.0, 1.0, -2.0}, {20.0, -10.0, 30.0});
    std::vector<Vector3d> found;
    for (const double ramp_s : {0.0, 0.7}) {
        const Node node = stance.made();
        (void)brace_robot_payload(node.get(), 0.1, 1.0, ramp_s);
        const brace_robot_truth_t truth = after(node, 1.5);
        balanced(stance, truth);
        for (int i = 0; i < 4; ++i) {
            found.push_back(force(truth, i));
        }
    }
    for (std::size_t i = 0; i < 4; ++i) {
        TEST_ASSERT_DOUBLE_WITHIN(kBalance * kWeight_n, 0.0, (found[i] - found[i + 4]).norm());
    }
}

// A joint that its own friction holds makes its limb many times stiffer. The body must come to rest all the same.
void test_joints_that_rub_do_not_shake_the_body(void)
{
    for (const double link_mm_per_n : {0.05, 0.005}) {
        Stance stance(kCorners, 2.0);
        for (brace_node_limb_t &limb : stance.limbs) {
            for (int i = 0; i < 3; ++i) {
                limb.plant.joint[i].coulomb_n_mm = 100.0;
                limb.plant.link[i].bending_mm_per_n = limb.plant.link[i].lateral_mm_per_n = link_mm_per_n;
            }
        }
        stance.push({4.0, 1.0, -2.0}, {20.0, -10.0, 30.0});
        const Node node = stance.made();
        balanced(stance, after(node, 0.3));
        (void)brace_robot_payload(node.get(), 0.4, 2.0, 0.3);
        balanced(stance, after(node, 1.5));
    }
}

// A foothold that is higher bears more, and the body tilts.
void test_a_higher_foothold_bears_more(void)
{
    Stance stance(kCorners);
    stance.robot.foot[0].foothold_mm[0] += 0.5; // and further out
    stance.robot.foot[0].foothold_mm[2] += 1.0;
    const Node node = stance.made();
    const brace_robot_truth_t truth = after(node, 0.5);
    balanced(stance, truth);
    for (const int other : {1, 2}) {
        TEST_ASSERT_TRUE(force(truth, 0).z() > force(truth, other).z() + 0.5);
    }
    for (int axis = 0; axis < 3; ++axis) {
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, stance.robot.foot[0].foothold_mm[axis], truth.foot[0].foot_mm[axis]);
    }
}

// ----------------------------------------------------------------------------------------------------- sliding

void test_a_foot_beyond_its_cone_slides_and_rests_on_it(void)
{
    constexpr double kFriction = 0.75;
    Stance stance(kCorners, kFriction);
    stance.push({8.0, 0.0, 0.0}, {0.0, 0.0, 30.0});
    const Node node = stance.made();
    const brace_robot_truth_t before = after(node, 0.3);
    for (int i = 0; i < 4; ++i) {
        TEST_ASSERT_EQUAL_INT(BRACE_ROBOT_STICKS, before.foot[i].contact);
    }
    (void)brace_robot_payload(node.get(), 0.4, 1.0, 1.0);
    const brace_robot_truth_t truth = after(node, 2.0);
    balanced(stance, truth);
    TEST_ASSERT_TRUE(truth.fallen_s < 0.0);
    int slid = 0;
    for (int i = 0; i < 4; ++i) {
        const Vector3d on_ground = turned(truth) * force(truth, i);
        const double side_n = on_ground.head<2>().norm(), held_n = kFriction * on_ground.z();
        const Vector3d way_mm = vector_of(truth.foot[i].foot_mm) - vector_of(before.foot[i].foot_mm);
        TEST_ASSERT_TRUE(side_n < held_n + kBalance * kWeight_n);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, way_mm.z());
        if (way_mm.norm() > 1e-3) {
            ++slid;
            TEST_ASSERT_DOUBLE_WITHIN(kBalance * kWeight_n, held_n, side_n);
            TEST_ASSERT_TRUE(way_mm.dot(on_ground) < 0.0); // against its friction
        } else {
            TEST_ASSERT_TRUE(way_mm.norm() < 1e-9);
        }
    }
    TEST_ASSERT_TRUE(slid > 0);
}

void test_what_slid_remembers_and_what_sticks_does_not(void)
{
    for (const bool slides : {true, false}) {
        Stance stance(kCorners, slides ? 0.75 : 3.0);
        for (brace_node_limb_t &limb : stance.limbs) {
            for (brace_node_drive_t &drive : limb.drive) {
                drive.friction_n_mm = 0.0;
            }
        }
        stance.push({8.0, 0.0, 0.0}, {0.0, 0.0, 30.0});
        const Node node = stance.made();
        const brace_robot_truth_t before = after(node, 0.3);
        (void)brace_robot_payload(node.get(), 0.4, 1.0, 0.5);
        (void)brace_robot_payload(node.get(), 1.2, 0.0, 0.5);
        const brace_robot_truth_t then = after(node, 2.2);
        TEST_ASSERT_DOUBLE_WITHIN(0.0, 0.0, then.payload_factor);
        balanced(stance, then);
        double most_n = 0.0;
        for (int i = 0; i < 4; ++i) {
            most_n = std::max(most_n, (force(then, i) - force(before, i)).norm());
        }
        TEST_ASSERT_TRUE(slides ? most_n > 0.1 : most_n < kBalance * kWeight_n);
    }
}

// ------------------------------------------------------------------------------------- lifting, grip and falling

void test_a_lifted_foot_bears_nothing_and_comes_down_again(void)
{
    const std::vector<double> six = {0.0, kPi / 3.0, 2.0 * kPi / 3.0, kPi, -2.0 * kPi / 3.0, -kPi / 3.0};
    for (const double grip_n : {0.0, 20.0}) {
        const Stance stance(six, 0.9, grip_n);
        const Node node = stance.made();
        TEST_ASSERT_EQUAL_INT(0, brace_robot_release(node.get(), 2, 0.1, 1.4));
        const double up_rad[3] = {0.0, 0.6, 1.6}, down_rad[3] = {0.0, 0.4, 1.6};
        TEST_ASSERT_EQUAL_INT(0, brace_robot_set_points(node.get(), 2, 0.1, up_rad));
        const brace_robot_truth_t moving = after(node, 0.4);
        TEST_ASSERT_EQUAL_INT(BRACE_ROBOT_OPEN, moving.foot[2].contact);
        TEST_ASSERT_DOUBLE_WITHIN(0.01, 0.0, force(moving, 2).norm()); // while it moves, too
        const brace_robot_truth_t lifted = after(node, 0.6);
        balanced(stance, lifted);
        TEST_ASSERT_EQUAL_INT(BRACE_ROBOT_OPEN, lifted.foot[2].contact);
        TEST_ASSERT_DOUBLE_WITHIN(kBalance * kWeight_n, 0.0, force(lifted, 2).norm());
        TEST_ASSERT_TRUE(lifted.foot[2].foot_mm[2] > stance.robot.foot[2].foothold_mm[2] + 10.0);
        (void)brace_robot_set_points(node.get(), 2, 1.0, down_rad);
        const brace_robot_truth_t down = after(node, 1.0);
        balanced(stance, down);
        TEST_ASSERT_EQUAL_INT(BRACE_ROBOT_STICKS, down.foot[2].contact);
        TEST_ASSERT_TRUE(force(down, 2).z() > 1.0);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, stance.robot.foot[2].foothold_mm[2], down.foot[2].foot_mm[2]);
        TEST_ASSERT_TRUE(down.fallen_s < 0.0);
    }
}

// A payload pulls one corner up: its foot grips 12 N and lets go where more is asked of it; the others hold the body.
void test_a_grip_holds_up_to_its_limit_and_is_then_gone(void)
{
    Stance stance(kCorners, 1.2, 60.0);
    stance.robot.foot[0].grip_n = 12.0;
    stance.push({0.0, 0.0, 42.0}, {150.0, 150.0, 0.0});
    const Node node = stance.made();
    (void)brace_robot_payload(node.get(), 0.1, 1.0, 1.0);
    double deepest_n = 0.0, gone_s = -1.0;
    for (int i = 0; i < 150 && gone_s < 0.0; ++i) {
        const brace_robot_truth_t truth = after(node, 0.01);
        if (truth.foot[0].contact == BRACE_ROBOT_GONE) {
            gone_s = truth.time_s;
        } else {
            deepest_n = std::min(deepest_n, force(truth, 0).z());
        }
    }
    TEST_ASSERT_TRUE(gone_s > 0.2);
    TEST_ASSERT_TRUE(deepest_n > -12.05 && deepest_n < -11.0);
    const brace_robot_truth_t truth = after(node, 0.5);
    TEST_ASSERT_TRUE(truth.fallen_s < 0.0);
    TEST_ASSERT_EQUAL_INT(BRACE_ROBOT_GONE, truth.foot[0].contact);
    TEST_ASSERT_DOUBLE_WITHIN(kBalance * kWeight_n, 0.0, force(truth, 0).norm());
}

void test_a_body_without_equilibrium_falls_once_and_time_goes_on(void)
{
    Stance stance(kCorners, 0.9);
    stance.push({0.0, 0.0, -60.0}, {600.0, 0.0, 0.0}); // beyond its feet
    const Node node = stance.made();
    TEST_ASSERT_TRUE(after(node, 0.2).fallen_s < 0.0);
    (void)brace_robot_payload(node.get(), 0.3, 1.0, 0.0);
    const brace_robot_truth_t truth = after(node, 1.0);
    TEST_ASSERT_TRUE(truth.fallen_s > 0.3 && truth.fallen_s < 1.0);
    const brace_robot_truth_t later = after(node, 0.5);
    TEST_ASSERT_EQUAL_DOUBLE(truth.fallen_s, later.fallen_s);
    TEST_ASSERT_EQUAL_MEMORY(truth.displacement_mm, later.displacement_mm, sizeof truth.displacement_mm);
    for (int i = 0; i < 4; ++i) {
        TEST_ASSERT_EQUAL_INT(BRACE_ROBOT_GONE, later.foot[i].contact);
        TEST_ASSERT_DOUBLE_WITHIN(kBalance * kWeight_n, 0.0, force(later, i).norm());
    }
    brace_snapshot_t snapshot;
    TEST_ASSERT_EQUAL_INT(0, brace_node_snapshot(node.get(), 0, &snapshot));
    TEST_ASSERT_TRUE(snapshot.sequence > 1000);
}

// A floor without friction holds a body that nothing pushes aside; on a slope it slides away for ever, and is said to.
void test_a_slope_without_friction_is_a_fall(void)
{
    Stance level(kCorners, 0.0);
    const brace_robot_truth_t truth = after(level.made(), 0.5);
    TEST_ASSERT_TRUE(truth.fallen_s < 0.0);
    for (int i = 0; i < 4; ++i) {
        TEST_ASSERT_DOUBLE_WITHIN(kBalance * kWeight_n, 0.0, force(truth, i).head<2>().norm());
    }
    Stance slope(kCorners, 0.2);
    set(slope.robot.down, {0.3, 0.0, -1.0});
    TEST_ASSERT_TRUE(after(slope.made(), 1.0).fallen_s >= 0.0);
}

// --------------------------------------------------------------------------------------------------- refusals, log

void test_what_makes_no_robot_is_refused(void)
{
    brace_node_failure_t failure{};
    const Stance good(kCorners);
    const auto made = [&](const Stance &stance) {
        return Node(brace_robot_create(stance.limbs.data(), static_cast<int32_t>(stance.limbs.size()), &stance.robot,
                                       nullptr, 0, &failure));
    };
    TEST_ASSERT_NULL(brace_robot_create(good.limbs.data(), 9, &good.robot, nullptr, 0, &failure));
    TEST_ASSERT_NULL(brace_robot_create(good.limbs.data(), 4, nullptr, nullptr, 0, &failure));
    for (int fault = 0; fault < 6; ++fault) {
        Stance bad = good;
        switch (fault) {
        case 0: bad.robot.down[2] = 0.0; break;
        case 1: bad.robot.foot[1].normal[2] = 0.0; break;
        case 2: bad.robot.foot[1].mount_turn[0] *= 2.0; break;
        case 3: bad.robot.foot[1].friction_ratio = NAN; break;
        case 4: bad.robot.weight_n = -1.0; break;
        default: // nothing yields across its plane
            bad.limbs[2].plant.joint[0].compliance_rad_per_n_mm = 0.0;
            bad.limbs[2].plant.link[1].lateral_mm_per_n = bad.limbs[2].plant.link[2].lateral_mm_per_n = 0.0;
        }
        TEST_ASSERT_NULL(made(bad).get());
        TEST_ASSERT_EQUAL_INT(BRACE_NODE_PART_LIMB, failure.part);
    }
    TEST_ASSERT_EQUAL_INT(2, failure.limb);
    const Node node = made(good);
    const double theta_rad[3] = {0.0, 9.0, 0.0};
    const brace_node_press_t press{};
    TEST_ASSERT_EQUAL_INT(-3, brace_robot_payload(node.get(), 0.0, NAN, 0.0));
    TEST_ASSERT_EQUAL_INT(-3, brace_robot_set_points(node.get(), 0, 0.0, theta_rad));
    TEST_ASSERT_EQUAL_INT(-3, brace_robot_release(node.get(), 4, 0.0, 0.0));
    TEST_ASSERT_EQUAL_INT(-3, brace_node_contact(node.get(), 0, 1.0, &press));
    const brace_node_limb_t alone = leg();
    const Node no_robot(brace_node_create(&alone, 1, nullptr, 0, nullptr));
    brace_robot_truth_t truth;
    TEST_ASSERT_EQUAL_INT(-3, brace_robot_truth(no_robot.get(), &truth));
    TEST_ASSERT_EQUAL_INT(-3, brace_robot_payload(no_robot.get(), 0.0, 1.0, 0.0));
}

void test_the_log_has_a_row_each_hundredth_of_a_second(void)
{
    const Stance stance(kCorners);
    const Node node = stance.made();
    std::vector<brace_robot_truth_t> rows(4000);
    (void)after(node, 1.0);
    const int read = brace_robot_log(node.get(), rows.data(), 60) + 0;
    TEST_ASSERT_EQUAL_INT(60, read);
    TEST_ASSERT_EQUAL_INT(41, brace_robot_log(node.get(), rows.data() + read, 3000));
    for (int i = 0; i <= 100; ++i) {
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.01 * i, rows[static_cast<std::size_t>(i)].time_s);
    }
    (void)after(node, 30.0); // the last 20 s are left
    TEST_ASSERT_EQUAL_INT(2000, brace_robot_log(node.get(), rows.data(), 4000));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 31.0, rows[1999].time_s);
}

// ------------------------------------------------------------------------------------------------------- the parts

// What a limb brings to its mount: the moment of the held tip's force, whatever bends between them.
void test_a_limb_brings_the_moment_of_its_tip_force(void)
{
    brace_plant_model_t model = leg().plant;
    model.base = {0.02, 0.01, 3e-6};
    model.joint[1].gap_rad = 0.01;
    model.joint[2].coulomb_n_mm = 100.0;
    model.joint[2].zero_offset_rad = 0.01;
    model.link[1].moment_transfer = 1.0;
    model.thermal.reference_degc = 22.0;
    for (const bool weighs : {false, true}) {
        brace::node::PressedLimb limb(model);
        const Vector3d motor_rad(0.3, 0.4, 1.6);
        brace::node::Pressed pressed;
        limb.take_hold(motor_rad, INFINITY, {}, 0.0, 22.0);
        const Vector3d tip_mm = limb.unloaded_tip_mm(motor_rad) + Vector3d(3.0, -4.0, 5.0);
        limb.stand_at(tip_mm, {0.0, 0.6, -0.8}, false);
        TEST_ASSERT_TRUE(limb.settle(motor_rad, 0.0, 22.0, pressed));
        const brace::node::Pull &pull = limb.pull();
        Vector3d moment = tip_mm.cross(pull.force_n), sum_n = pull.force_n;
        double allowed = 1e-7;
        if (weighs) { // seven millimetres bend the limb by less than that anywhere
            const Vector3d down(0.0, 0.6, -0.8), weight_n = 2.0 * down;
            const Matrix3d yaw = Eigen::AngleAxisd(0.3, Vector3d::UnitZ()).toRotationMatrix();
            moment += (yaw * Vector3d(55.0 + 110.0 * std::cos(0.4), 0.0, 110.0 * std::sin(0.4))).cross(weight_n);
            sum_n += weight_n;
            allowed = 2.0 * 7.1;
        }
        TEST_ASSERT_TRUE(pull.force_n.norm() > 1.0);
        TEST_ASSERT_DOUBLE_WITHIN(allowed, 0.0, (pull.carried_n_mm - moment).norm());
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, (pull.carried_n - sum_n).norm());
        model.gravity.knee_n = 2.0;
    }
}

double unit(brace::rig::Noise &noise)
{
    return 2.0 * noise.uniform() - 1.0;
}

// De Saxce's natural map: 0 where gap, force and way obey the law. A drag is none here.
double law_residual_n(const brace::node::Foot &foot, double stiffness)
{
    const double mu = foot.friction_ratio;
    const Eigen::Vector2d way = foot.way_mm.tail<2>();
    const double apart = foot.gap_mm + foot.way_mm.x(), grip = foot.gap_mm > 0.0 ? 0.0 : foot.grip_n;
    Vector3d z = foot.force_n + Vector3d(grip, 0.0, 0.0);
    const Vector3d borne = z;
    z -= stiffness * Vector3d(apart + mu * way.norm(), way.x(), way.y());
    const double side = z.tail<2>().norm(), normal = z.x();
    Vector3d projected = Vector3d::Zero();
    if (side <= mu * normal) {
        projected = z;
    } else if (mu * side > -normal) {
        const double along = (normal + mu * side) / (1.0 + mu * mu);
        projected << along, mu * along * z.tail<2>() / side;
    }
    return (borne - projected).norm();
}

// Feet that know one another only through how their forces follow the ways: stick, slide, open, all at once.
void test_feet_obey_the_law_of_their_ground(void)
{
    constexpr int kFeet = 4, kSize = 3 * kFeet;
    brace::rig::Noise noise(7);
    std::array<int, 4> seen{};
    for (int draw = 0; draw < 500; ++draw) {
        Eigen::Matrix<double, kSize, kSize> root;
        for (int i = 0; i < kSize * kSize; ++i) {
            root(i) = unit(noise);
        }
        brace::node::ByWays by_ways = brace::node::ByWays::Zero();
        by_ways.topLeftCorner<kSize, kSize>() =
            0.3 * root * root.transpose() / kSize + 2.0 * Eigen::Matrix<double, kSize, kSize>::Identity();
        std::array<brace::node::Foot, brace::node::kMostFeet> foot;
        std::array<Vector3d, kFeet> standing;
        for (int i = 0; i < kFeet; ++i) {
            const auto k = static_cast<std::size_t>(i);
            foot[k] = {0.2 + 0.8 * noise.uniform(),
                       0.0,
                       draw % 3 == 0 && i == 0 ? 0.3 * noise.uniform() : 0.0,
                       false,
                       {2.0 + 4.0 * unit(noise), 3.0 * unit(noise), 3.0 * unit(noise)},
                       Matrix3d::Zero(),
                       Vector3d::Zero(),
                       brace::node::Contact::sticks};
            standing[k] = foot[k].force_n;
        }
        TEST_ASSERT_TRUE(brace::node::find_ways(foot, kFeet, by_ways));
        for (int i = 0; i < kFeet; ++i) {
            const auto k = static_cast<std::size_t>(i);
            Vector3d force_n = standing[k];
            for (int j = 0; j < kFeet; ++j) {
                force_n += by_ways.block<3, 3>(3 * i, 3 * j) * foot[static_cast<std::size_t>(j)].way_mm;
            }
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, (force_n - foot[k].force_n).norm());
            TEST_ASSERT_DOUBLE_WITHIN(1e-8, 0.0, law_residual_n(foot[k], 2.0));
            ++seen[static_cast<std::size_t>(foot[k].contact)];
        }
    }
    for (const int contact : {BRACE_ROBOT_STICKS, BRACE_ROBOT_SLIDES, BRACE_ROBOT_OPEN}) {
        TEST_ASSERT_TRUE(seen[static_cast<std::size_t>(contact)] > 100);
    }
}

} // namespace

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_four_like_limbs_carry_a_quarter_each);
    RUN_TEST(test_the_ground_bears_the_weight_of_all);
    RUN_TEST(test_the_same_robot_twice_is_the_same);
    RUN_TEST(test_the_rest_of_feet_that_stick_has_no_pace);
    RUN_TEST(test_joints_that_rub_do_not_shake_the_body);
    RUN_TEST(test_a_higher_foothold_bears_more);
    RUN_TEST(test_a_foot_beyond_its_cone_slides_and_rests_on_it);
    RUN_TEST(test_what_slid_remembers_and_what_sticks_does_not);
    RUN_TEST(test_a_lifted_foot_bears_nothing_and_comes_down_again);
    RUN_TEST(test_a_grip_holds_up_to_its_limit_and_is_then_gone);
    RUN_TEST(test_a_body_without_equilibrium_falls_once_and_time_goes_on);
    RUN_TEST(test_a_slope_without_friction_is_a_fall);
    RUN_TEST(test_what_makes_no_robot_is_refused);
    RUN_TEST(test_the_log_has_a_row_each_hundredth_of_a_second);
    RUN_TEST(test_a_limb_brings_the_moment_of_its_tip_force);
    RUN_TEST(test_feet_obey_the_law_of_their_ground);
    return UNITY_END();
}
