/* The port self-test and clocks: each lie is named and nothing else blamed before it; a second clock that is held up is
 * not. */
#include "selftest_door.h"

enum { CLOCK_STANDS = 1, CLOCK_RUNS_BACK, CLOCK_COARSE, CLOCK_FAST, CLOCK_SLOW, LIES };

static uint32_t reads;

static uint32_t lying_now_us(void *context)
{
    (void)context;
    reads++;
    switch (world.lie) {
    case CLOCK_STANDS: break;
    case CLOCK_RUNS_BACK: world.us += reads % 1000u == 0u ? 0u - 50u : 1u; break;
    case CLOCK_COARSE: world.us += reads % 50u == 0u ? 1000u : 0u; break;
    default: world.us += 1u; break;
    }
    return world.us;
}

static void open_lying(int lie)
{
    reads = 0u;
    door.now_us = lying_now_us;
    world.count_eighths = lie == CLOCK_FAST ? 7u : lie == CLOCK_SLOW ? 16u : 8u;
}

static void each_lie_is_named(void)
{
    static const named_t named[] = {
        {CLOCK_STANDS, "now_us", "stands still"}, {CLOCK_RUNS_BACK, "now_us", "backwards"},
        {CLOCK_COARSE, "now_us", "too coarse"},   {CLOCK_FAST, "now_us", "wrong rate"},
        {CLOCK_SLOW, "now_us", "wrong rate"},
    };
    TEST_ASSERT_EQUAL_UINT32(LIES - 1u, sizeof named / sizeof named[0]);
    expect_each_named(named, sizeof named / sizeof named[0], open_lying);
}

static uint32_t early_counts;

/* As if an emulator had been away between the first readings of now_us and of the count: the window is over before the
 * count has moved. */
static uint32_t count_after_a_pause(void *context)
{
    if (early_counts > 0u) {
        early_counts--;
        return 77u;
    }
    return falling_count(context);
}

static uint32_t standing_count(void *context)
{
    (void)context;
    return 77u;
}

static bool is_found(brace_selftest_verdict_t verdict, const char *words)
{
    bool found = false;
    for (uint32_t i = 0u; i < finding_count; i++) {
        found = found || (findings[i].verdict == verdict && strstr(findings[i].what, words) != NULL);
    }
    return found;
}

static void the_other_clock_stands_only_when_it_always_does(void)
{
    open_door();
    early_counts = 2u; /* at the start and the end of the first attempt */
    brace_selftest_setup_t setup = setup_of(0);
    setup.reference_count = count_after_a_pause;
    TEST_ASSERT_EQUAL_INT32(0, brace_selftest_run(&door, &setup, NULL));
    TEST_ASSERT_EQUAL_UINT32(0u, early_counts);
    TEST_ASSERT_TRUE(is_found(BRACE_SELFTEST_PASS, "rate agrees"));
    open_door();
    setup = setup_of(0);
    setup.reference_count = standing_count;
    TEST_ASSERT_EQUAL_INT32(0, brace_selftest_run(&door, &setup, NULL));
    TEST_ASSERT_TRUE(is_found(BRACE_SELFTEST_NOTE, "the other clock stands"));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(each_lie_is_named);
    RUN_TEST(the_other_clock_stands_only_when_it_always_does);
    return UNITY_END();
}
