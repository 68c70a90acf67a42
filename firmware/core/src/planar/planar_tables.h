/* The tick's table for the direction of the stiff axis. */
#ifndef BRACE_PLANAR_TABLES_H
#define BRACE_PLANAR_TABLES_H

#include <stdint.h>

/* A cubic in d, the low 28 bits of t (q31): angle (rad q29) = c0 + d (c1 + d (c2 + d c3)), products by high words. */
typedef struct {
    int64_t c0_c1; /* high word, low word */
    int64_t c2_c3;
} brace_axis_row_t;

/* 16 rows for dev_x < 0, then 16 for dev_x > 0; in each half t runs from -1 to 1. */
enum { BRACE_AXIS_ROWS = 32, BRACE_AXIS_MIDDLE = 24 };

extern const brace_axis_row_t brace_axis_table[BRACE_AXIS_ROWS];

#endif
