#include "port_test.h"

#include <stddef.h>

#include "board.h"
#include "brace_hal_selftest.h"
#include "second_clock.h"

uint32_t port_test_slot(const brace_app_t *app)
{
    return brace_app_snapshot(app)->parameter_origin == BRACE_PARAMETERS_SLOT_B ? 0u : 1u;
}

const char *port_test_obstacle(const brace_app_t *app, port_test_t kind)
{
    if (brace_app_moves(app)) {
        return "a joint moves or is held; let it go first";
    }
    if (brace_app_mode(app) == BRACE_MODE_CONFIGURATION || brace_app_is_storing(app)) {
        return "parameters are being written; wait until CONFIGURATION has ended";
    }
    if (kind == PORT_TEST_SLOT && (brace_app_faults(app) & (uint32_t)BRACE_FAULT_OLD_PARAMETERS) != 0u) {
        return "OLD_PARAMETERS stands: that slot holds the set that was lost, and shows that it was; store a set first";
    }
    if (kind == PORT_TEST_DRIVES && brace_app_setting(app) != BRACE_SETTING_BENCH) {
        return "drives are tested on a bench only, with the limb free (word: bench)";
    }
    return NULL;
}

static void finding(void *context, const brace_selftest_finding_t *found)
{
    static const char *const verdicts[] = {"pass", "note", "FAIL"};
    text_t *const text = context;
    text_string(text, "selftest: ");
    text_string(text, verdicts[found->verdict]);
    text_string(text, " ");
    text_string(text, found->entry);
    text_string(text, ": ");
    text_string(text, found->what);
    if (found->has_value) {
        text_string(text, " (");
        text_signed(text, found->value);
        text_string(text, " ");
        text_string(text, found->unit);
        text_string(text, ")");
    }
    text_line(text);
}

void port_test_run(text_t *text, const brace_app_t *app, port_test_t kind)
{
    text_wait(text);
    second_clock_start();
    const brace_selftest_setup_t setup = {
        .report = finding,
        .report_context = text,
        .scratch_slot = kind == PORT_TEST_SLOT ? (int32_t)port_test_slot(app) : BRACE_SELFTEST_KEEP_NVM,
        .serve = board_serve,
        .limb_is_free = kind == PORT_TEST_DRIVES,
        .reference_count = second_clock_count,
        .reference_hz = board_core_hz(),
        .reference_bits = SECOND_CLOCK_BITS,
        .reference_falls = true,
    };
    brace_selftest_result_t result = {0};
    (void)brace_selftest_run(text->hal, &setup, &result);
    text_string(text, "selftest: ");
    text_unsigned(text, result.passed);
    text_string(text, " passed, ");
    text_unsigned(text, result.noted);
    text_string(text, " noted, ");
    text_unsigned(text, result.failed);
    text_string(text, " failed");
    text_line(text);
    text->hal->restart(text->hal->context); /* so that the application finds its buses as at power-on */
}
