#include <stddef.h>

#include "brace/planar_table.h"
#include "trig.h"
#include "turn.h"

#define RAD_PER_UNIT (2.0f * BRACE_PI / 0x1p29f) /* 2^29 units to a turn, as the ticks have it */
#define STRETCH_UNITS 0x200000

/* To first order from its nearest entry a vector is longer by up to d^2/2; entries are shorter by half of that. */
#define SHORTER (1.0f - 6e-7f)

/* How far the table may be off the tick: K and eigenvalues relative. The table's error is this and the tick's. */
#define AGREEMENT 1.2e-6f

/* What the tick says at a knee angle, seen from the bisector. */
typedef struct {
    float place; /* in the stretch, [-1, 1] */
    float lambda_min, least_compliance;
    uint32_t twice_axis; /* 2^32 to a turn */
} sample_t;

/* The knee angle nearest to a place in a stretch, in [-pi, pi]. */
static float knee_rad(int32_t row, float place)
{
    const int32_t stretch = row < BRACE_PLANAR_TABLE_ROWS / 2 ? row : row - BRACE_PLANAR_TABLE_ROWS;
    return ((float)stretch + 0.5f * place) * (RAD_PER_UNIT * STRETCH_UNITS);
}

static sample_t sample(const brace_planar_t *planar, int32_t row, float place)
{
    const float knee = knee_rad(row, place);
    const int32_t units = brace_mulh((int32_t)(knee * 0x1p28f), 1367130551); /* as the ticks round it */
    const int32_t off_centre = (int32_t)((uint32_t)(units - row * STRETCH_UNITS) << 3) >> 3;
    brace_stiffness_t k;
    (void)brace_planar_stiffness(planar, 0.5f * knee, knee, &k);
    return (sample_t){(float)off_centre * (2.0f / STRETCH_UNITS), k.lambda_min_n_per_mm, 1.0f / k.lambda_max_n_per_mm,
                      (uint32_t)(int32_t)(k.stiff_axis_rad * (0x1p31f / BRACE_PI)) << 1};
}

/* The polynomial of degree n - 1 through n points, n <= 4, as c0, c1, ... */
static void through(int n, const float at[], const float value[], float c[])
{
    for (int i = 0; i < n; i++) {
        c[i] = value[i];
    }
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

static void scale_to_q31(int n, float c[])
{
    float scale = 1.0f;
    for (int i = 0; i < n; i++) {
        c[i] *= scale;
        scale *= 0x1p-31f;
    }
}

/* Through Chebyshev points; false where the axis turns too fast to be told from noise. */
static int fill(const brace_planar_t *planar, int32_t index, brace_planar_table_row_t *row)
{
    static const float of_three[3] = {-0.8660254f, 0.0f, 0.8660254f};
    static const float of_four[4] = {-0.9238795f, -0.3826834f, 0.3826834f, 0.9238795f};
    float place[4], low[3], axis[3], least[4], c[3];
    const uint32_t middle = sample(planar, index, 0.0f).twice_axis;
    for (int i = 0; i < 3; i++) {
        const sample_t at = sample(planar, index, of_three[i]);
        place[i] = at.place;
        low[i] = at.lambda_min;
        axis[i] = (float)(int32_t)(at.twice_axis - middle);
    }
    through(3, place, low, row->lambda_min_n_per_mm);
    through(3, place, axis, c);
    for (int i = 0; i < 4; i++) {
        const sample_t at = sample(planar, index, of_four[i]);
        place[i] = at.place;
        least[i] = at.least_compliance;
    }
    through(4, place, least, row->least_compliance_mm_per_n);
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

static int close(float a, float b, float within)
{
    return __builtin_fabsf(a - b) <= AGREEMENT * within;
}

static int agrees(const brace_planar_t *planar, const brace_planar_table_t *table, float knee)
{
    brace_stiffness_t k, t;
    (void)brace_planar_stiffness(planar, 0.5f * knee, knee, &k);
    (void)brace_planar_table_stiffness(table, 0.5f * knee, knee, &t);
    return close(k.lambda_min_n_per_mm, t.lambda_min_n_per_mm, k.lambda_min_n_per_mm) &&
           close(k.lambda_max_n_per_mm, t.lambda_max_n_per_mm, k.lambda_max_n_per_mm) &&
           close(k.k_xx_n_per_mm, t.k_xx_n_per_mm, k.lambda_max_n_per_mm) &&
           close(k.k_xz_n_per_mm, t.k_xz_n_per_mm, k.lambda_max_n_per_mm);
}

brace_status_t brace_planar_table_build(const brace_planar_t *planar, brace_planar_table_t *table)
{
    static const float check[4] = {-0.98f, -0.5f, 0.5f, 0.98f};
    if (planar == NULL || table == NULL) {
        return BRACE_E_NULL;
    }
    for (uint32_t i = 0; i < BRACE_PLANAR_TABLE_SINES; i++) {
        table->half_sine[i] = 0.5f * SHORTER * brace_direction(i << 21).z;
    }
    int good = 1;
    for (int32_t row = 0; good && row < BRACE_PLANAR_TABLE_ROWS; row++) {
        good = fill(planar, row, &table->row[row]);
        for (int i = 0; good && i < 4; i++) {
            good = agrees(planar, table, knee_rad(row, check[i]));
        }
    }
    return good ? BRACE_OK : BRACE_E_UNSUPPORTED;
}
