#include "stiffness_words.h"

#include "brace/code_names.h"

enum { DECIMALS = 10000 };

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

void stiffness_words(text_t *text, const brace_app_t *app)
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
