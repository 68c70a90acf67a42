/* What every check does: report a finding, wait for a window of time. */
#include "selftest.h"

enum { QUESTIONS_MAX = 200000 };

void selftest_report_value(selftest_t *test, brace_selftest_verdict_t verdict, const char *entry, const char *what,
                           int32_t value, const char *unit)
{
    const brace_selftest_finding_t finding = {verdict, entry, what, unit[0] != '\0', value, unit};
    switch (verdict) {
    case BRACE_SELFTEST_PASS: test->result.passed++; break;
    case BRACE_SELFTEST_NOTE: test->result.noted++; break;
    default: test->result.failed++; break;
    }
    if (test->setup->report != 0) {
        test->setup->report(test->setup->report_context, &finding);
    }
}

void selftest_report(selftest_t *test, brace_selftest_verdict_t verdict, const char *entry, const char *what)
{
    selftest_report_value(test, verdict, entry, what, 0, "");
}

bool selftest_expect(selftest_t *test, bool ok, const char *entry, const char *right, const char *wrong)
{
    selftest_report(test, ok ? BRACE_SELFTEST_PASS : BRACE_SELFTEST_FAIL, entry, ok ? right : wrong);
    return ok;
}

selftest_wait_t selftest_wait(const selftest_t *test, uint32_t window_us)
{
    return (selftest_wait_t){test->hal->now_us(test->hal->context), window_us, 0u};
}

bool selftest_waiting(const selftest_t *test, selftest_wait_t *wait)
{
    wait->asked++;
    if (test->setup->serve != 0) {
        test->setup->serve();
    }
    if (!test->clock_runs && wait->asked > QUESTIONS_MAX / 100) {
        return false;
    }
    return wait->asked <= QUESTIONS_MAX && test->hal->now_us(test->hal->context) - wait->began_us < wait->window_us;
}
