// Controllers over limbs with everything that can be wrong with them: nothing unsolved, nothing that is no
// number, and under the sanitizers no access out of place.
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <memory>

extern "C" {
#include "api/brace_node.h"
#include "unity.h"
}

void setUp(void) {}
void tearDown(void) {}

namespace {

struct Closed {
    void operator()(brace_node_t *node) const { brace_node_destroy(node); }
};
using Node = std::unique_ptr<brace_node_t, Closed>;

brace_node_limb_t default_limb()
{
    brace_node_limb_t limb;
    brace_node_limb_default(&limb);
    return limb;
}

brace_node_limb_t hostile_limb()
{
    brace_node_limb_t limb = default_limb();
    for (const int i : {1, 2}) {
        limb.plant.joint[i].gap_rad = 0.005 * i;
        limb.plant.joint[i].coulomb_n_mm = 150.0;
        limb.plant.joint[i].hardening_n_mm_per_rad3 = 1e9;
        limb.plant.joint[i].zero_offset_rad = 0.01;
    }
    limb.plant.gravity = {2.0, 3.0, 1.0, -M_PI_2, 0.0};
    limb.plant.sensor.bias_x_n = 0.3;
    limb.plant.creep = {0.2, 0.5};
    limb.plant.thermal.joint_compliance_per_degc = 0.01;
    limb.plant.contact.play_mm = 0.2;
    limb.plant.change = {1.5, 2.0, 3.0};
    limb.temp_rise_degc = 20.0;
    limb.temp_time_constant_s = 1.0;
    limb.press = {1.0, 3.0, -2.0};
    limb.has_link_encoder = 1;
    return limb;
}

// The same limb with a coxa joint.
brace_node_limb_t in_space(brace_node_limb_t limb)
{
    limb.plant.joint[0].compliance_rad_per_n_mm = 8e-6;
    limb.plant.joint[0].gap_rad = 0.004;
    limb.plant.joint[0].coulomb_n_mm = 150.0;
    limb.plant.joint[0].hardening_n_mm_per_rad3 = 1e9;
    limb.plant.joint[0].zero_offset_rad = 0.01;
    limb.plant.link[1].lateral_mm_per_n = 0.06;
    limb.plant.link[2].lateral_mm_per_n = 0.25;
    return limb;
}

void check_truth(brace_node_t *node, int limb)
{
    brace_node_truth_t truth;
    TEST_ASSERT_EQUAL_INT(0, brace_node_truth(node, limb, &truth));
    TEST_ASSERT_TRUE(truth.solved);
    for (const int i : {0, 1, 2}) {
        TEST_ASSERT_TRUE(std::isfinite(truth.motor_rad[i]) && std::isfinite(truth.link_rad[i]));
        TEST_ASSERT_TRUE(std::fabs(truth.torque_n_mm[i]) <= 8000.0);
        TEST_ASSERT_TRUE(std::fabs(truth.load_n_mm[i]) < 50000.0);
    }
}

void hostile_limbs_are_lived_with()
{
    brace_node_limb_t limbs[] = {hostile_limb(), default_limb(), hostile_limb(), hostile_limb(),
                                 in_space(hostile_limb())};
    constexpr int kLimbs = 5;
    limbs[2].hold_n_per_mm = 0.0;
    limbs[3].hold_n_per_mm = 15.0;
    brace_node_failure_t failure;
    const Node node(brace_node_create(limbs, kLimbs, "none", 7, &failure));
    TEST_ASSERT_NOT_NULL(node.get());
    for (int limb = 0; limb < kLimbs; ++limb) {
        for (int fault = 0; fault < BRACE_NODE_FAULT_COUNT; ++fault) {
            TEST_ASSERT_EQUAL_INT(
                0, brace_node_fault(node.get(), limb, fault, limb == 4 ? 0 : 1, 20.0, 0.3 + 0.2 * fault, 0.15));
        }
        for (int i = 0; i < 8; ++i) {
            TEST_ASSERT_EQUAL_INT(0, brace_node_posture(node.get(), limb, 0.4 * i, 1.0 + 0.03 * (i % 2), 1.4));
        }
    }
    for (int i = 0; i < 350; ++i) {
        brace_node_step(node.get(), 10000);
        for (int limb = 0; limb < kLimbs; ++limb) {
            check_truth(node.get(), limb);
        }
        if (i == 100) {
            TEST_ASSERT_EQUAL_INT(0, brace_node_restart(node.get(), 1));
        }
    }
    brace_node_stats_t stats;
    brace_node_stats(node.get(), &stats);
    TEST_ASSERT_EQUAL_UINT64(3500000, stats.time_us);
    TEST_ASSERT_EQUAL_UINT32(0, stats.watchdog_resets);
}

void the_watchdog_bites_a_controller_that_does_not_tick()
{
    brace_node_limb_t limb = default_limb();
    const Node node(brace_node_create(&limb, 1, nullptr, 0, nullptr));
    TEST_ASSERT_NOT_NULL(node.get());
    TEST_ASSERT_EQUAL_INT(0, brace_node_fault(node.get(), 0, BRACE_NODE_FAULT_TICK_LATE, 0, 6000.0, 0.5, 0.1));
    brace_node_step(node.get(), 10000000);
    brace_node_stats_t stats;
    brace_node_stats(node.get(), &stats);
    TEST_ASSERT_TRUE(stats.ticks < 5000);
    brace_snapshot_t snapshot;
    TEST_ASSERT_EQUAL_INT(0, brace_node_snapshot(node.get(), 0, &snapshot));
    TEST_ASSERT_EQUAL_INT(BRACE_MODE_MONITOR, snapshot.mode);
}

void what_cannot_be_simulated_is_refused()
{
    brace_node_failure_t failure;
    const auto refused = [&failure](const brace_node_limb_t &limb) {
        return brace_node_create(&limb, 1, "none", 0, &failure) == nullptr && failure.part == BRACE_NODE_PART_LIMB;
    };
    brace_node_limb_t limb = default_limb();
    limb.plant.geometry.femur_mm = -1.0;
    TEST_ASSERT_TRUE(refused(limb) && failure.detail == BRACE_HOST_E_PARAMETER);
    limb = default_limb();
    limb.drive[1].servo_n_mm_per_rad = 0.0;
    TEST_ASSERT_TRUE(refused(limb) && failure.detail == BRACE_HOST_E_RANGE);
    limb = default_limb();
    limb.theta_rad[2] = NAN;
    TEST_ASSERT_TRUE(refused(limb));
    limb = default_limb();
    for (const int i : {1, 2}) {
        limb.plant.link[i] = {};
        limb.plant.joint[i].compliance_rad_per_n_mm = 0.0;
    }
    TEST_ASSERT_TRUE(refused(limb) && failure.detail == BRACE_HOST_E_SINGULAR);
    limb = default_limb();
    const std::uint8_t nonsense[64] = {1, 2, 3};
    limb.block = nonsense;
    limb.block_bytes = sizeof nonsense;
    TEST_ASSERT_NULL(brace_node_create(&limb, 1, "none", 0, &failure));
    TEST_ASSERT_EQUAL_INT(BRACE_NODE_PART_BLOCK, failure.part);
    TEST_ASSERT_NULL(brace_node_create(&limb, 0, "none", 0, &failure));
    TEST_ASSERT_NULL(brace_node_create(&limb, BRACE_NODE_LIMBS + 1, "none", 0, &failure));
    limb = default_limb();
    limb.press.y_mm = NAN;
    TEST_ASSERT_TRUE(refused(limb));
    TEST_ASSERT_NULL(brace_node_create(nullptr, 1, "none", 0, nullptr));
}

// The door answers for a coxa joint where the plant has one, and only there; its faults are refused otherwise.
void the_coxa_joint_is_there_where_something_yields_across_the_plane()
{
    const brace_node_limb_t limbs[] = {default_limb(), in_space(default_limb())};
    const Node node(brace_node_create(limbs, 2, "none", 1, nullptr));
    TEST_ASSERT_NOT_NULL(node.get());
    brace_node_step(node.get(), 500000);
    brace_snapshot_t planar, spatial;
    brace_node_truth_t truth;
    TEST_ASSERT_EQUAL_INT(0, brace_node_snapshot(node.get(), 0, &planar));
    TEST_ASSERT_EQUAL_INT(0, brace_node_snapshot(node.get(), 1, &spatial));
    TEST_ASSERT_FALSE(planar.space.is_fitted || planar.space.is_valid);
    TEST_ASSERT_TRUE(spatial.space.is_fitted);
    TEST_ASSERT_FALSE(std::isfinite(planar.theta_rad[0]));
    TEST_ASSERT_TRUE(std::isfinite(spatial.theta_rad[0]));
    TEST_ASSERT_EQUAL_INT(0, brace_node_truth(node.get(), 0, &truth));
    TEST_ASSERT_FALSE(truth.has_coxa_joint);
    TEST_ASSERT_EQUAL_INT(0, brace_node_truth(node.get(), 1, &truth));
    TEST_ASSERT_TRUE(truth.has_coxa_joint);
    for (const int limb : {0, 1}) {
        const std::int32_t status =
            brace_node_fault(node.get(), limb, BRACE_NODE_FAULT_SENSOR_DEAD, 0, 0.0, 1.0, INFINITY);
        TEST_ASSERT_EQUAL_INT(limb == 0 ? BRACE_HOST_E_RANGE : BRACE_HOST_OK, status);
    }
    brace_node_step(node.get(), 1500000);
    TEST_ASSERT_EQUAL_INT(0, brace_node_snapshot(node.get(), 1, &spatial));
    TEST_ASSERT_TRUE((spatial.faults & BRACE_FAULT_SENSOR_COXA) != 0u);
    TEST_ASSERT_TRUE(spatial.k_is_valid && !spatial.space.is_valid); // K in the plane needs no coxa joint
}

} // namespace

int main()
{
    UNITY_BEGIN();
    RUN_TEST(hostile_limbs_are_lived_with);
    RUN_TEST(the_watchdog_bites_a_controller_that_does_not_tick);
    RUN_TEST(what_cannot_be_simulated_is_refused);
    RUN_TEST(the_coxa_joint_is_there_where_something_yields_across_the_plane);
    return UNITY_END();
}
