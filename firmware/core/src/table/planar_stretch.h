/* A stretch of the planar table: the knee angles in it, and whether table and tick agree there. */
#ifndef BRACE_PLANAR_STRETCH_H
#define BRACE_PLANAR_STRETCH_H

#include "brace/planar_table.h"
#include "base/trig.h"

#define RAD_PER_UNIT (2.0f * BRACE_PI / 0x1p29f) /* 2^29 units to a turn, as the ticks have it */
#define STRETCH_UNITS 0x200000

/* The knee angle nearest to a place [-1, 1] in a stretch, in [-pi, pi]. */
static inline float brace_planar_stretch_rad(int32_t row, float place)
{
    const int32_t stretch = row < BRACE_PLANAR_TABLE_ROWS / 2 ? row : row - BRACE_PLANAR_TABLE_ROWS;
    return ((float)stretch + 0.5f * place) * (RAD_PER_UNIT * STRETCH_UNITS);
}

/* Not zero where they agree at the places between which the table's polynomials are furthest off. */
int brace_planar_stretch_agrees(const brace_planar_t *planar, const brace_planar_table_t *table, int32_t row);

#endif
