/* The run: checks that every entry is there, and then one group after another. */
#include "selftest.h"

static void is_there(selftest_t *test, bool there, const char *entry, bool *all)
{
    if (!there) {
        selftest_report(test, BRACE_SELFTEST_FAIL, entry,
                        "null, and not optional: fill it in (hal/blank has every entry)");
        *all = false;
    }
}

/* Checks that the mandatory entries are there. */
static bool door(selftest_t *test)
{
    const brace_hal_t *const hal = test->hal;
    bool all = true;
    is_there(test, hal->board != 0, "board", &all);
    is_there(test, hal->now_us != 0, "now_us", &all);
    is_there(test, hal->joint_read != 0, "joint_read", &all);
    is_there(test, hal->nvm_read != 0, "nvm_read", &all);
    is_there(test, hal->nvm_write != 0, "nvm_write", &all);
    is_there(test, hal->nvm_erase != 0, "nvm_erase", &all);
    is_there(test, hal->serial_setup != 0, "serial_setup", &all);
    is_there(test, hal->serial_write != 0, "serial_write", &all);
    is_there(test, hal->serial_read != 0, "serial_read", &all);
    is_there(test, hal->watchdog_feed != 0, "watchdog_feed", &all);
    is_there(test, hal->reset_cause != 0, "reset_cause", &all);
    is_there(test, hal->crash_read != 0, "crash_read", &all);
    is_there(test, hal->crash_clear != 0, "crash_clear", &all);
    is_there(test, hal->stack_unused_bytes != 0, "stack_unused_bytes", &all);
    is_there(test, hal->restart != 0, "restart", &all);
    if (all) {
        selftest_report(test, BRACE_SELFTEST_PASS, "door", "every entry that is not optional is there");
    }
    return all;
}

static void start_and_stop(selftest_t *test)
{
    const brace_hal_t *const hal = test->hal;
    const brace_reset_cause_t cause = hal->reset_cause(hal->context);
    selftest_expect(test, (uint32_t)cause <= BRACE_RESET_PIN, "reset_cause", "one of the known causes",
                    "a cause that brace_hal.h does not have");
    brace_crash_record_t record;
    const int32_t crashed = hal->crash_read(hal->context, &record);
    selftest_expect(test, crashed == 0 || crashed == 1, "crash_read", "answers 0 or 1", "answers neither 0 nor 1");
    const uint32_t unused = hal->stack_unused_bytes(hal->context);
    if (unused == 0u) {
        selftest_report(test, BRACE_SELFTEST_NOTE, "stack_unused_bytes", "not known, or nothing left");
    } else {
        selftest_report_value(test, BRACE_SELFTEST_PASS, "stack_unused_bytes", "known", (int32_t)unused, "bytes");
    }
}

int32_t brace_selftest_run(const brace_hal_t *hal, const brace_selftest_setup_t *setup, brace_selftest_result_t *result)
{
    static const brace_selftest_setup_t quiet = {.scratch_slot = BRACE_SELFTEST_KEEP_NVM};
    selftest_t test = {.hal = hal, .setup = setup != 0 ? setup : &quiet};
    const brace_selftest_setup_t *const asked = test.setup;
    if (hal == 0 || asked->scratch_slot < BRACE_SELFTEST_KEEP_NVM || asked->scratch_slot >= BRACE_NVM_SLOT_COUNT ||
        (asked->reference_count != 0 &&
         (asked->reference_bits < 8u || asked->reference_bits > 32u || asked->reference_hz == 0u))) {
        return BRACE_HAL_E_RANGE;
    }
    if (door(&test)) {
        hal->watchdog_feed(hal->context);
        selftest_clock(&test);
        start_and_stop(&test);
        selftest_serial(&test);
        selftest_joints(&test);
        hal->watchdog_feed(hal->context);
        selftest_can(&test);
        hal->watchdog_feed(hal->context);
        selftest_nvm(&test);
        hal->watchdog_feed(hal->context);
    }
    if (result != 0) {
        *result = test.result;
    }
    return (int32_t)test.result.failed;
}
