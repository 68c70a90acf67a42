#include "table/planar_stretch.h"

/* How far the table may be off the tick: K and eigenvalues relative. The table's error is this and the tick's. */
#define AGREEMENT 1.2e-6f

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

int brace_planar_stretch_agrees(const brace_planar_t *planar, const brace_planar_table_t *table, int32_t row)
{
    static const float place[4] = {-0.98f, -0.5f, 0.5f, 0.98f};
    int good = 1;
    for (int i = 0; good && i < 4; i++) {
        good = agrees(planar, table, brace_planar_stretch_rad(row, place[i]));
    }
    return good;
}
