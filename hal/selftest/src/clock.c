/* Checks that time runs, forwards, in fine steps, and at the right rate. */
#include "selftest.h"

enum { READINGS = 20000, STILL_MAX = 2000000, STEP_MAX_US = 10 };
enum { WINDOW_US = 20000, RATE_PERMILLE_MAX = 50, ATTEMPTS = 8 };

static uint32_t now(const selftest_t *test)
{
    return test->hal->now_us(test->hal->context);
}

static bool advances(const selftest_t *test)
{
    const uint32_t first = now(test);
    uint32_t readings = 0u;
    while (now(test) == first && readings < STILL_MAX) {
        readings++;
    }
    return readings < STILL_MAX;
}

/* The smallest step seen; 0: time ran backwards. A large step alone proves nothing, because a host may be interrupted
 * for longer. */
static uint32_t smallest_step_us(const selftest_t *test)
{
    uint32_t last = now(test), smallest = UINT32_MAX;
    for (uint32_t i = 0u; i < READINGS; i++) {
        const uint32_t next = now(test), step = next - last;
        if ((int32_t)step < 0) {
            return 0u;
        }
        if (step > 0u && step < smallest) {
            smallest = step;
        }
        last = next;
    }
    return smallest;
}

/* Compares now_us once with the other clock, over less than half of that clock's period; false: that clock stood
 * still. */
static bool measure(const selftest_t *test, int32_t *permille)
{
    const brace_selftest_setup_t *const setup = test->setup;
    const uint32_t mask = UINT32_MAX >> (32u - setup->reference_bits);
    const uint64_t half_trip_us = ((uint64_t)mask + 1u) * 1000000u / setup->reference_hz / 2u;
    const uint32_t window_us = half_trip_us < (uint64_t)WINDOW_US ? (uint32_t)half_trip_us : (uint32_t)WINDOW_US;
    const uint32_t began_us = now(test), began_count = setup->reference_count(0);
    uint32_t us = 0u, asked = 0u;
    while (us < window_us && asked < STILL_MAX) {
        us = now(test) - began_us;
        asked++;
    }
    const uint32_t rose = setup->reference_count(0) - began_count;
    const uint32_t counted = (setup->reference_falls ? 0u - rose : rose) & mask;
    const uint64_t true_us = (uint64_t)counted * 1000000u / setup->reference_hz;
    if (true_us == 0u) {
        return false;
    }
    *permille = (int32_t)((int64_t)us * 1000 / (int64_t)true_us - 1000);
    return true;
}

/* The two clocks are not read at the same instant. On a host or an emulator whole milliseconds may lie between. So the
 * test makes a few attempts: a right rate shows in at least one, a wrong rate in none. A clock that stands still does
 * so in all. */
static void rate(selftest_t *test)
{
    int32_t permille = 0;
    bool agrees = false, runs = false;
    for (uint32_t attempt = 0u; attempt < ATTEMPTS && !agrees; attempt++) {
        if (measure(test, &permille)) {
            runs = true;
            agrees = permille <= RATE_PERMILLE_MAX && permille >= -RATE_PERMILLE_MAX;
        }
    }
    if (!runs) {
        selftest_report(test, BRACE_SELFTEST_NOTE, "now_us", "rate not judged: the other clock stands");
        return;
    }
    selftest_report_value(
        test, agrees ? BRACE_SELFTEST_PASS : BRACE_SELFTEST_FAIL, "now_us",
        agrees ? "rate agrees with the other clock"
               : "runs at the wrong rate against the other clock: look at the timer's prescaler and its bus clock",
        permille, "permille too fast");
}

void selftest_clock(selftest_t *test)
{
    test->clock_runs = selftest_expect(test, advances(test), "now_us", "time runs",
                                       "time stands still: is the timer's clock switched on, the timer started?");
    if (!test->clock_runs) {
        return;
    }
    const uint32_t step_us = smallest_step_us(test);
    if (step_us == 0u) {
        selftest_report(
            test, BRACE_SELFTEST_FAIL, "now_us",
            "time runs backwards: a counter that falls, or halves of a longer count read across its overflow");
        return;
    }
    if (step_us > STEP_MAX_US) {
        selftest_report_value(test, BRACE_SELFTEST_FAIL, "now_us", "steps are too coarse: at most 10 us is promised",
                              (int32_t)step_us, "us");
    } else {
        selftest_report_value(test, BRACE_SELFTEST_PASS, "now_us", "forwards, in fine steps", (int32_t)step_us, "us");
    }
    if (test->setup->reference_count != 0) {
        rate(test);
    }
}
