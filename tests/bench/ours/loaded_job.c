/* The bench's job for brace_loaded_stiffness: a beam limb with its weight, and loads that differ by posture. */
#include <stdlib.h>

#include "bench_data.h"
#include "brace/loaded.h"
#include "job.h"

static const float postures[BENCH_ALL_COUNT][3] = BENCH_ALL;
static brace_limb_t limb = BENCH_LIMB;
static brace_loaded_t loaded;

const int job_runs = BENCH_ALL_COUNT;
const int job_out_count = 6;

void job_setup(void)
{
    static const brace_weights_t weights = {2.0f, 1.0f, 1.5f};
#ifdef BENCH_BEAMS
    limb.link[BRACE_FEMUR].moment_transfer_ratio = limb.link[BRACE_TIBIA].moment_transfer_ratio = 1.0f;
#endif
    brace_loaded_collapse(&limb, &weights, &loaded);
}

void job_run(int index, float *out)
{
    const float hip = limb.joint[BRACE_FEMUR].compliance_rad_per_n_mm;
    const float knee = limb.joint[BRACE_TIBIA].compliance_rad_per_n_mm;
    const brace_load_t load = {.tip = {(float)(index % 7) - 3.0f, (float)(index % 11) - 4.0f},
                               .down = {0.0f, -1.0f}, .hip = {hip, hip}, .knee = {knee, knee}};
    brace_loaded_stiffness_t k = {0};
    if (brace_loaded_stiffness(&loaded, postures[index][1], postures[index][2], &load, &k) != BRACE_OK) {
        k.buckling_factor = -1.0f;
    }
    out[0] = k.stiffness.k_xx_n_per_mm;
    out[1] = k.stiffness.k_xz_n_per_mm;
    out[2] = k.stiffness.k_zz_n_per_mm;
    out[3] = k.displacement.x_mm;
    out[4] = k.displacement.z_mm;
    out[5] = k.buckling_factor;
}
