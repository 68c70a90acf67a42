/* The interval in the snapshot, as whoever asks sees it: what rubs in the gears and how the joints turned last make it;
 * a sensor at the tip makes it narrow; what is not known is none. How often it holds: tests/judges/currents. */
#include "modbus_master.h"

#define SAME_N_MM 0.5f

static brace_parameters_t parameters;

void setUp(void)
{
    parameters = bench_parameters();
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        brace_drive_t *drive = &parameters.drive[i];
        drive->torque_noise_n_mm = drive->torque_bias_n_mm = drive->motor_friction_tolerance_ratio = 0.0f;
        drive->torque_gain_rel = 0.0f;
        drive->motor_friction_sliding_ratio = 0.5f;
        drive->motor_friction_n_mm = 100.0f;
    }
}

void tearDown(void) {}

static void start(bool has_sensor)
{
    bench_start(&parameters);
    if (!has_sensor) {
        brace_fake_fail(&fake, BRACE_FAKE_TIP_FORCE_READ, 1, UINT32_MAX, BRACE_HAL_E_UNSUPPORTED);
    }
}

static void carry(float femur_n_mm, float tibia_n_mm)
{
    fake.joint[BRACE_FEMUR].sample.torque_n_mm = femur_n_mm;
    fake.joint[BRACE_TIBIA].sample.torque_n_mm = tibia_n_mm;
}

static void expect_load(int index, float low_n_mm, float high_n_mm)
{
    const brace_interval_t found = now()->load_interval_n_mm[index];
    TEST_ASSERT_FLOAT_WITHIN(SAME_N_MM, low_n_mm, found.low);
    TEST_ASSERT_FLOAT_WITHIN(SAME_N_MM, high_n_mm, found.high);
}

/* Nine tenths of the band: nobody has seen the joints turn. */
static void test_a_joint_that_has_not_turned_may_have_friction_on_either_side(void)
{
    start(false);
    carry(1000.0f, -500.0f);
    ticks(500);
    expect_load(BRACE_FEMUR, 910.0f, 1090.0f);
    expect_load(BRACE_TIBIA, -590.0f, -410.0f);
    TEST_ASSERT_TRUE(isnan(now()->load_interval_n_mm[BRACE_COXA].low)); /* it is not fitted */
    TEST_ASSERT_TRUE(isnan(now()->force_y_interval_n.low) && isnan(now()->force_y_interval_n.high));
}

static void test_friction_grows_with_the_load(void)
{
    parameters.drive[BRACE_FEMUR].motor_friction_per_torque_ratio = 0.2f;
    parameters.drive[BRACE_TIBIA].coulomb_per_load_ratio = 0.1f;
    start(false);
    carry(1000.0f, 1000.0f);
    ticks(500);
    expect_load(BRACE_FEMUR, 1000.0f - 0.9f * 300.0f, 1000.0f + 0.9f * 300.0f);
    expect_load(BRACE_TIBIA, 1000.0f + 10.0f - 0.9f * 200.0f, 1000.0f + 10.0f - 0.9f * 200.0f + 2.0f * 0.9f * 200.0f);
}

/* While it turns, friction is against it, all of it or what sliding leaves. Where it has come to stand, that end counts
 * whole. */
static void test_a_joint_that_turns_has_friction_against_it(void)
{
    start(false);
    carry(1000.0f, 0.0f);
    ticks(500);
    for (int i = 0; i < 200; i++) {
        fake.joint[BRACE_FEMUR].sample.motor_rad += 0.0005f; /* 0.5 rad/s */
        ticks(1);
    }
    expect_load(BRACE_FEMUR, 900.0f + 0.05f * 50.0f, 950.0f - 0.05f * 50.0f);
    ticks(100);
    expect_load(BRACE_FEMUR, 900.0f, 1090.0f);
    for (int i = 0; i < 200; i++) {
        fake.joint[BRACE_FEMUR].sample.motor_rad -= 0.0005f;
        ticks(1);
    }
    expect_load(BRACE_FEMUR, 1050.0f + 0.05f * 50.0f, 1100.0f - 0.05f * 50.0f);
    ticks(100);
    expect_load(BRACE_FEMUR, 910.0f, 1100.0f);
}

/* The force that two loads explain, and how far it goes at the corners of both bands. */
static void test_the_force_lies_within_what_both_loads_allow(void)
{
    start(false);
    carry(3000.0f, 2000.0f);
    ticks(500);
    const brace_snapshot_t *s = now();
    const brace_pose_t *pose = &app.controller.posture.pose;
    const brace_point_t femur = pose->lever_femur, tibia = pose->lever_tibia;
    const float cross = femur.x_mm * tibia.z_mm - femur.z_mm * tibia.x_mm;
    const float by_femur = fabsf(tibia.z_mm / cross) * 100.0f;
    const float by_tibia = fabsf(femur.z_mm / cross) * 100.0f;
    const float wide = s->force_x_interval_n.high - s->force_x_interval_n.low;
    const float middle = 0.5f * (s->force_x_interval_n.high + s->force_x_interval_n.low);
    TEST_ASSERT_FLOAT_WITHIN(0.01f, s->force_x_n, middle);
    TEST_ASSERT_TRUE(wide < 2.0f * (by_femur + by_tibia));
    TEST_ASSERT_TRUE(wide > 1.8f * fmaxf(by_femur, by_tibia));
    TEST_ASSERT_TRUE(s->force_z_interval_n.low < s->force_z_n && s->force_z_n < s->force_z_interval_n.high);
}

static void test_the_doubt_of_the_torque_by_current_counts(void)
{
    parameters.drive[BRACE_FEMUR].torque_gain_rel = 0.2f;
    parameters.drive[BRACE_FEMUR].motor_friction_n_mm = 0.0f;
    start(false);
    carry(1000.0f, 0.0f);
    ticks(500);
    expect_load(BRACE_FEMUR, 1000.0f - 1.6449f * 200.0f, 1000.0f + 1.6449f * 200.0f);
}

static void test_a_sensor_at_the_tip_knows_better(void)
{
    parameters.sensor.noise_n = 0.1f;
    parameters.limb.uncertainty.gain_rel = 0.01f;
    start(true);
    fake.force_x_n = 10.0f;
    ticks(500);
    const float off_n = 1.6449f * sqrtf(0.01f + 0.01f);
    TEST_ASSERT_FLOAT_WITHIN(1e-3f, 10.0f - off_n, now()->force_x_interval_n.low);
    TEST_ASSERT_FLOAT_WITHIN(1e-3f, 10.0f + off_n, now()->force_x_interval_n.high);
}

static void test_what_is_not_known_has_no_interval(void)
{
    start(false);
    TEST_ASSERT_TRUE(isnan(now()->force_x_interval_n.low) && isnan(now()->load_interval_n_mm[BRACE_FEMUR].high));
    ticks(500);
    TEST_ASSERT_FALSE(isnan(now()->force_x_interval_n.low));
    fake.joint[BRACE_FEMUR].not_newer = true;
    ticks(100);
    TEST_ASSERT_TRUE(isnan(now()->force_x_interval_n.low) && isnan(now()->force_z_interval_n.high));
    TEST_ASSERT_TRUE(isnan(now()->load_interval_n_mm[BRACE_FEMUR].low));
    TEST_ASSERT_FALSE(isnan(now()->load_interval_n_mm[BRACE_TIBIA].low));
}

/* An encoder that flickers by a step is no motion, and rounding of the anchor neither. */
static void test_an_encoders_flicker_is_no_motion(void)
{
    parameters.drive[BRACE_FEMUR].angle_step_rad = 0.0015f;
    start(false);
    carry(1000.0f, 0.0f);
    ticks(100);
    const float there_rad = fake.joint[BRACE_FEMUR].sample.motor_rad;
    for (int i = 0; i < 300; i++) {
        fake.joint[BRACE_FEMUR].sample.motor_rad = there_rad + (i % 7 < 3 ? 0.0015f : 0.0f);
        ticks(1);
    }
    expect_load(BRACE_FEMUR, 910.0f, 1090.0f);
}

/* The part of `details` on CAN with this number. */
static brace_can_frame_t details_part(uint32_t part)
{
    brace_can_frame_t frame = {.id = 0};
    for (int i = 0; i < 200; i++) {
        ticks(1);
        while (brace_fake_frame_take(&fake, &frame)) {
            if (frame.id == 0x205 && brace_can_details_part(frame.data) == part) {
                return frame;
            }
        }
    }
    TEST_FAIL_MESSAGE("no such part");
    return frame;
}

/* The two ends of an interval in a part: bits 16 to 39 and 40 to 63, 0x800000 where not known (docs/protocol.md). */
static void expect_ends_on_can(uint32_t part, bool is_known)
{
    const brace_can_frame_t frame = details_part(part);
    for (int end = 0; end < 2; end++) {
        const uint8_t *code = &frame.data[2 + 3 * end];
        TEST_ASSERT_EQUAL(!is_known, code[0] == 0x00 && code[1] == 0x00 && code[2] == 0x80);
    }
}

/* Its registers on Modbus: NaN where not known. */
static void expect_ends_on_modbus(uint32_t address, bool is_known)
{
    const reply_t reply = read_asks(4, address, 4);
    TEST_ASSERT_EQUAL(!is_known, isnan(float_at(&reply, 0)));
    TEST_ASSERT_EQUAL(!is_known, isnan(float_at(&reply, 1)));
}

static void expect_force_on_the_wires(bool is_known)
{
    TEST_ASSERT_EQUAL(!is_known, isnan(now()->force_x_interval_n.low) && isnan(now()->force_x_interval_n.high));
    TEST_ASSERT_EQUAL(!is_known, isnan(now()->force_z_interval_n.low) && isnan(now()->force_z_interval_n.high));
    for (uint32_t axis = 0; axis < 2u; axis++) {
        expect_ends_on_can(96u + axis, is_known);
        expect_ends_on_modbus(294u + 4u * axis, is_known);
        expect_ends_on_can(98u + axis, true); /* what each joint carries is known all the same */
        expect_ends_on_modbus(310u + 4u * axis, true);
    }
}

/* A limb that is nearly straight, or is straight: along it any force goes with the same loads. */
static void test_the_force_on_a_stretched_limb_is_not_known_on_any_wire(void)
{
    static const float knee_rad[] = {1.4f, 0.05f, 0.0f};
    parameters.controller.modbus_address = UNIT;
    parameters.controller.load_hz = 100.0f;
    for (int i = 0; i < 3; i++) {
        start(false);
        fake.joint[BRACE_TIBIA].sample.motor_rad = knee_rad[i];
        carry(1000.0f, -500.0f);
        ticks(500);
        expect_force_on_the_wires(i == 0);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_joint_that_has_not_turned_may_have_friction_on_either_side);
    RUN_TEST(test_friction_grows_with_the_load);
    RUN_TEST(test_a_joint_that_turns_has_friction_against_it);
    RUN_TEST(test_the_force_lies_within_what_both_loads_allow);
    RUN_TEST(test_the_doubt_of_the_torque_by_current_counts);
    RUN_TEST(test_a_sensor_at_the_tip_knows_better);
    RUN_TEST(test_what_is_not_known_has_no_interval);
    RUN_TEST(test_an_encoders_flicker_is_no_motion);
    RUN_TEST(test_the_force_on_a_stretched_limb_is_not_known_on_any_wire);
    return UNITY_END();
}
