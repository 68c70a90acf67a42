// The simulated limb across its plane, against the reference's K in space: reference/ shares nothing with node/.
#include <cmath>

#include "node/coxa_chain.h"
#include "node/drive.h"
#include "rig/noise.h"

extern "C" {
#include "unity.h"
}

using brace::node::Across;
using brace::node::CoxaChain;
using brace::node::Motor;
using brace::node::PlanePosture;

void setUp(void) {}
void tearDown(void) {}

namespace
{

constexpr double kPlanted = INFINITY;
constexpr double kRoom_degc = 22.0;
constexpr PlanePosture kPosture = {1.0, 1.4};

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

// K across the plane, as the reference has it.
double k_across_n_per_mm(const brace_plant_model_t &limb, const PlanePosture &posture)
{
    const double theta0_rad = 0.0;
    double row[18];
    TEST_ASSERT_EQUAL_INT(BRACE_HOST_OK, brace_reference_spatial(&limb, 1, &theta0_rad, &posture.theta1_rad,
                                                                 &posture.theta2_rad, row));
    return row[3]; // k_yy where the limb's plane is the x-z plane
}

double lever_mm(const brace_plant_model_t &limb, const PlanePosture &posture)
{
    return limb.geometry.coxa_mm + limb.geometry.femur_mm * std::cos(posture.theta1_rad)
           + limb.geometry.tibia_mm * std::cos(posture.theta1_rad - posture.theta2_rad);
}

Across settled(CoxaChain &chain, double motor_rad, const PlanePosture &posture = kPosture, double t_s = 0.0,
               double temp_degc = kRoom_degc)
{
    Across across;
    TEST_ASSERT_TRUE(chain.settle(motor_rad, posture, t_s, temp_degc, across));
    TEST_ASSERT_TRUE(across.solved);
    return across;
}

void assert_close(double expected, double found, double relative)
{
    TEST_ASSERT_DOUBLE_WITHIN(relative * std::fabs(expected) + 1e-12, expected, found);
}

void a_held_tip_meets_the_k_of_the_reference()
{
    brace::rig::Noise random(3);
    const auto between = [&random](double low, double high) {
        return low + (high - low) * random.uniform();
    };
    for (int i = 0; i < 200; ++i) {
        brace_plant_model_t limb = spatial_limb();
        for (auto &link : limb.link) {
            link.lateral_mm_per_n = between(0.0, 0.3);
            link.torsion_rad_per_n_mm = between(0.0, 1e-5);
            link.moment_transfer_ratio = between(0.0, 1.0);
        }
        limb.joint[0].compliance_rad_per_n_mm = between(0.0, 2e-5);
        limb.geometry.coxa_mm = between(0.0, 100.0);
        const PlanePosture posture = {between(-1.5, 1.5), between(0.1, 2.8)};
        const double k = k_across_n_per_mm(limb, posture), lever = lever_mm(limb, posture);
        CoxaChain chain(limb);
        chain.take_hold(0.2, kPlanted, 1.5, 0.0);
        const Across pressed = settled(chain, 0.2, posture);
        assert_close(1.5 * k, pressed.force_n, 1e-9);
        chain.take_hold(0.2, kPlanted, 0.0, 0.0);
        const Across turned = settled(chain, 0.21, posture);
        assert_close(-0.01 * lever * k, turned.force_n, 1e-9);
        assert_close(0.01 * lever * lever * k, turned.load_n_mm, 1e-9);
        assert_close(lever * lever * k, turned.stiffness_n_mm_per_rad, 1e-9);
    }
}

void the_contact_yields_in_series()
{
    const brace_plant_model_t limb = spatial_limb();
    const double k = k_across_n_per_mm(limb, kPosture);
    CoxaChain chain(limb);
    chain.take_hold(0.0, 0.5, 2.0, 0.0);
    assert_close(2.0 / (1.0 / k + 1.0 / 0.5), settled(chain, 0.0).force_n, 1e-9);
    chain.take_hold(0.0, 0.0, 2.0, 0.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-5, 0.0, settled(chain, 0.0).force_n); // a free tip
}

void play_carries_nothing_until_a_flank_is_reached()
{
    brace_plant_model_t limb = spatial_limb();
    limb.joint[0].gap_rad = 0.006;
    const double lever = lever_mm(limb, kPosture), k = k_across_n_per_mm(limb, kPosture);
    CoxaChain chain(limb);
    chain.take_hold(0.1, kPlanted, 0.0, 0.0);
    for (const double moved : {0.0029, -0.0029, 0.001}) {
        const Across open = settled(chain, 0.1 + moved);
        TEST_ASSERT_DOUBLE_WITHIN(1e-3, 0.0, open.load_n_mm);
        TEST_ASSERT_EQUAL_INT(0, open.flank);
        TEST_ASSERT_DOUBLE_WITHIN(1e-8, 0.1, open.link_rad); // the tip holds the link where it was
    }
    const Across positive = settled(chain, 0.1 + 0.005);
    TEST_ASSERT_EQUAL_INT(1, positive.flank);
    assert_close((0.005 - 0.003) * lever * lever * k, positive.load_n_mm, 1e-6);
    const Across negative = settled(chain, 0.1 - 0.005);
    TEST_ASSERT_EQUAL_INT(-1, negative.flank);
    assert_close(-(0.005 - 0.003) * lever * lever * k, negative.load_n_mm, 1e-6);
}

void the_joint_has_its_friction_creep_zero_and_temperature()
{
    brace_plant_model_t limb = spatial_limb();
    limb.joint[0].coulomb_n_mm = 300.0;
    CoxaChain rubbing(limb);
    rubbing.take_hold(0.0, kPlanted, 0.0, 0.0);
    const double up = settled(rubbing, 0.01).load_n_mm;
    (void)settled(rubbing, 0.02);
    const double back = settled(rubbing, 0.01).load_n_mm;
    TEST_ASSERT_TRUE(up - back > 100.0); // loading and unloading branches differ

    limb = spatial_limb();
    limb.joint[0].zero_offset_rad = 0.03;
    limb.creep = {0.5, 1.0};
    limb.thermal.joint_compliance_per_degc = 0.01;
    CoxaChain chain(limb);
    chain.take_hold(0.0, kPlanted, 0.0, 0.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.03, settled(chain, 0.0).link_rad);
    const double at_once = settled(chain, 0.01).load_n_mm;
    TEST_ASSERT_TRUE(settled(chain, 0.01, kPosture, 10.0).load_n_mm < 0.9 * at_once);

    limb = spatial_limb();
    limb.thermal.joint_compliance_per_degc = 0.01;
    CoxaChain warm(limb);
    warm.take_hold(0.0, kPlanted, 1.0, 0.0);
    const double warm_n = settled(warm, 0.0, kPosture, 0.0, kRoom_degc + 50.0).force_n;
    limb.joint[0].compliance_rad_per_n_mm *= 1.5;
    assert_close(k_across_n_per_mm(limb, kPosture), warm_n, 1e-9);
}

void a_limb_with_nothing_across_its_plane_has_no_coxa_joint()
{
    brace_plant_model_t limb;
    brace_plant_model_default(&limb);
    limb.link[0].bending_mm_per_n = 0.1;      // in the plane
    limb.joint[0].gap_rad = 0.01;             // play alone is no spring
    limb.link[2].torsion_rad_per_n_mm = 1e-6; // the tip lies on this axis
    TEST_ASSERT_FALSE(brace::node::has_coxa_joint(limb));
    CoxaChain chain(limb);
    Across across;
    chain.take_hold(0.0, kPlanted, 0.0, 0.0);
    TEST_ASSERT_FALSE(chain.settle(0.0, kPosture, 0.0, kRoom_degc, across));
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
    brace_plant_model_t limb = spatial_limb();
    limb.joint[0].gap_rad = 0.006;
    const brace_node_drive_t drive = {6e4, NAN, 20.0, 0.0, 8000.0, 0.0, 0.0, 2e-5, 0.5};
    CoxaChain chain(limb);
    chain.take_hold(0.0, kPlanted, 0.0, 0.0);
    Motor motor;
    motor.limit_n_mm = 900.0;
    Across across = settled(chain, 0.0);
    using Scalar = Eigen::Matrix<double, 1, 1>;
    for (int ms = 1; ms <= 3000; ++ms) {
        brace::node::step_motors<1>(&drive, 1e-3, Scalar(0.1), Scalar(across.load_n_mm),
                                    Scalar(across.stiffness_n_mm_per_rad), &motor);
        across = settled(chain, motor.angle_rad, kPosture, 1e-3 * ms);
    }
    TEST_ASSERT_EQUAL_INT(1, across.flank);
    TEST_ASSERT_DOUBLE_WITHIN(1.0, 900.0, across.load_n_mm);
    const double turned_rad = 0.003 + 900.0 / across.stiffness_n_mm_per_rad;
    TEST_ASSERT_DOUBLE_WITHIN(1e-5, turned_rad, motor.angle_rad);
}

} // namespace

int main()
{
    UNITY_BEGIN();
    RUN_TEST(a_held_tip_meets_the_k_of_the_reference);
    RUN_TEST(the_contact_yields_in_series);
    RUN_TEST(play_carries_nothing_until_a_flank_is_reached);
    RUN_TEST(the_joint_has_its_friction_creep_zero_and_temperature);
    RUN_TEST(a_limb_with_nothing_across_its_plane_has_no_coxa_joint);
    RUN_TEST(a_motor_with_a_limit_presses_its_flank_with_that);
    return UNITY_END();
}
