// Servos that are silent, that start anew or that the driver does not know: what the driver reports of them, and what
// it sends them. No servo moves unless somebody commands it.
#include "servo_bench.h"

void setUp(void) {}
void tearDown(void) {}

namespace {

// ------------------------------------------------------------------------------------------------ what goes wrong

void test_a_silent_servo_is_reported_and_the_others_go_on()
{
    for (int silent = 0; silent < 3; ++silent) {
        Bench bench;
        bench.be_ready();
        brace_servos_plug(bench.servos.get(), silent, 0);
        bench.run(0.1);
        TEST_ASSERT_EQUAL(BRACE_SERVO_SILENT, bench.report(silent).state);
        bench.forget();
        bench.run(1.0);
        for (int i = 0; i < 3; ++i) {
            if (i != silent) {
                TEST_ASSERT_EQUAL(BRACE_SERVO_READY, bench.report(i).state);
                TEST_ASSERT_GREATER_OR_EQUAL(500, bench.fresh[i]);
            }
        }
        TEST_ASSERT_EQUAL(1000, bench.refused[silent]); // E_DEVICE in each tick
        brace_servos_plug(bench.servos.get(), silent, 1);
        bench.run(0.2);
        TEST_ASSERT_EQUAL(BRACE_SERVO_READY, bench.report(silent).state);
        TEST_ASSERT_EQUAL(0, bench.report(silent).restarts); // its torque was never off
    }
}

void test_a_servo_that_starts_anew_stands_where_it_is_and_is_counted()
{
    Bench bench;
    bench.hold_at(kFemur, 0.5f);
    brace_servos_power(bench.servos.get(), kFemur, 1000 * bench.now_us);
    bench.run(0.1);
    TEST_ASSERT_EQUAL(BRACE_SERVO_SILENT, bench.report(kFemur).state);
    bench.run(1.0);
    TEST_ASSERT_EQUAL(BRACE_SERVO_READY, bench.report(kFemur).state);
    TEST_ASSERT_EQUAL(1, bench.report(kFemur).restarts);
    TEST_ASSERT_TRUE(bench.report(kFemur).has_torque);
    double goal_rad = 0, most_a = 0;
    TEST_ASSERT_EQUAL(1, brace_servos_goal(bench.servos.get(), kFemur, &goal_rad, &most_a));
    TEST_ASSERT_DOUBLE_WITHIN(1 / kCountsPerRad, bench.turned_rad(kFemur, 0), goal_rad);
}

// Torque that is off for a moment: the servo stands where it is, and the command that goes on does not move it. When
// the command ends, what it added goes back as slowly as ever.
void test_a_servo_that_starts_anew_under_a_command_does_not_jump()
{
    Bench bench;
    bench.turns_rad_per_s = 0.0;
    bench.be_ready();
    const brace_hal_joint_command_t command = {0.05f, 500.0f};
    const auto command_it = [&] { (void)brace_dynamixel_command(&bench.driver, kFemur, &command); };
    bench.run(0.1, command_it);
    brace_servos_power(bench.servos.get(), kFemur, 1000 * bench.now_us);
    bench.run(1.0, command_it);
    TEST_ASSERT_EQUAL(BRACE_SERVO_READY, bench.report(kFemur).state);
    double goal_rad = 0, last_rad = 0, most_a = 0;
    TEST_ASSERT_EQUAL(1, brace_servos_goal(bench.servos.get(), kFemur, &last_rad, &most_a));
    TEST_ASSERT_DOUBLE_WITHIN(1 / kCountsPerRad, bench.turned_rad(kFemur, 0), last_rad);
    TEST_ASSERT_DOUBLE_WITHIN(2.7e-3, 500.0 / 2409, most_a);
    for (int i = 0; i < 80; ++i) {
        bench.run(0.01);
        TEST_ASSERT_EQUAL(1, brace_servos_goal(bench.servos.get(), kFemur, &goal_rad, &most_a));
        TEST_ASSERT_TRUE(goal_rad <= last_rad && last_rad - goal_rad < 0.1 * 0.01 + 2 / kCountsPerRad);
        last_rad = goal_rad;
    }
    TEST_ASSERT_DOUBLE_WITHIN(2 / kCountsPerRad, bench.turned_rad(kFemur, 0) - 0.05, goal_rad);
}

// An offset on its way back moves on from there: a command that begins elsewhere waits until it is near.
void test_a_command_waits_for_an_offset_on_its_way_back()
{
    Bench bench;
    bench.turns_rad_per_s = 0.0;
    bench.be_ready();
    const brace_hal_joint_command_t far = {0.06f, INFINITY}, anew = {0.0f, INFINITY};
    bench.run(0.1, [&] { TEST_ASSERT_EQUAL(BRACE_HAL_OK, brace_dynamixel_command(&bench.driver, kFemur, &far)); });
    bench.run(0.2);
    double goal_rad = 0, last_rad = 0, most_a = 0;
    TEST_ASSERT_EQUAL(1, brace_servos_goal(bench.servos.get(), kFemur, &last_rad, &most_a));
    int taken = 0;
    for (int i = 0; i < 600; ++i) {
        const std::int32_t answer = brace_dynamixel_command(&bench.driver, kFemur, &anew);
        TEST_ASSERT_TRUE(answer == BRACE_HAL_OK || (answer == BRACE_HAL_E_DEVICE && taken == 0));
        taken += answer == BRACE_HAL_OK ? 1 : 0;
        bench.run(0.001);
        TEST_ASSERT_EQUAL(1, brace_servos_goal(bench.servos.get(), kFemur, &goal_rad, &most_a));
        TEST_ASSERT_TRUE(std::fabs(last_rad - goal_rad) < 0.021);
        last_rad = goal_rad;
    }
    TEST_ASSERT_TRUE(taken > 100 && taken < 500);
}

// A servo that has yielded at its bound stands far from its goal. A controller that starts anew does not know the bound
// any more; without it the servo would snap to its goal.
void test_a_bounded_servo_does_not_snap_when_the_controller_starts_anew()
{
    Bench bench;
    bench.turns_rad_per_s = 0.0;
    bench.be_ready();
    const brace_hal_joint_command_t command = {0.15f, 500.0f};
    bench.run(0.1, [&] { TEST_ASSERT_EQUAL(BRACE_HAL_OK, brace_dynamixel_command(&bench.driver, kFemur, &command)); });
    double goal_rad = 0, most_a = 0;
    TEST_ASSERT_EQUAL(1, brace_servos_goal(bench.servos.get(), kFemur, &goal_rad, &most_a));
    TEST_ASSERT_DOUBLE_WITHIN(1 / kCountsPerRad, bench.turned_rad(kFemur, 0) + 0.15, goal_rad);
    bench.start();
    for (int i = 0; i < 2000; ++i) {
        bench.run(0.0005);
        TEST_ASSERT_EQUAL(1, brace_servos_goal(bench.servos.get(), kFemur, &goal_rad, &most_a));
        const bool is_bound = most_a < 1.1 * 500.0 / 2409;
        TEST_ASSERT_TRUE(is_bound || std::fabs(goal_rad - bench.turned_rad(kFemur, 0)) < 2 / kCountsPerRad);
    }
    TEST_ASSERT_EQUAL(BRACE_SERVO_READY, bench.report(kFemur).state);
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 2047 * 2.69e-3, most_a); // and then it has all of its torque again
}

// An error that leaves the torque on comes with every answer. It takes no turn of the others.
void test_an_alert_that_stays_hides_nothing_of_the_others()
{
    Bench bench;
    bench.be_ready();
    brace_servos_poke(bench.servos.get(), kFemur, 70, 1, 1); // the supply's voltage
    bench.run(0.5);
    TEST_ASSERT_EQUAL(1, bench.report(kFemur).hardware_error);
    TEST_ASSERT_EQUAL(BRACE_SERVO_READY, bench.report(kFemur).state);
    for (int i = 0; i < 3; ++i) {
        bench.driver.servo[i].report.temp_degc = NAN;
    }
    brace_servos_poke(bench.servos.get(), kTibia, 64, 1, 0); // its torque
    bench.run(0.5);
    for (int i = 0; i < 3; ++i) {
        TEST_ASSERT_EQUAL_FLOAT(30.0f + static_cast<float>(i), bench.report(i).temp_degc);
    }
    TEST_ASSERT_EQUAL(1, bench.report(kTibia).restarts);
    TEST_ASSERT_TRUE(bench.report(kTibia).has_torque);
    brace_servos_poke(bench.servos.get(), kFemur, 70, 1, 0);
    bench.run(0.5);
    TEST_ASSERT_EQUAL(0, bench.report(kFemur).hardware_error);
}

// Beyond that delay an answer comes when the next request is on its way, and would be taken for that one's.
void test_a_servo_that_waits_too_long_before_it_answers_is_refused()
{
    Bench bench;
    brace_servos_poke(bench.servos.get(), kCoxa, 9, 1, 88); // 176 us: more than a quarter of 700
    brace_servos_poke(bench.servos.get(), kTibia, 9, 1, 87);
    bench.start();
    bench.run(0.3);
    TEST_ASSERT_EQUAL(BRACE_SERVO_MODE, bench.report(kCoxa).state);
    TEST_ASSERT_EQUAL(BRACE_SERVO_READY, bench.report(kFemur).state);
    TEST_ASSERT_EQUAL(BRACE_SERVO_READY, bench.report(kTibia).state);
}

void test_a_hardware_error_is_reported_and_the_joint_is_still_measured()
{
    Bench bench;
    bench.be_ready();
    brace_servos_break(bench.servos.get(), kTibia, 32);
    bench.run(0.05);
    TEST_ASSERT_EQUAL(BRACE_SERVO_FAILED, bench.report(kTibia).state);
    TEST_ASSERT_EQUAL(32, bench.report(kTibia).hardware_error);
    const brace_hal_joint_command_t command = {0.01f, INFINITY};
    TEST_ASSERT_EQUAL(BRACE_HAL_E_DEVICE, brace_dynamixel_command(&bench.driver, kTibia, &command));
    bench.forget();
    bench.run(1.0);
    TEST_ASSERT_GREATER_OR_EQUAL(500, bench.fresh[kTibia]);
}

void test_servos_that_know_no_fast_sync_read_are_asked_otherwise()
{
    Bench bench;
    for (int i = 0; i < 3; ++i) {
        brace_servos_poke(bench.servos.get(), i, 6, 1, 40); // their firmware
    }
    bench.be_ready();
    bench.run(1.0);
    TEST_ASSERT_TRUE(bench.driver.is_plain);
    for (int i = 0; i < 3; ++i) {
        TEST_ASSERT_GREATER_OR_EQUAL(500, bench.fresh[i]);
        TEST_ASSERT_EQUAL(0, bench.wrong[i]);
    }
}

void test_a_line_that_hears_itself_disturbs_nothing()
{
    Bench bench;
    bench.has_echo = true;
    bench.be_ready();
    bench.run(1.0);
    for (int i = 0; i < 3; ++i) {
        TEST_ASSERT_GREATER_OR_EQUAL(500, bench.fresh[i]);
        TEST_ASSERT_EQUAL(0, bench.wrong[i]);
        TEST_ASSERT_EQUAL(0, bench.report(i).lost);
    }
    TEST_ASSERT_EQUAL(0, bench.counters().damaged + bench.counters().foreign + bench.counters().skipped_bytes);
}

void test_foreign_servos_are_refused()
{
    Bench bench;
    brace_servos_poke(bench.servos.get(), kCoxa, 0, 2, 350); // an XL-320
    brace_servos_poke(bench.servos.get(), kTibia, 11, 1, 1); // velocity mode
    bench.start();
    bench.run(0.3);
    TEST_ASSERT_EQUAL(BRACE_SERVO_UNKNOWN, bench.report(kCoxa).state);
    TEST_ASSERT_EQUAL(BRACE_SERVO_MODE, bench.report(kTibia).state);
    TEST_ASSERT_EQUAL(BRACE_SERVO_READY, bench.report(kFemur).state);
    brace_hal_joint_t sample{};
    TEST_ASSERT_EQUAL(BRACE_HAL_E_DEVICE, brace_dynamixel_read(&bench.driver, kCoxa, &sample));
    TEST_ASSERT_EQUAL(BRACE_HAL_E_UNSUPPORTED, brace_dynamixel_read(&bench.driver, 3, &sample));
    TEST_ASSERT_EQUAL(BRACE_HAL_E_UNSUPPORTED, brace_dynamixel_read(&bench.driver, -1, &sample));
}

void test_a_line_that_takes_nothing_is_reported()
{
    Bench bench;
    bench.be_ready();
    bench.is_deaf = true;
    bench.run(0.1);
    TEST_ASSERT_GREATER_THAN(50, bench.counters().line_busy);
}

// ------------------------------------------------------------------------------------------------------ commands

void test_offsets_and_torque_limits_reach_the_servos_and_fade()
{
    Bench bench;
    bench.turns_rad_per_s = 0.0;
    bench.be_ready();
    double before_rad = 0, goal_rad = 0, most_a = 0;
    TEST_ASSERT_EQUAL(1, brace_servos_goal(bench.servos.get(), kTibia, &before_rad, &most_a));
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 2047 * 2.69e-3, most_a);
    const brace_hal_joint_command_t command = {0.05f, 500.0f};
    bench.run(0.2, [&] { TEST_ASSERT_EQUAL(BRACE_HAL_OK, brace_dynamixel_command(&bench.driver, kTibia, &command)); });
    TEST_ASSERT_EQUAL(1, brace_servos_goal(bench.servos.get(), kTibia, &goal_rad, &most_a));
    TEST_ASSERT_DOUBLE_WITHIN(1 / kCountsPerRad, before_rad - 0.05, goal_rad); // the tibia is reversed
    TEST_ASSERT_DOUBLE_WITHIN(2.7e-3, 500.0 / 1783, most_a);
    bench.run(0.35); // 100 ms later it goes back at 0.1 rad/s
    TEST_ASSERT_EQUAL(1, brace_servos_goal(bench.servos.get(), kTibia, &goal_rad, &most_a));
    TEST_ASSERT_DOUBLE_WITHIN(3 / kCountsPerRad, before_rad - 0.025, goal_rad);
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 2047 * 2.69e-3, most_a);
    bench.run(0.4);
    TEST_ASSERT_EQUAL(1, brace_servos_goal(bench.servos.get(), kTibia, &goal_rad, &most_a));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, before_rad, goal_rad);
}

// Silent servos stand at the goal that they have. When they are back, what was added to it goes back from there.
void test_an_offset_fades_from_where_it_was_when_a_servo_is_back()
{
    for (const bool is_alone : {true, false}) { // the others go on; or the whole line was dead
        Bench bench;
        bench.turns_rad_per_s = 0.0;
        bench.be_ready();
        double before_rad = 0, goal_rad = 0, last_rad = 0, most_a = 0;
        TEST_ASSERT_EQUAL(1, brace_servos_goal(bench.servos.get(), kFemur, &before_rad, &most_a));
        const brace_hal_joint_command_t command = {0.05f, INFINITY};
        const auto command_it = [&] {
            TEST_ASSERT_EQUAL(BRACE_HAL_OK, brace_dynamixel_command(&bench.driver, kFemur, &command));
        };
        bench.run(0.1, command_it);
        const auto plug = [&](int is_in) {
            for (int i = 0; i < 3; ++i) {
                if (i == kFemur || !is_alone) {
                    brace_servos_plug(bench.servos.get(), i, is_in);
                }
            }
        };
        plug(0);
        bench.run(2.0);
        TEST_ASSERT_EQUAL(1, brace_servos_goal(bench.servos.get(), kFemur, &last_rad, &most_a));
        TEST_ASSERT_DOUBLE_WITHIN(1 / kCountsPerRad, before_rad + 0.05, last_rad);
        plug(1);
        for (int i = 0; i < 70; ++i) {
            bench.run(0.01);
            TEST_ASSERT_EQUAL(1, brace_servos_goal(bench.servos.get(), kFemur, &goal_rad, &most_a));
            TEST_ASSERT_TRUE(goal_rad <= last_rad && last_rad - goal_rad < 0.1 * 0.01 + 2 / kCountsPerRad);
            last_rad = goal_rad;
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, before_rad, goal_rad);
    }
}

void test_a_goal_that_the_line_did_not_take_is_sent_again_at_once()
{
    Bench bench;
    bench.turns_rad_per_s = 0.0;
    bench.be_ready();
    double before_rad = 0, goal_rad = 0, most_a = 0;
    TEST_ASSERT_EQUAL(1, brace_servos_goal(bench.servos.get(), kFemur, &before_rad, &most_a));
    const brace_hal_joint_command_t command = {0.05f, 500.0f};
    for (int i = 0; i < 15; ++i) { // 25 ms: each time within the 20 ms after which all goals are sent again
        TEST_ASSERT_EQUAL(BRACE_HAL_OK, brace_dynamixel_command(&bench.driver, kFemur, &command));
        bench.is_deaf = true;
        bench.run(0.002);
        bench.is_deaf = false;
        bench.run(0.002);
        TEST_ASSERT_EQUAL(1, brace_servos_goal(bench.servos.get(), kFemur, &goal_rad, &most_a));
        TEST_ASSERT_DOUBLE_WITHIN(1 / kCountsPerRad, before_rad + 0.05, goal_rad);
        TEST_ASSERT_DOUBLE_WITHIN(2.7e-3, 500.0 / 2409, most_a);
        const brace_hal_joint_command_t none = {0.0f, INFINITY};
        TEST_ASSERT_EQUAL(BRACE_HAL_OK, brace_dynamixel_command(&bench.driver, kFemur, &none));
        bench.run(0.025);
    }
}

// The driver asks a servo where it stands, and then commands it to stay there. A damaged answer must not move the
// servo.
void test_no_burst_that_the_crc_misses_sends_a_servo_elsewhere()
{
    constexpr std::size_t kPlace = 9 + 4 + 2;
    for (const auto &burst : missed_bursts(kPlace)) {
        Bench bench;
        bench.turns_rad_per_s = 0.0;
        bench.serve_us = kTick_us;
        bench.flips = burst;
        bench.be_ready();
        TEST_ASSERT_TRUE(bench.flips.empty());
        for (int i = 0; i < 3; ++i) {
            double goal_rad = 0, most_a = 0;
            TEST_ASSERT_EQUAL(1, brace_servos_goal(bench.servos.get(), i, &goal_rad, &most_a));
            TEST_ASSERT_DOUBLE_WITHIN(1 / kCountsPerRad, bench.turned_rad(i, 0), goal_rad);
        }
    }
}

// Torque follows from the model, and its limit from the servo's own.
void test_no_burst_that_the_crc_misses_makes_another_servo_of_it()
{
    constexpr std::size_t kIdentity = 9 + 12 + 2, kLimits = 9 + 18 + 2;
    Bench sound;
    sound.be_ready();
    for (const std::size_t length : {kIdentity, kLimits}) {
        for (const auto &burst : missed_bursts(length)) {
            Bench bench;
            bench.serve_us = kTick_us;
            bench.flips = burst;
            bench.be_ready();
            TEST_ASSERT_TRUE(bench.flips.empty());
            for (int i = 0; i < 3; ++i) {
                const brace_servo_t &servo = bench.driver.servo[i], &as_it_is = sound.driver.servo[i];
                TEST_ASSERT_EQUAL(kModels[i], bench.report(i).model);
                TEST_ASSERT_EQUAL(as_it_is.current_limit, servo.current_limit);
                TEST_ASSERT_EQUAL_FLOAT(as_it_is.torque_per_count_n_mm, servo.torque_per_count_n_mm);
            }
        }
    }
}

// In position mode (3) a servo takes no goal beyond its turn: it cannot be commanded to stand where it is.
void test_a_servo_beyond_its_turn_is_refused_and_not_moved()
{
    Bench bench;
    brace_servos_poke(bench.servos.get(), kFemur, 11, 1, 3);
    bench.turns_rad_per_s = 0.0;
    bench.beyond_turn_rad[kFemur] = 2.0 * M_PI;
    bench.start();
    bench.run(0.5);
    double goal_rad = 0, most_a = 0;
    TEST_ASSERT_EQUAL(BRACE_SERVO_MODE, bench.report(kFemur).state);
    TEST_ASSERT_EQUAL(0, brace_servos_goal(bench.servos.get(), kFemur, &goal_rad, &most_a));
    TEST_ASSERT_EQUAL(BRACE_SERVO_READY, bench.report(kTibia).state);
}

// The limits of a servo's goals, as its owner has set them: beyond them it is refused, and no goal passes them.
void test_position_limits_are_kept()
{
    Bench bench;
    brace_servos_poke(bench.servos.get(), kFemur, 11, 1, 3);
    brace_servos_poke(bench.servos.get(), kTibia, 11, 1, 3);
    bench.turns_rad_per_s = 0.0;
    const int femur = static_cast<int>(bench.turned_rad(kFemur, 0) * kCountsPerRad);
    const int tibia = static_cast<int>(bench.turned_rad(kTibia, 0) * kCountsPerRad);
    brace_servos_poke(bench.servos.get(), kFemur, 48, 4, femur - 50); // it stands beyond it
    brace_servos_poke(bench.servos.get(), kTibia, 48, 4, tibia + 50);
    brace_servos_poke(bench.servos.get(), kTibia, 52, 4, tibia - 50);
    bench.start();
    bench.run(0.5);
    TEST_ASSERT_EQUAL(BRACE_SERVO_MODE, bench.report(kFemur).state);
    TEST_ASSERT_EQUAL(0, bench.report(kFemur).refused);
    TEST_ASSERT_EQUAL(BRACE_SERVO_READY, bench.report(kTibia).state);
    for (const float offset_rad : {0.2f, -0.2f}) {
        const brace_hal_joint_command_t command = {offset_rad, INFINITY};
        bench.run(0.1, [&] { (void)brace_dynamixel_command(&bench.driver, kTibia, &command); });
        double goal_rad = 0, most_a = 0;
        TEST_ASSERT_EQUAL(1, brace_servos_goal(bench.servos.get(), kTibia, &goal_rad, &most_a));
        const double most_rad = (tibia + (offset_rad < 0.0f ? 50 : -50)) / kCountsPerRad; // the tibia is reversed
        TEST_ASSERT_DOUBLE_WITHIN(1 / kCountsPerRad, most_rad, goal_rad);
    }
}

// A servo may refuse what sets it up. The driver reports that servo as refused, and goes on with the others.
void test_a_servo_that_refuses_its_set_up_is_reported()
{
    Bench bench;
    bench.turns_rad_per_s = 0.0;
    bench.start();
    const auto narrow = [&] { // its limits change between being read and being used
        if (bench.driver.servo[kFemur].has_place) {
            brace_servos_poke(bench.servos.get(), kFemur, 11, 1, 3);
            brace_servos_poke(bench.servos.get(), kFemur, 48, 4, 100);
        }
    };
    bool is_reported = false;
    for (int i = 0; i < 400 && !is_reported; ++i) {
        bench.run(0.001, narrow);
        is_reported = bench.report(kFemur).state == BRACE_SERVO_MODE;
    }
    TEST_ASSERT_TRUE(is_reported);
    TEST_ASSERT_EQUAL(10, bench.report(kFemur).refused);
    bench.run(0.2);
    TEST_ASSERT_EQUAL(BRACE_SERVO_READY, bench.report(kTibia).state);
}

void test_commands_that_make_no_sense_are_refused()
{
    Bench bench;
    brace_servos_poke(bench.servos.get(), kCoxa, 11, 1, 3); // position mode: no torque limit
    bench.be_ready();
    const brace_hal_joint_command_t limited = {0.0f, 500.0f}, nan = {NAN, INFINITY}, negative = {0.0f, -1.0f},
                                    plain = {0.01f, INFINITY};
    TEST_ASSERT_EQUAL(BRACE_HAL_E_UNSUPPORTED, brace_dynamixel_command(&bench.driver, kCoxa, &limited));
    TEST_ASSERT_EQUAL(BRACE_HAL_OK, brace_dynamixel_command(&bench.driver, kCoxa, &plain));
    TEST_ASSERT_EQUAL(BRACE_HAL_E_RANGE, brace_dynamixel_command(&bench.driver, kFemur, &nan));
    TEST_ASSERT_EQUAL(BRACE_HAL_E_RANGE, brace_dynamixel_command(&bench.driver, kFemur, &negative));
    TEST_ASSERT_EQUAL(BRACE_HAL_E_UNSUPPORTED, brace_dynamixel_command(&bench.driver, 3, &plain));
    TEST_ASSERT_EQUAL(BRACE_HAL_E_RANGE, brace_dynamixel_move(&bench.driver, kFemur, NAN));
    brace_servo_setup_t twice = bench.setup;
    twice.joint[kFemur].id = twice.joint[kTibia].id;
    TEST_ASSERT_EQUAL(BRACE_HAL_E_RANGE, brace_dynamixel_start(&bench.driver, &twice, &bench.driver.line));
}

void test_a_servo_that_holds_goes_on_holding_when_the_controller_starts_anew()
{
    Bench bench;
    bench.hold_at(kFemur, 0.5f);
    double before_rad = 0, goal_rad = 0, most_a = 0;
    TEST_ASSERT_EQUAL(1, brace_servos_goal(bench.servos.get(), kFemur, &before_rad, &most_a));
    TEST_ASSERT_DOUBLE_WITHIN(1 / kCountsPerRad, M_PI + 0.25, before_rad);
    bench.be_ready();
    TEST_ASSERT_EQUAL(1, brace_servos_goal(bench.servos.get(), kFemur, &goal_rad, &most_a));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, before_rad, goal_rad);
}

void test_nobody_is_commanded_to_hold_who_shall_not()
{
    Bench bench;
    bench.setup.holds = false;
    bench.be_ready();
    double goal_rad = 0, most_a = 0;
    TEST_ASSERT_EQUAL(0, brace_servos_goal(bench.servos.get(), kFemur, &goal_rad, &most_a));
    const brace_hal_joint_command_t command = {0.01f, INFINITY};
    TEST_ASSERT_EQUAL(BRACE_HAL_E_DEVICE, brace_dynamixel_command(&bench.driver, kFemur, &command));
    bench.run(1.0);
    TEST_ASSERT_GREATER_OR_EQUAL(500, bench.fresh[kFemur]);
}

} // namespace

int main()
{
    UNITY_BEGIN();
    RUN_TEST(test_a_silent_servo_is_reported_and_the_others_go_on);
    RUN_TEST(test_a_servo_that_starts_anew_stands_where_it_is_and_is_counted);
    RUN_TEST(test_a_servo_that_starts_anew_under_a_command_does_not_jump);
    RUN_TEST(test_a_command_waits_for_an_offset_on_its_way_back);
    RUN_TEST(test_a_bounded_servo_does_not_snap_when_the_controller_starts_anew);
    RUN_TEST(test_an_alert_that_stays_hides_nothing_of_the_others);
    RUN_TEST(test_a_servo_that_waits_too_long_before_it_answers_is_refused);
    RUN_TEST(test_a_hardware_error_is_reported_and_the_joint_is_still_measured);
    RUN_TEST(test_servos_that_know_no_fast_sync_read_are_asked_otherwise);
    RUN_TEST(test_a_line_that_hears_itself_disturbs_nothing);
    RUN_TEST(test_foreign_servos_are_refused);
    RUN_TEST(test_a_line_that_takes_nothing_is_reported);
    RUN_TEST(test_offsets_and_torque_limits_reach_the_servos_and_fade);
    RUN_TEST(test_an_offset_fades_from_where_it_was_when_a_servo_is_back);
    RUN_TEST(test_a_goal_that_the_line_did_not_take_is_sent_again_at_once);
    RUN_TEST(test_no_burst_that_the_crc_misses_sends_a_servo_elsewhere);
    RUN_TEST(test_no_burst_that_the_crc_misses_makes_another_servo_of_it);
    RUN_TEST(test_a_servo_beyond_its_turn_is_refused_and_not_moved);
    RUN_TEST(test_position_limits_are_kept);
    RUN_TEST(test_a_servo_that_refuses_its_set_up_is_reported);
    RUN_TEST(test_commands_that_make_no_sense_are_refused);
    RUN_TEST(test_a_servo_that_holds_goes_on_holding_when_the_controller_starts_anew);
    RUN_TEST(test_nobody_is_commanded_to_hold_who_shall_not);
    return UNITY_END();
}
