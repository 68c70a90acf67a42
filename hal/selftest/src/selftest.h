/* What the checks share: the state of one run, and how to report a finding. */
#ifndef SELFTEST_H
#define SELFTEST_H

#include "brace_hal_selftest.h"

typedef struct {
    const brace_hal_t *hal;
    const brace_selftest_setup_t *setup;
    brace_selftest_result_t result;
    bool clock_runs; /* a check may wait for a window of time */
} selftest_t;

void selftest_report(selftest_t *test, brace_selftest_verdict_t verdict, const char *entry, const char *what);
void selftest_report_value(selftest_t *test, brace_selftest_verdict_t verdict, const char *entry, const char *what,
                           int32_t value, const char *unit);

/* Reports PASS with `right`, or FAIL with `wrong`; returns ok. */
bool selftest_expect(selftest_t *test, bool ok, const char *entry, const char *right, const char *wrong);

/* A window of time to wait in. It ends when the time is over, or after a number of questions if the clock is bad. */
typedef struct {
    uint32_t began_us, window_us, asked;
} selftest_wait_t;

selftest_wait_t selftest_wait(const selftest_t *test, uint32_t window_us);
bool selftest_waiting(const selftest_t *test, selftest_wait_t *wait);

void selftest_clock(selftest_t *test);
void selftest_joints(selftest_t *test);
void selftest_nvm(selftest_t *test);
void selftest_serial(selftest_t *test);
void selftest_can(selftest_t *test);

#endif
