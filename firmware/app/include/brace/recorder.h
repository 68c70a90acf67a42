/* What a loading test leaves behind: a ring of rows, the columns of a loading dataset.
 *
 * The oldest rows give way to new ones and are counted. One caller; no call blocks.
 */
#ifndef BRACE_RECORDER_H
#define BRACE_RECORDER_H

#include <stdint.h>

#include "brace/status.h"

enum { BRACE_RECORDER_ROWS = 256 };

/* One row. Numbers as in data.csv: displacement and force of the tip. */
typedef struct {
    uint16_t run;    /* loading tests since start, from 1 */
    uint16_t config; /* posture: counts up when a test begins more than 0.01 rad from where the first
                        of this config did */
    uint8_t axis;    /* 0: x, 1: z */
    uint8_t rep;     /* tests before this one along this axis at this posture */
    uint16_t step;   /* of the pass 0 -> +n -> 0 -> -n -> 0, from 0 */
    float theta1_rad, theta2_rad; /* at the preload point */
    float t_s;       /* since the test began */
    float temp_degc;
    float dx_mm, dz_mm; /* by the levers of the preload point: straight, where the tip goes on an arc */
    float fx_n, fz_n;
    /* Deflections between motor and link encoder since the preload point, counter-clockwise: enc2_rad opens the knee.
     * NaN without such an encoder. */
    float enc1_rad, enc2_rad;
} brace_row_t;

/* The columns in the order of data.csv, with enc1_rad and enc2_rad. */
enum { BRACE_ROW_COLUMNS = 15 };

/* All zero when it is empty. */
typedef struct {
    brace_row_t row[BRACE_RECORDER_ROWS];
    uint32_t next, count; /* next: where the next row goes */
    uint32_t lost; /* rows that gave way to newer ones; saturates */
} brace_recorder_t;

/* Adds a row; the oldest gives way. About 40 instructions. */
void brace_recorder_add(brace_recorder_t *recorder, const brace_row_t *row);

/* Row number index, 0 the oldest there.
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_RANGE (no such row); row untouched unless BRACE_OK */
brace_status_t brace_recorder_row(const brace_recorder_t *recorder, uint32_t index, brace_row_t *row);

/* A cell as a number, for wires. column: 0 run ... 14 enc2_rad
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_RANGE */
brace_status_t brace_row_value(const brace_row_t *row, uint32_t column, float *value);

#endif
