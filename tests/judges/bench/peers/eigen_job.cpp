// The bench's job for Eigen, planar, or spatial with -DBENCH_SPATIAL.
#include "bench_data.h"
extern "C" {
#include "job.h"
}
#include "peer_eigen.hpp"
#include "plain_limb.h"

namespace {
const float postures[BENCH_POSTURE_COUNT][3] = BENCH_POSTURES;
plain_limb_t limb;
} // namespace

extern "C" {
extern const int job_runs = BENCH_POSTURE_COUNT;

void job_setup(void)
{
    plain_limb_from_bench(&limb);
}

#ifdef BENCH_SPATIAL
extern const int job_out_count = 12;

void job_run(int index, float *out)
{
    plain_spatial_t result;
    eigen_spatial_stiffness(limb, postures[index][0], postures[index][1], postures[index][2], result);
    const float numbers[12] = {result.k[0][0],   result.k[0][1],       result.k[0][2],       result.k[1][1],
                               result.k[1][2],   result.k[2][2],       result.lambda[0],     result.lambda[1],
                               result.lambda[2], result.stiff_axis[0], result.stiff_axis[1], result.stiff_axis[2]};
    for (int i = 0; i < 12; i++) {
        out[i] = numbers[i];
    }
}
#else
extern const int job_out_count = 6;

void job_run(int index, float *out)
{
    plain_stiffness_t result;
    eigen_stiffness(limb, postures[index][1], postures[index][2], result);
    out[0] = result.k_xx;
    out[1] = result.k_xz;
    out[2] = result.k_zz;
    out[3] = result.lambda_min;
    out[4] = result.lambda_max;
    out[5] = result.stiff_axis;
}
#endif
}
