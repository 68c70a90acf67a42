/* Written by tools/interface from messages.toml; do not edit. */
#ifndef BRACE_CAN_SNAPSHOT_H
#define BRACE_CAN_SNAPSHOT_H

/* Frames of process data from the measured values of one snapshot. A signal carries the measured value that has its
 * name, or that messages.toml names.
 *   age_ms: of the snapshot's samples, at the moment when the frame is sent
 *   data (out): 8 bytes; of CAN FD 64
 * cost on a Cortex-M4F: at most 130 instructions; of CAN FD 260. */
#include <stdint.h>

#include "brace/measured.h"

void brace_can_make_stiffness_a(const brace_measured_t *measured, float age_ms, uint8_t *data);
void brace_can_make_stiffness_b(const brace_measured_t *measured, float age_ms, uint8_t *data);
void brace_can_make_eigenvalues(const brace_measured_t *measured, float age_ms, uint8_t *data);
void brace_can_make_posture(const brace_measured_t *measured, float age_ms, uint8_t *data);
void brace_can_make_space_0(const brace_measured_t *measured, float age_ms, uint8_t *data);
void brace_can_make_space_1(const brace_measured_t *measured, float age_ms, uint8_t *data);
void brace_can_make_space_2(const brace_measured_t *measured, float age_ms, uint8_t *data);
void brace_can_make_space_3(const brace_measured_t *measured, float age_ms, uint8_t *data);
void brace_can_make_space_4(const brace_measured_t *measured, float age_ms, uint8_t *data);
void brace_can_make_space_5(const brace_measured_t *measured, float age_ms, uint8_t *data);
void brace_can_make_space_6(const brace_measured_t *measured, float age_ms, uint8_t *data);
void brace_can_make_load_0(const brace_measured_t *measured, float age_ms, uint8_t *data);
void brace_can_make_load_1(const brace_measured_t *measured, float age_ms, uint8_t *data);
void brace_can_make_load_2(const brace_measured_t *measured, float age_ms, uint8_t *data);
void brace_can_make_load_3(const brace_measured_t *measured, float age_ms, uint8_t *data);
void brace_can_make_load_4(const brace_measured_t *measured, float age_ms, uint8_t *data);
void brace_can_make_load_5(const brace_measured_t *measured, float age_ms, uint8_t *data);
void brace_can_make_load_across_0(const brace_measured_t *measured, float age_ms, uint8_t *data);
void brace_can_make_load_across_1(const brace_measured_t *measured, float age_ms, uint8_t *data);
void brace_can_make_sigma_0(const brace_measured_t *measured, float age_ms, uint8_t *data);
void brace_can_make_sigma_1(const brace_measured_t *measured, float age_ms, uint8_t *data);
void brace_can_make_sigma_space_0(const brace_measured_t *measured, float age_ms, uint8_t *data);
void brace_can_make_sigma_space_1(const brace_measured_t *measured, float age_ms, uint8_t *data);
void brace_can_make_sigma_space_2(const brace_measured_t *measured, float age_ms, uint8_t *data);
void brace_can_make_sigma_space_3(const brace_measured_t *measured, float age_ms, uint8_t *data);
void brace_can_make_interval_0(const brace_measured_t *measured, float age_ms, uint8_t *data);
void brace_can_make_interval_1(const brace_measured_t *measured, float age_ms, uint8_t *data);
void brace_can_make_interval_2(const brace_measured_t *measured, float age_ms, uint8_t *data);
void brace_can_make_interval_3(const brace_measured_t *measured, float age_ms, uint8_t *data);
void brace_can_make_interval_across_0(const brace_measured_t *measured, float age_ms, uint8_t *data);
void brace_can_make_interval_across_1(const brace_measured_t *measured, float age_ms, uint8_t *data);
void brace_can_make_snapshot_fd(const brace_measured_t *measured, float age_ms, uint8_t *data);
void brace_can_make_space_fd(const brace_measured_t *measured, float age_ms, uint8_t *data);
void brace_can_make_load_fd(const brace_measured_t *measured, float age_ms, uint8_t *data);
void brace_can_make_sigma_fd(const brace_measured_t *measured, float age_ms, uint8_t *data);
void brace_can_make_interval_fd(const brace_measured_t *measured, float age_ms, uint8_t *data);

#endif
