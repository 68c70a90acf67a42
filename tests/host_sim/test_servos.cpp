// The driver for Dynamixel servos on a line of simulated servos. It prints how many samples come, how old they are when
// they are used, and what damage does.
#include "servo_bench.h"

#include <string>

void setUp(void) {}
void tearDown(void) {}

namespace {

// How long damage at random is played. The plain build shows that it does no harm; the sanitized build looks at each
// access to memory, and meets each kind of damage within seconds.
#ifdef __SANITIZE_ADDRESS__
constexpr int kDamaged_s = 20;
#else
constexpr int kDamaged_s = 100;
#endif

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

} // namespace

int main()
{
    UNITY_BEGIN();
    RUN_TEST(test_three_joints_at_3_mbit_per_s);
    RUN_TEST(test_one_percent_of_the_packets_damaged);
    RUN_TEST(test_no_burst_that_the_crc_misses_makes_a_wrong_sample);
    RUN_TEST(test_much_damage_makes_no_wrong_sample);
    return UNITY_END();
}
