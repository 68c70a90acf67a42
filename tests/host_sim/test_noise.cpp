// The rig's random numbers are those of everyone else's SplitMix64, and its normal ones have the right shape.
#include <cmath>

extern "C" {
#include "unity.h"
}
#include "rig/noise.h"

void setUp(void) {}
void tearDown(void) {}

// Published outputs of SplitMix64 for seed 1234567.
static void test_bits_are_splitmix64(void)
{
    const std::uint64_t expected[] = {6457827717110365317u, 3203168211198807973u, 9817491932198370423u,
                                      4593380528125082431u, 16408922859458223821u};
    brace::rig::Noise noise(1234567);
    for (const std::uint64_t each : expected) {
        TEST_ASSERT_EQUAL_HEX64(each, noise.bits());
    }
}

static void test_uniform_stays_inside(void)
{
    brace::rig::Noise noise(1);
    double sum = 0.0;
    for (int i = 0; i < 100000; ++i) {
        const double u = noise.uniform();
        TEST_ASSERT_TRUE(u > 0.0 && u < 1.0);
        sum += u;
    }
    TEST_ASSERT_DOUBLE_WITHIN(5.0 / std::sqrt(12.0 * 100000.0), 0.5, sum / 100000.0);
}

// Shares below -2, -1, 0, 1, 2 sigma, each within five of its own standard errors.
static void test_normal_has_its_quantiles(void)
{
    const double edge[] = {-2.0, -1.0, 0.0, 1.0, 2.0};
    int below[5] = {};
    const int count = 200000;
    brace::rig::Noise noise(7);
    for (int i = 0; i < count; ++i) {
        const double x = noise.normal();
        for (int k = 0; k < 5; ++k) {
            below[k] += x < edge[k] ? 1 : 0;
        }
    }
    for (int k = 0; k < 5; ++k) {
        const double share = 0.5 * std::erfc(-edge[k] / std::sqrt(2.0));
        TEST_ASSERT_DOUBLE_WITHIN(5.0 * std::sqrt(share * (1.0 - share) / count), share,
                                  static_cast<double>(below[k]) / count);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_bits_are_splitmix64);
    RUN_TEST(test_uniform_stays_inside);
    RUN_TEST(test_normal_has_its_quantiles);
    return UNITY_END();
}
