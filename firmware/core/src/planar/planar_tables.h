/* The tick's table for the direction of the stiff axis. */
#ifndef BRACE_PLANAR_TABLES_H
#define BRACE_PLANAR_TABLES_H

#include <stdint.h>

/* A quartic in t q31: angle (rad q29) = c0 + t (c1 + t (c2 + t (c3 + t c4))), products by high words. */
typedef struct {
    int64_t c0_c1; /* high word, low word */
    int64_t c2_c3; /* the lower half of c3 is c4, in its upper 16 bits */
} brace_axis_row_t;

/* t runs from -1 to 1. */
enum { BRACE_AXIS_ROWS = 8 };

extern const brace_axis_row_t brace_axis_table[BRACE_AXIS_ROWS];

/* A little less than 2^31, so that no rounding can carry the 1 of t over the edge; the table makes up for it. */
#define BRACE_AXIS_ONE 0x1.ffffep30f

#endif
