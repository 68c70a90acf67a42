#include "console.h"

#include "banner.h"
#include "board.h"
#include "brace/code_names.h"
#include "brace_hal_selftest.h"
#include "cortex_m.h"
#include "key_entry.h"
#if defined(BRACE_PROVOKE_FAULTS)
#include "provoke.h"
#endif

enum { SYSTICK_BITS = 24, DECIMALS = 10000 };

static key_entry_t key_entry;

static void help(text_t *text)
{
    text_string(text, "b banner  k stiffness  c forget the crash  r restart");
    text_line(text);
    text_string(text, "K keep this board's key  B bench until the next start: everybody on its buses may move the limb");
    text_line(text);
    text_string(text, "t self-test, memory kept; T self-test, the parameter slot not in force is erased; then restart");
    text_line(text);
#if defined(BRACE_PROVOKE_FAULTS)
    provoke_help(text);
#endif
}

/* Prints four decimals; a number that is too large is printed as such. */
static void text_value(text_t *text, const char *key, float value)
{
    text_string(text, key);
    if (!(value > -2e5f && value < 2e5f)) {
        text_string(text, "beyond");
        return;
    }
    const float scaled = value * (float)DECIMALS;
    const int32_t fixed = (int32_t)(scaled + (scaled < 0.0f ? -0.5f : 0.5f));
    const uint32_t size = (uint32_t)(fixed < 0 ? -fixed : fixed);
    text_string(text, fixed < 0 ? "-" : "");
    text_unsigned(text, size / DECIMALS);
    text_string(text, ".");
    for (uint32_t place = DECIMALS / 10u; place > 0u; place /= 10u) {
        text_unsigned(text, size / place % 10u);
    }
}

typedef enum { FLAGS, FAULTS } bits_t;

/* Prints the names of the bits that are set. */
static void text_bits(text_t *text, const char *key, uint32_t bits, bits_t kind)
{
    text_string(text, key);
    if (bits == 0u) {
        text_string(text, " none");
    }
    for (int32_t bit = 0; bit < 32; bit++) {
        if ((bits >> bit & 1u) != 0u) {
            text_string(text, " ");
            text_string(text, kind == FLAGS ? brace_flag_name(bit) : brace_fault_name(bit));
        }
    }
}

static void space_stiffness(text_t *text, const brace_snapshot_t *now)
{
    const brace_stiffness_spatial_t *const k = &now->space.now;
    text_string(text, now->space.is_valid ? "space: valid" : "space: not valid");
    if (now->space.is_valid) {
        text_value(text, " k_xx_n_per_mm ", k->k_xx_n_per_mm);
        text_value(text, " k_xy_n_per_mm ", k->k_xy_n_per_mm);
        text_value(text, " k_xz_n_per_mm ", k->k_xz_n_per_mm);
        text_value(text, " k_yy_n_per_mm ", k->k_yy_n_per_mm);
        text_value(text, " k_yz_n_per_mm ", k->k_yz_n_per_mm);
        text_value(text, " k_zz_n_per_mm ", k->k_zz_n_per_mm);
        text_value(text, " theta0_rad ", now->theta_rad[BRACE_COXA]);
    }
    text_bits(text, " flags", k->flags, FLAGS);
    text_line(text);
}

/* Prints nothing while the limb has not drifted. */
static void drift(text_t *text, const brace_drift_report_t *report)
{
    if (report->state != BRACE_DRIFT_DRIFTED) {
        return;
    }
    text_string(text, "drift: ");
    text_string(text, brace_drift_cause_text((int32_t)report->cause + 1)); /* the core counts causes from one less */
    text_value(text, " evidence ", report->evidence);
    text_line(text);
}

static void stiffness(text_t *text, const brace_app_t *app)
{
    const brace_snapshot_t *const now = brace_app_snapshot(app);
    const brace_stiffness_t *const k = &now->stiffness.now;
    text_string(text, now->k_is_valid ? "k: valid" : "k: not valid");
    if (now->k_is_valid) { /* else there is no number to print */
        text_value(text, " k_xx_n_per_mm ", k->k_xx_n_per_mm);
        text_value(text, " k_xz_n_per_mm ", k->k_xz_n_per_mm);
        text_value(text, " k_zz_n_per_mm ", k->k_zz_n_per_mm);
        text_value(text, " theta1_rad ", now->theta_rad[BRACE_FEMUR]);
        text_value(text, " theta2_rad ", now->theta_rad[BRACE_TIBIA]);
    }
    text_bits(text, " flags", k->flags, FLAGS);
    text_bits(text, " faults", now->faults, FAULTS);
    text_string(text, " mode ");
    text_string(text, brace_mode_name((int32_t)now->mode));
    text_string(text, " setting ");
    text_string(text, brace_setting_name((int32_t)brace_app_setting(app)));
    text_string(text, " tick ");
    text_unsigned(text, now->sequence);
    text_line(text);
    if (now->space.is_fitted) {
        space_stiffness(text, now);
    }
    drift(text, brace_app_drift_report(app));
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

static uint32_t systick(void *context)
{
    (void)context;
    return SYSTICK_VALUE;
}

static void selftest(text_t *text, const brace_app_t *app, bool may_erase)
{
    text_wait(text);
    const int32_t spare = brace_app_snapshot(app)->parameter_origin == BRACE_PARAMETERS_SLOT_B ? 0 : 1;
    SYSTICK_LOAD = (1u << SYSTICK_BITS) - 1u;
    SYSTICK_VALUE = 0u;
    SYSTICK_CONTROL = SYSTICK_ON_CORE_CLOCK;
    const brace_selftest_setup_t setup = {
        .report = finding,
        .report_context = text,
        .scratch_slot = may_erase ? spare : BRACE_SELFTEST_KEEP_NVM,
        .reference_count = systick,
        .reference_hz = board_core_hz(),
        .reference_bits = SYSTICK_BITS,
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

static void become_bench(text_t *text, brace_app_t *app)
{
    brace_app_become_bench(app);
    text_string(text, "bench until the next start");
    text_line(text);
}

void console_serve(text_t *text, brace_app_t *app)
{
    const brace_hal_t *const hal = text->hal;
    uint8_t request = 0u;
    if (!text_serve(text)) { /* one answer at a time */
        return;
    }
    if (hal->serial_read(hal->context, BRACE_SERIAL_CONSOLE, &request, 1u) != 1) {
        return;
    }
    text->gone = false; /* a person who has just typed listens */
    if (key_entry.is_open) {
        key_entry_take(&key_entry, text, request);
        return;
    }
    switch (request) {
    case '?': help(text); break;
    case 'b':
        banner_image(text);
        banner_application(text, app, BRACE_OK);
        break;
    case 'k': stiffness(text, app); break;
    case 'c': hal->crash_clear(hal->context); break;
    case 'K': key_entry_begin(&key_entry, text); break;
    case 'B': become_bench(text, app); break;
    case 'r': hal->restart(hal->context); break;
    case 't': selftest(text, app, false); break;
    case 'T': selftest(text, app, true); break;
    default:
#if defined(BRACE_PROVOKE_FAULTS)
        provoke(request);
#endif
        break;
    }
}
