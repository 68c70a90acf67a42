/* A planar result as the bench's six numbers. */
#ifndef BENCH_RESULT_H
#define BENCH_RESULT_H

#include "brace/stiffness.h"

static inline void put_result(const brace_stiffness_t *k, float *out)
{
    out[0] = k->k_xx_n_per_mm;
    out[1] = k->k_xz_n_per_mm;
    out[2] = k->k_zz_n_per_mm;
    out[3] = k->lambda_min_n_per_mm;
    out[4] = k->lambda_max_n_per_mm;
    out[5] = k->stiff_axis_rad;
}

#endif
