// The driver for Dynamixel servos on a line of simulated servos. It prints how many samples come, how old they are when
// they are used, and what damage does.
#include <array>
#include <cmath>
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <vector>

extern "C" {
#include "api/brace_servos.h"
#include "brace_dynamixel.h"
#include "unity.h"
}

void setUp(void) {}
void tearDown(void) {}

namespace
{

constexpr double kCountsPerRad = 4096.0 / (2.0 * M_PI);
constexpr std::uint64_t kTick_us = 1000, kStep_us = 50;
// How long damage at random is played. The plain build shows that it does no harm; the sanitized build looks at each
// access to memory, and meets each kind of damage within seconds.
#ifdef __SANITIZE_ADDRESS__
constexpr int kDamaged_s = 20;
#else
constexpr int kDamaged_s = 100;
#endif
constexpr std::uint32_t kBaud = 3'000'000;
constexpr std::uint8_t kCoxa = 0, kFemur = 1, kTibia = 2;
constexpr std::uint8_t kIds[3] = {11, 12, 13};
constexpr std::uint16_t kModels[3] = {321, 1120, 1020};

// Three servos whose shafts turn, a driver, and a tick that reads the joints.
struct Bench {
    std::unique_ptr<brace_servos_t, void (*)(brace_servos_t *)> servos{brace_servos_create(kBaud, 1),
                                                                      brace_servos_destroy};
    brace_dynamixel_t driver{};
    brace_servo_setup_t setup{};
    std::uint64_t now_us = 0;
    std::uint64_t serve_us = 250; // how often there is time for the driver
    double turns_rad_per_s = 1.0;
    std::array<double, 3> beyond_turn_rad{};
    std::array<std::uint32_t, 3> fresh{}, wrong{}, refused{};
    std::uint64_t oldest_us = 0;
    bool is_deaf = false; // the line takes nothing
    bool has_echo = false; // the line hears itself
    std::vector<std::uint8_t> echo;
    std::vector<std::uint8_t> flips; // of the next answer of this length

    Bench()
    {
        for (int i = 0; i < 3; ++i) {
            TEST_ASSERT_EQUAL(i, brace_servos_add(servos.get(), kIds[i], kModels[i]));
            setup.joint[i] = {kIds[i], i == kTibia, 0.25f * static_cast<float>(i), 1.0f};
        }
        setup.period_us = 500;
        setup.timeout_us = 700;
        setup.holds = true;
        turn();
    }

    static std::int32_t send(void *context, const std::uint8_t *bytes, std::uint32_t count)
    {
        Bench &bench = *static_cast<Bench *>(context);
        if (bench.is_deaf) {
            return BRACE_HAL_AGAIN;
        }
        if (bench.has_echo) {
            bench.echo.assign(bytes, bytes + count);
        }
        brace_servos_hear(bench.servos.get(), 1000 * bench.now_us, bytes, count);
        return BRACE_HAL_OK;
    }

    static std::int32_t receive(void *context, std::uint8_t *bytes, std::uint32_t room)
    {
        Bench &bench = *static_cast<Bench *>(context);
        if (!bench.echo.empty()) {
            const auto heard = static_cast<std::ptrdiff_t>(std::min<std::size_t>(room, bench.echo.size()));
            std::copy_n(bench.echo.begin(), heard, bytes);
            bench.echo.erase(bench.echo.begin(), bench.echo.begin() + heard);
            return static_cast<std::int32_t>(heard);
        }
        const std::uint32_t count = brace_servos_give(bench.servos.get(), 1000 * bench.now_us, bytes, room);
        if (count == bench.flips.size()) {
            for (std::uint32_t i = 0; i < count; ++i) {
                bytes[i] ^= bench.flips[i];
            }
            bench.flips.clear();
        }
        return static_cast<std::int32_t>(count);
    }

    void start()
    {
        const brace_servo_line_t line = {this, send, receive};
        TEST_ASSERT_EQUAL(BRACE_HAL_OK, brace_dynamixel_start(&driver, &setup, &line));
    }

    double turned_rad(int joint, double t_us) const
    {
        return M_PI + beyond_turn_rad[joint] + 0.8 * std::sin(turns_rad_per_s * 1e-6 * t_us + joint);
    }
    double current_a(int joint, double t_us) const { return 1.2 * std::sin(3e-6 * t_us + 2 * joint); }

    void turn()
    {
        for (int i = 0; i < 3; ++i) {
            const double t_us = static_cast<double>(now_us);
            brace_servos_shaft(servos.get(), i, turned_rad(i, t_us), 0.5, current_a(i, t_us), 30 + i);
        }
    }

    // The servo read its encoder between the time it tells and the answer's last byte; half a step of the encoder.
    bool is_true(int joint, const brace_hal_joint_t &sample) const
    {
        const double from_us = sample.taken_us, to_us = from_us + 500, step_rad = 1 / kCountsPerRad;
        const double sense = setup.joint[joint].is_reversed ? -1 : 1;
        const double unit_n_mm = joint == kCoxa ? 3.36e-3 * 1615 : joint == kFemur ? 2.69e-3 * 2409 : 2.69e-3 * 1783;
        const double per_a_n_mm = unit_n_mm / (joint == kCoxa ? 3.36e-3 : 2.69e-3);
        const auto between = [](double value, double a, double b, double margin) {
            return value >= std::fmin(a, b) - margin && value <= std::fmax(a, b) + margin;
        };
        const double angle = (sample.link_rad - setup.joint[joint].zero_rad) * sense + M_PI;
        return between(angle, turned_rad(joint, from_us), turned_rad(joint, to_us), 0.51 * step_rad + 1e-6)
               && between(sample.torque_n_mm * sense, per_a_n_mm * current_a(joint, from_us),
                          per_a_n_mm * current_a(joint, to_us), 0.51 * unit_n_mm)
               && sample.motor_rad != sample.motor_rad;
    }

    void tick()
    {
        for (int i = 0; i < 3; ++i) {
            brace_hal_joint_t sample{};
            const std::int32_t answer = brace_dynamixel_read(&driver, i, &sample);
            refused[i] += answer < BRACE_HAL_AGAIN;
            if (answer == BRACE_HAL_OK) {
                ++fresh[i];
                wrong[i] += !is_true(i, sample);
            }
            if (answer == BRACE_HAL_OK || (answer == BRACE_HAL_AGAIN && sample.taken_us != 0)) {
                oldest_us = std::max(oldest_us, now_us - sample.taken_us);
            }
        }
    }

    void run(double seconds, const std::function<void()> &each_tick = [] {})
    {
        const std::uint64_t end_us = now_us + static_cast<std::uint64_t>(1e6 * seconds);
        for (; now_us < end_us; now_us += kStep_us) {
            turn();
            if (now_us % kTick_us == 0) {
                tick();
                each_tick();
            }
            if (now_us % serve_us == 0) {
                brace_dynamixel_serve(&driver, static_cast<std::uint32_t>(now_us));
            }
        }
    }

    void forget()
    {
        fresh = wrong = refused = {};
        oldest_us = 0;
    }

    brace_servo_report_t report(int joint) const
    {
        brace_servo_report_t told{};
        brace_dynamixel_report(&driver, joint, &told);
        return told;
    }

    brace_servo_counters_t counters() const
    {
        brace_servo_counters_t told{};
        brace_dynamixel_counters(&driver, &told);
        return told;
    }

    void be_ready()
    {
        start();
        run(0.1);
        for (int i = 0; i < 3; ++i) {
            TEST_ASSERT_EQUAL(BRACE_SERVO_READY, report(i).state);
        }
        forget();
    }

    void say(const char *what, double seconds) const
    {
        const brace_servo_counters_t told = counters();
        std::printf("%s: %.0f %.0f %.0f samples/s, oldest at use %.2f ms, damaged %u, lost %u %u %u, doubted %u, "
                    "wrong %u\n",
                    what, fresh[0] / seconds, fresh[1] / seconds, fresh[2] / seconds,
                    1e-3 * static_cast<double>(oldest_us),
                    told.damaged, report(0).lost, report(1).lost, report(2).lost,
                    report(0).doubted + report(1).doubted + report(2).doubted, wrong[0] + wrong[1] + wrong[2]);
    }
};

// ---------------------------------------------------------------------------------------------------- figures

void test_three_joints_at_3_mbit_per_s()
{
    for (const std::uint64_t serve_us : {250u, 1000u}) { // four times a tick, and only once
        Bench bench;
        bench.serve_us = serve_us;
        bench.be_ready();
        bench.run(10.0);
        bench.say(serve_us == kTick_us ? "served once a tick" : "served four times a tick", 10.0);
        for (int i = 0; i < 3; ++i) {
            TEST_ASSERT_GREATER_OR_EQUAL(500 * 10, bench.fresh[i]);
            TEST_ASSERT_EQUAL(0, bench.wrong[i]);
        }
        TEST_ASSERT_LESS_OR_EQUAL(3 * kTick_us, bench.oldest_us);
        TEST_ASSERT_EQUAL(0, bench.counters().damaged + bench.counters().foreign + bench.report(0).lost);
        brace_servos_counts_t counts{};
        brace_servos_counts(bench.servos.get(), &counts);
        TEST_ASSERT_EQUAL(0, counts.collisions);
    }
}

void test_one_percent_of_the_packets_damaged()
{
    Bench bench;
    bench.be_ready();
    brace_servos_damage(bench.servos.get(), 0.01);
    bench.run(kDamaged_s);
    bench.say("1 % of the packets damaged", kDamaged_s);
    brace_servos_counts_t counts{};
    brace_servos_counts(bench.servos.get(), &counts);
    for (int i = 0; i < 3; ++i) {
        TEST_ASSERT_GREATER_OR_EQUAL(490 * kDamaged_s, bench.fresh[i]);
        TEST_ASSERT_EQUAL(0, bench.wrong[i]);
        TEST_ASSERT_EQUAL(0, bench.report(i).restarts);
    }
    TEST_ASSERT_EQUAL(0, bench.refused[kFemur]);
    TEST_ASSERT_LESS_OR_EQUAL(3 * kTick_us, bench.oldest_us);
    // A request that is damaged, or whose answer is, has no answer. Nobody sees a damaged goal, of which there are 100
    // a second at most; and both packets of an exchange may be damaged.
    const double unanswered = bench.counters().requests - bench.counters().answers;
    const double damaged = static_cast<double>(counts.damaged);
    std::printf("%.0f packets damaged, %.0f requests without an answer\n", damaged, unanswered);
    TEST_ASSERT_TRUE(unanswered <= damaged && unanswered >= damaged - 0.01 * 100 * kDamaged_s - kDamaged_s);
}

// The bursts of up to 16 bits that the CRC misses in an answer of this length, as bits to flip. The CRC is linear, so
// they are those whose own remainder is 0, whatever the answer says.
std::vector<std::vector<std::uint8_t>> missed_bursts(std::size_t bytes)
{
    std::vector<std::vector<std::uint8_t>> missed;
    std::vector<std::uint16_t> of_bit(8 * bytes);
    std::vector<std::uint8_t> flips(bytes, 0);
    std::vector<std::uint16_t> remainder(1u << 15);
    for (std::size_t bit = 0; bit < of_bit.size(); ++bit) {
        flips[bit / 8] = static_cast<std::uint8_t>(1u << bit % 8);
        of_bit[bit] = static_cast<std::uint16_t>(dxl_crc(0, flips.data(), static_cast<std::uint32_t>(bytes) - 2)
                                                 ^ flips[bytes - 2] ^ flips[bytes - 1] << 8);
        flips[bit / 8] = 0;
    }
    for (std::size_t begin = 0; begin < of_bit.size(); ++begin) {
        const std::size_t further = std::min<std::size_t>(15, of_bit.size() - 1 - begin);
        remainder[0] = of_bit[begin];
        for (std::uint32_t pattern = 0; pattern < 1u << further; ++pattern) {
            if (pattern != 0) { // as of the pattern without its lowest bit
                const auto lowest = static_cast<std::size_t>(__builtin_ctz(pattern));
                remainder[pattern] = remainder[pattern & (pattern - 1)] ^ of_bit[begin + 1 + lowest];
            }
            if (remainder[pattern] == 0) {
                std::vector<std::uint8_t> burst(bytes, 0);
                for (std::size_t i = 0; i <= further; ++i) {
                    if (((2 * pattern + 1) >> i & 1u) != 0) {
                        burst[(begin + i) / 8] ^= static_cast<std::uint8_t>(1u << (begin + i) % 8);
                    }
                }
                missed.push_back(burst);
            }
        }
    }
    return missed;
}

void test_no_burst_that_the_crc_misses_makes_a_wrong_sample()
{
    constexpr std::size_t kPart = 2 + 10 + 2, kPlain = 9 + 10 + 2; // of one servo, in one answer or in its own
    for (const bool is_plain : {false, true}) {
        Bench bench;
        bench.serve_us = kTick_us; // so that the answers come in one piece
        bench.be_ready();
        bench.driver.is_plain = is_plain;
        const std::size_t packets = is_plain ? 3 : 1, length = is_plain ? kPlain : 8 + 3 * kPart;
        const auto bursts = missed_bursts(length);
        for (const auto &burst : bursts) {
            for (std::size_t packet = 0; packet < packets; ++packet) {
                bench.flips.assign(packets * length, 0);
                const auto at = static_cast<std::ptrdiff_t>(packet * length);
                std::copy(burst.begin(), burst.end(), bench.flips.begin() + at);
                bench.run(0.02);
                TEST_ASSERT_TRUE(bench.flips.empty());
                TEST_ASSERT_EQUAL(0, bench.wrong[0] + bench.wrong[1] + bench.wrong[2]);
            }
        }
        const std::size_t tried = packets * bursts.size();
        bench.say((std::to_string(tried) + " bursts that the CRC misses").c_str(), 2e-2 * static_cast<double>(tried));
        TEST_ASSERT_GREATER_THAN(40, tried);
        TEST_ASSERT_GREATER_THAN(3, bench.report(0).doubted + bench.report(1).doubted + bench.report(2).doubted);
    }
}

void test_much_damage_makes_no_wrong_sample()
{
    Bench bench;
    bench.be_ready();
    brace_servos_damage(bench.servos.get(), 0.3);
    bench.run(0.6 * kDamaged_s);
    bench.say("30 % of the packets damaged", 0.6 * kDamaged_s);
    TEST_ASSERT_EQUAL(0, bench.wrong[0] + bench.wrong[1] + bench.wrong[2]);
}

// ------------------------------------------------------------------------------------------------ what goes wrong

void test_a_silent_servo_is_told_and_the_others_go_on()
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
    bench.turns_rad_per_s = 0.0;
    bench.be_ready();
    TEST_ASSERT_EQUAL(BRACE_HAL_OK, brace_dynamixel_move(&bench.driver, kFemur, 0.5f));
    bench.run(0.1);
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

void test_a_hardware_error_is_told_and_the_joint_is_still_measured()
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

void test_a_line_that_takes_nothing_is_told()
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
        const auto tell = [&] {
            TEST_ASSERT_EQUAL(BRACE_HAL_OK, brace_dynamixel_command(&bench.driver, kFemur, &command));
        };
        bench.run(0.1, tell);
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

// The driver asks a servo where it stands, and then tells it to stay there. A damaged answer must not move the servo.
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
    constexpr std::size_t kIdentity = 9 + 12 + 2, kLimit = 9 + 2 + 2;
    Bench sound;
    sound.be_ready();
    for (const std::size_t length : {kIdentity, kLimit}) {
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

// In position mode (3) a servo takes no goal beyond its turn: it cannot be told to stand where it is.
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
    bench.turns_rad_per_s = 0.0;
    bench.be_ready();
    TEST_ASSERT_EQUAL(BRACE_HAL_OK, brace_dynamixel_move(&bench.driver, kFemur, 0.5f));
    bench.run(0.1);
    double before_rad = 0, goal_rad = 0, most_a = 0;
    TEST_ASSERT_EQUAL(1, brace_servos_goal(bench.servos.get(), kFemur, &before_rad, &most_a));
    TEST_ASSERT_DOUBLE_WITHIN(1 / kCountsPerRad, M_PI + 0.25, before_rad);
    bench.be_ready();
    TEST_ASSERT_EQUAL(1, brace_servos_goal(bench.servos.get(), kFemur, &goal_rad, &most_a));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, before_rad, goal_rad);
}

void test_nobody_is_told_to_hold_who_shall_not()
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
    RUN_TEST(test_three_joints_at_3_mbit_per_s);
    RUN_TEST(test_one_percent_of_the_packets_damaged);
    RUN_TEST(test_no_burst_that_the_crc_misses_makes_a_wrong_sample);
    RUN_TEST(test_much_damage_makes_no_wrong_sample);
    RUN_TEST(test_a_silent_servo_is_told_and_the_others_go_on);
    RUN_TEST(test_a_servo_that_starts_anew_stands_where_it_is_and_is_counted);
    RUN_TEST(test_a_hardware_error_is_told_and_the_joint_is_still_measured);
    RUN_TEST(test_servos_that_know_no_fast_sync_read_are_asked_otherwise);
    RUN_TEST(test_a_line_that_hears_itself_disturbs_nothing);
    RUN_TEST(test_foreign_servos_are_refused);
    RUN_TEST(test_a_line_that_takes_nothing_is_told);
    RUN_TEST(test_offsets_and_torque_limits_reach_the_servos_and_fade);
    RUN_TEST(test_an_offset_fades_from_where_it_was_when_a_servo_is_back);
    RUN_TEST(test_a_goal_that_the_line_did_not_take_is_sent_again_at_once);
    RUN_TEST(test_no_burst_that_the_crc_misses_sends_a_servo_elsewhere);
    RUN_TEST(test_no_burst_that_the_crc_misses_makes_another_servo_of_it);
    RUN_TEST(test_a_servo_beyond_its_turn_is_refused_and_not_moved);
    RUN_TEST(test_commands_that_make_no_sense_are_refused);
    RUN_TEST(test_a_servo_that_holds_goes_on_holding_when_the_controller_starts_anew);
    RUN_TEST(test_nobody_is_told_to_hold_who_shall_not);
    return UNITY_END();
}
