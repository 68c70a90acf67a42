// Four numbers at once against one at a time, and both against the library's sine and cosine in extended precision.
#include <cmath>
#include <limits>

extern "C" {
#include "unity.h"
}
#include "plant/lanes.h"
#include "rig/noise.h"

using brace::plant::kLanes;
using brace::plant::Lanes;

void setUp(void) {}
void tearDown(void) {}

namespace {

constexpr double kRounding = std::numeric_limits<double>::epsilon(); // of a number near 1; twice what a rounding moves

bool is_number(double a)
{
    return a == a;
}

bool same(double a, double b)
{
    return is_number(a) ? a == b && std::copysign(1.0, a) == std::copysign(1.0, b) : !is_number(b);
}

// Where the series takes over from the library, beyond it, and what is no angle.
constexpr double kAngles_rad[] = {0.0,
                                  -0.0,
                                  1e-300,
                                  1e-9,
                                  0.01,
                                  -0.3,
                                  0.4999,
                                  0.5,
                                  -0.5,
                                  0.5000001,
                                  1.0,
                                  -3.0,
                                  std::numeric_limits<double>::quiet_NaN()};

} // namespace

// The test allows an error of one epsilon. The last sum of the series has at most half of it. The roundings in its
// second term, which is small, add at most a tenth.
static void test_sine_and_cosine(void)
{
    brace::rig::Noise draw(11);
    for (int i = 0; i < 100000; ++i) {
        const double angle_rad = (2.0 * draw.uniform() - 1.0) * std::pow(10.0, -6.0 * draw.uniform());
        double sin, cos;
        brace::plant::sin_cos(angle_rad, sin, cos);
        const auto exact_sin = static_cast<double>(std::sin(static_cast<long double>(angle_rad)));
        const auto exact_cos = static_cast<double>(std::cos(static_cast<long double>(angle_rad)));
        TEST_ASSERT_DOUBLE_WITHIN(kRounding * std::fabs(exact_sin), exact_sin, sin);
        TEST_ASSERT_DOUBLE_WITHIN(kRounding, exact_cos, cos);
    }
}

static void test_a_lane_does_not_see_the_others(void)
{
    for (const double one : kAngles_rad) {
        for (const double other : kAngles_rad) {
            Lanes angle_rad(other), sin, cos;
            angle_rad.at[1] = one;
            brace::plant::sin_cos(angle_rad, sin, cos);
            for (std::size_t lane = 0; lane < kLanes; ++lane) {
                double alone_sin, alone_cos;
                brace::plant::sin_cos(lane == 1 ? one : other, alone_sin, alone_cos);
                TEST_ASSERT_TRUE(same(alone_sin, sin.at[lane]));
                TEST_ASSERT_TRUE(same(alone_cos, cos.at[lane]));
            }
        }
    }
}

static void test_choices_are_those_of_each_lane(void)
{
    for (const double one : kAngles_rad) {
        for (const double other : kAngles_rad) {
            Lanes a(other), b(one);
            a.at[2] = one;
            b.at[2] = other;
            const Lanes larger = brace::plant::larger(a, b), magnitude = brace::plant::magnitude(a),
                        negative = brace::plant::one_if_negative(a);
            bool some = false;
            for (std::size_t lane = 0; lane < kLanes; ++lane) {
                const double x = a.at[lane], y = b.at[lane];
                TEST_ASSERT_TRUE(same(brace::plant::larger(x, y), larger.at[lane]));
                TEST_ASSERT_TRUE(same(brace::plant::one_if_negative(x), negative.at[lane]));
                TEST_ASSERT_TRUE(same(brace::plant::magnitude(x), magnitude.at[lane]));
                some = some || brace::plant::is_there(x);
            }
            TEST_ASSERT_EQUAL(some, brace::plant::is_there(a));
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_sine_and_cosine);
    RUN_TEST(test_a_lane_does_not_see_the_others);
    RUN_TEST(test_choices_are_those_of_each_lane);
    return UNITY_END();
}
