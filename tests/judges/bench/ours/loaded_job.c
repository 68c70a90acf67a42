/* The bench's job for brace_loaded_stiffness, and with BENCH_FIXED for brace_loaded_fixed_stiffness. */
#include <stdlib.h>

#include "bench_data.h"
#include "brace/loaded_fixed.h"
#include "job.h"
#include "loaded_case.h"
#include "result.h"

static const float postures[BENCH_ALL_COUNT][3] = BENCH_ALL;
static const brace_limb_t limb = BENCH_LIMB;
#ifdef BENCH_FIXED
#define STIFFNESS brace_loaded_fixed_stiffness
static brace_loaded_fixed_t collapsed;
#else
#define STIFFNESS brace_loaded_stiffness
static brace_loaded_t collapsed;
#endif

const int job_runs = BENCH_ALL_COUNT;
const int job_out_count = 9;

void job_setup(void)
{
    static const brace_gravity_t weights = {.femur_n = BENCH_FEMUR_N, .knee_n = BENCH_KNEE_N, .tibia_n = BENCH_TIBIA_N};
#ifdef BENCH_FIXED
    brace_loaded_t loaded;
    brace_loaded_collapse(&limb, &weights, &loaded);
    brace_loaded_fixed_collapse(&loaded, &collapsed);
#else
    brace_loaded_collapse(&limb, &weights, &collapsed);
#endif
}

void job_run(int index, float *out)
{
    const float hip = limb.joint[BRACE_FEMUR].compliance_rad_per_n_mm;
    const float knee = limb.joint[BRACE_TIBIA].compliance_rad_per_n_mm;
    float force_n[2];
    load_of(index, force_n);
    const brace_load_t load = {
        .tip = {force_n[0], force_n[1]}, .down = {0.0f, -1.0f}, .hip = {hip, hip}, .knee = {knee, knee}};
    brace_loaded_stiffness_t k;
    if (STIFFNESS(&collapsed, postures[index][1], postures[index][2], &load, &k) != BRACE_OK) {
        exit(1);
    }
    put_result(&k.stiffness, out);
    out[6] = k.displacement.x_mm;
    out[7] = k.displacement.z_mm;
    out[8] = k.buckling_factor;
}
