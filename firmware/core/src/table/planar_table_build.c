#include <stddef.h>

#include "brace/planar_table.h"
#include "table/planar_stretch.h"
#include "base/trig.h"
#include "base/turn.h"

/* To first order from its nearest entry a vector is longer by up to d^2/2; entries are shorter by half of that. */
#define SHORTER (1.0f - 6e-7f)

/* What the tick says at a knee angle, seen from the bisector. */
typedef enum { LAMBDA_MIN, LEAST_COMPLIANCE, TWICE_AXIS } quantity_t;

static float value_of(const brace_stiffness_t *k, quantity_t quantity, uint32_t from_axis)
{
    switch (quantity) {
    case LAMBDA_MIN: return k->lambda_min_n_per_mm;
    case LEAST_COMPLIANCE: return 1.0f / k->lambda_max_n_per_mm;
    default: return (float)(int32_t)(((uint32_t)(int32_t)(k->stiff_axis_rad * (0x1p31f / BRACE_PI)) << 1) - from_axis);
    }
}

/* A quantity at a place in a stretch; the place is put to what the tick, rounding the angle, took. The axis is
 * twice itself, 2^32 to a turn, from `from_axis`. */
static float sample(const brace_planar_t *planar, int32_t row, quantity_t quantity, uint32_t from_axis, float *place)
{
    const float knee = brace_planar_stretch_rad(row, *place);
    const int32_t units = brace_mulh((int32_t)(knee * 0x1p28f), 1367130551);
    const int32_t off_centre = (int32_t)((uint32_t)(units - row * STRETCH_UNITS) << 3) >> 3;
    brace_stiffness_t k;
    *place = (float)off_centre * (2.0f / STRETCH_UNITS);
    (void)brace_planar_stiffness(planar, 0.5f * knee, knee, &k);
    return value_of(&k, quantity, from_axis);
}

/* The polynomial of degree n - 1 through n points: c holds its values there, then its factors c0, c1, ... */
static void through(int n, const float at[], float c[])
{
    for (int order = 1; order < n; order++) { /* divided differences */
        for (int i = n - 1; i >= order; i--) {
            c[i] = (c[i] - c[i - 1]) / (at[i] - at[i - order]);
        }
    }
    for (int from = n - 2; from >= 0; from--) { /* Newton's form into powers */
        for (int i = from; i < n - 1; i++) {
            c[i] -= at[from] * c[i + 1];
        }
    }
}

/* The polynomial of a quantity in a stretch, through n Chebyshev points. */
static void fit(const brace_planar_t *planar, int32_t row, quantity_t quantity, uint32_t from_axis, int n, float c[])
{
    static const float points[2][4] = {{-0.8660254f, 0.0f, 0.8660254f, 0.0f},
                                       {-0.9238795f, -0.3826834f, 0.3826834f, 0.9238795f}};
    float place[4];
    for (int i = 0; i < n; i++) {
        place[i] = points[n - 3][i];
        c[i] = sample(planar, row, quantity, from_axis, &place[i]);
    }
    through(n, place, c);
}

/* For a place given as q31. */
static void scale_to_q31(int n, float c[])
{
    float scale = 1.0f;
    for (int i = 0; i < n; i++) {
        c[i] *= scale;
        scale *= 0x1p-31f;
    }
}

/* False where the axis turns too fast to be told from noise. */
static int fill(const brace_planar_t *planar, int32_t index, brace_planar_table_row_t *row)
{
    float c[3], centre = 0.0f;
    const uint32_t middle = (uint32_t)(int32_t)sample(planar, index, TWICE_AXIS, 0u, &centre);
    fit(planar, index, LAMBDA_MIN, 0u, 3, row->lambda_min_n_per_mm);
    fit(planar, index, LEAST_COMPLIANCE, 0u, 4, row->least_compliance_mm_per_n);
    fit(planar, index, TWICE_AXIS, middle, 3, c);
    scale_to_q31(3, row->lambda_min_n_per_mm);
    scale_to_q31(4, row->least_compliance_mm_per_n);
    if (!(__builtin_fabsf(c[0]) < 0x1p29f && __builtin_fabsf(c[1]) < 0x1p29f && __builtin_fabsf(c[2]) < 0x1p28f)) {
        return 0;
    }
    const uint32_t c0 = middle + (uint32_t)(int32_t)c[0];
    row->axis_c0_c1 = (int64_t)((uint64_t)c0 << 32 | (uint32_t)(int32_t)(2.0f * c[1]));
    row->axis_c2 = (int32_t)(4.0f * c[2]);
    return 1;
}

brace_status_t brace_planar_table_build(const brace_planar_t *planar, brace_planar_table_t *table)
{
    if (planar == NULL || table == NULL) {
        return BRACE_E_NULL;
    }
    for (uint32_t i = 0; i < BRACE_PLANAR_TABLE_SINES; i++) {
        table->half_sine[i] = 0.5f * SHORTER * brace_direction(i << 21).z;
    }
    int good = 1;
    for (int32_t row = 0; good && row < BRACE_PLANAR_TABLE_ROWS; row++) {
        good = fill(planar, row, &table->row[row]) && brace_planar_stretch_agrees(planar, table, row);
    }
    return good ? BRACE_OK : BRACE_E_UNSUPPORTED;
}
