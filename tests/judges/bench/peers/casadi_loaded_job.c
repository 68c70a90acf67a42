/* The bench's job for CasADi's generated K under a load. */
#include "bench_data.h"
#include "job.h"
#include "loaded_case.h"

#ifndef casadi_int
#define casadi_int long long int
#endif

int casadi_loaded(const float **arg, float **res, casadi_int *iw, float *w, int mem);

static const float postures[BENCH_ALL_COUNT][3] = BENCH_ALL;
static const brace_limb_t limb = BENCH_LIMB;
static float parameters[18];

const int job_runs = BENCH_ALL_COUNT;
const int job_out_count = 9;

void job_setup(void)
{
    const float length[2] = {limb.femur_mm, limb.tibia_mm};
    for (int i = 0; i < 2; i++) {
        const brace_link_t *link = &limb.link[BRACE_FEMUR + i];
        const float p[5] = {length[i], link->axial_mm_per_n, link->bending_mm_per_n, link->moment_transfer,
                            link->tilt_rad};
        for (int j = 0; j < 5; j++) {
            parameters[5 * i + j] = p[j];
        }
    }
    const float rest[8] = {limb.joint[BRACE_FEMUR].compliance_rad_per_n_mm,
                           limb.joint[BRACE_TIBIA].compliance_rad_per_n_mm,
                           limb.base.x_mm_per_n,
                           limb.base.z_mm_per_n,
                           limb.base.rotation_rad_per_n_mm,
                           BENCH_FEMUR_N,
                           BENCH_KNEE_N,
                           BENCH_TIBIA_N};
    for (int j = 0; j < 8; j++) {
        parameters[10 + j] = rest[j];
    }
}

void job_run(int index, float *out)
{
    float force[2];
    load_of(index, force);
    const float *arg[4] = {&postures[index][1], &postures[index][2], force, parameters};
    float *res[1] = {out};
    casadi_loaded(arg, res, 0, 0, 0);
}
