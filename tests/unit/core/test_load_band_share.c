/* How often the sum of two loads behind gears lies in its interval. The oracle is sums of random numbers. */
#include <stdint.h>

#include "brace/load_band.h"
#include "unity.h"

void setUp(void) {}

void tearDown(void) {}

static uint32_t luck = 1;

static float lot(void)
{
    luck = luck * 1664525u + 1013904223u;
    return 2.0f * (float)(luck >> 8) / 16777216.0f - 1.0f;
}

/* The share of sums of two even bands that the interval holds. */
static float held(const brace_load_band_t *one, float one_ratio, const brace_load_band_t *two, float two_ratio)
{
    enum { COUNT = 40000 };
    const float middle = one_ratio * one->middle_n_mm + two_ratio * two->middle_n_mm;
    const brace_interval_t found = brace_load_band_sum(one, one_ratio, two, two_ratio, middle);
    int in = 0;
    for (int i = 0; i < COUNT; i++) {
        float noise_one = 0.0f, noise_two = 0.0f; /* nearly normal, one sigma */
        for (int j = 0; j < 12; j++) {
            noise_one += 0.5f * lot();
            noise_two += 0.5f * lot();
        }
        const float sum = middle + one_ratio * (one->half_n_mm * lot() + one->noise_n_mm * noise_one) +
                          two_ratio * (two->half_n_mm * lot() + two->noise_n_mm * noise_two);
        in += sum >= found.low && sum <= found.high;
    }
    return (float)in / (float)COUNT;
}

/* 40,000 sums: one sigma of the share is 0.15 %. Noise of the band's own size makes it a little too wide. */
static void test_the_sum_of_two_bands_holds_ninety_percent(void)
{
    for (float ratio = -3.0f; ratio <= 3.1f; ratio += 0.37f) {
        const brace_load_band_t one = {100.0f, 40.0f, 0.0f, 0.0f}, two = {-30.0f, 25.0f, 0.0f, 0.0f};
        TEST_ASSERT_FLOAT_WITHIN(0.006f, 0.90f, held(&one, 0.7f, &two, ratio));
        const brace_load_band_t noisy = {0.0f, 10.0f, 10.0f, 0.0f};
        TEST_ASSERT_FLOAT_WITHIN(0.02f, 0.91f, held(&one, 0.7f, &noisy, ratio));
        const brace_load_band_t came = {100.0f, 40.0f, 0.0f, 1.0f}, back = {-30.0f, 25.0f, 0.0f, -1.0f};
        TEST_ASSERT_FLOAT_WITHIN(0.03f, 0.90f, held(&came, 0.7f, &back, ratio));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_sum_of_two_bands_holds_ninety_percent);
    return UNITY_END();
}
