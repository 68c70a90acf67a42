/* The bench's job for K in space under a load, its turning and its buckling factor. */
#include <stdlib.h>

#include "bench_data.h"
#include "brace/loaded_space.h"
#include "job.h"
#include "loaded_case.h"

static const float postures[BENCH_ALL_COUNT][3] = BENCH_ALL;
static const brace_limb_t limb = BENCH_LIMB;
static brace_loaded_space_t loaded;

const int job_runs = BENCH_ALL_COUNT;
const int job_out_count = 10;

void job_setup(void)
{
    static const brace_gravity_t weights = {.femur_n = BENCH_FEMUR_N, .knee_n = BENCH_KNEE_N, .tibia_n = BENCH_TIBIA_N};
    brace_loaded_space_collapse(&limb, &weights, &loaded);
}

static brace_loaded_joint_t joint_of(int index)
{
    const float yields = limb.joint[index].compliance_rad_per_n_mm;
    return (brace_loaded_joint_t){yields, yields};
}

/* The load is given in the limb's plane's frame, K and displacement are put out in it. */
void job_run(int index, float *out)
{
    float force_n[2];
    load_of(index, force_n);
    const brace_space_load_t load = {.tip_n = {force_n[0], sideways_of(index), force_n[1]},
                                     .down = {0.0f, 0.0f, -1.0f},
                                     .yaw = joint_of(BRACE_COXA),
                                     .hip = joint_of(BRACE_FEMUR),
                                     .knee = joint_of(BRACE_TIBIA)};
    brace_space_result_t result;
    brace_stiffness_spatial_t turned;
    const float *angles = postures[index];
    brace_space_rest_t rest;
    if (brace_loaded_space_settle(&loaded, angles[1], angles[2], &load, &rest) != BRACE_OK ||
        brace_loaded_space_stiffness(&loaded, &rest, &result) != BRACE_OK ||
        brace_loaded_space_turn(angles[0], &result.k, &turned) != BRACE_OK) {
        exit(1);
    }
    const float factor = brace_loaded_space_buckling_factor(&loaded, &rest);
    const float numbers[10] = {result.k.xx_n_per_mm,     result.k.xy_n_per_mm,
                               result.k.xz_n_per_mm,     result.k.yy_n_per_mm,
                               result.k.yz_n_per_mm,     result.k.zz_n_per_mm,
                               result.displacement_mm.x, result.displacement_mm.y,
                               result.displacement_mm.z, factor};
    for (int i = 0; i < 10; i++) {
        out[i] = numbers[i];
    }
}
