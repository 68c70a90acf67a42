/* Written by tools/interface from dictionary.toml; do not edit. */
#ifndef BRACE_CODE_NAMES_H
#define BRACE_CODE_NAMES_H

/* Names and sentences for numbers that mean something.
 *
 * brace_<table>_name gives the name of a number, brace_<table>_text the sentence that explains it; of bits, those of
 * the bit at that place. A number without a meaning has the name "?" and the text "?". Constant storage, never null.
 * Pure functions; any thread. An image that never asks carries no texts. */
#include <stdint.h>

const char *brace_mode_name(int32_t number);
const char *brace_mode_text(int32_t number);
const char *brace_setting_name(int32_t number);
const char *brace_setting_text(int32_t number);
const char *brace_owner_name(int32_t number);
const char *brace_owner_text(int32_t number);
const char *brace_play_name(int32_t number);
const char *brace_play_text(int32_t number);
const char *brace_take_up_phase_name(int32_t number);
const char *brace_take_up_phase_text(int32_t number);
const char *brace_take_up_outcome_name(int32_t number);
const char *brace_take_up_outcome_text(int32_t number);
const char *brace_loading_outcome_name(int32_t number);
const char *brace_loading_outcome_text(int32_t number);
const char *brace_drift_state_name(int32_t number);
const char *brace_drift_state_text(int32_t number);
const char *brace_drift_cause_name(int32_t number);
const char *brace_drift_cause_text(int32_t number);
const char *brace_drift_next_step_name(int32_t number);
const char *brace_drift_next_step_text(int32_t number);
const char *brace_heartbeat_state_name(int32_t number);
const char *brace_heartbeat_state_text(int32_t number);
const char *brace_parameter_origin_name(int32_t number);
const char *brace_parameter_origin_text(int32_t number);
const char *brace_contact_name(int32_t number);
const char *brace_contact_text(int32_t number);
const char *brace_fault_name(int32_t number);
const char *brace_fault_text(int32_t number);
const char *brace_flag_name(int32_t number);
const char *brace_flag_text(int32_t number);
const char *brace_drift_could_be_name(int32_t number);
const char *brace_drift_could_be_text(int32_t number);

#endif
