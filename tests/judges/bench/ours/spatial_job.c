/* The bench's job for brace_spatial_stiffness. */
#include <stdlib.h>

#include "bench_data.h"
#include "brace/spatial.h"
#include "job.h"

static const float postures[BENCH_ALL_COUNT][3] = BENCH_ALL;
static brace_spatial_t spatial;

const int job_runs = BENCH_ALL_COUNT;
const int job_out_count = 12;

void job_setup(void)
{
    static const brace_limb_t limb = BENCH_LIMB;
    if (brace_spatial_collapse(&limb, &spatial) != BRACE_OK) {
        exit(1);
    }
}

void job_run(int index, float *out)
{
    brace_stiffness_spatial_t k;
    if (brace_spatial_stiffness(&spatial, postures[index][0], postures[index][1], postures[index][2], &k) != BRACE_OK) {
        exit(1);
    }
    const float numbers[12] = {k.k_xx_n_per_mm,      k.k_xy_n_per_mm, k.k_xz_n_per_mm,      k.k_yy_n_per_mm,
                               k.k_yz_n_per_mm,      k.k_zz_n_per_mm, k.lambda_n_per_mm[0], k.lambda_n_per_mm[1],
                               k.lambda_n_per_mm[2], k.stiff_axis[0], k.stiff_axis[1],      k.stiff_axis[2]};
    for (int i = 0; i < 12; i++) {
        out[i] = numbers[i];
    }
}
