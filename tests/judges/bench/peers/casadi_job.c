/* The bench's job for CasADi's generated function, planar, or spatial with -DBENCH_SPATIAL. */
#include "bench_data.h"
#include "job.h"
#include "plain.h"
#include "plain_limb.h"

#ifndef casadi_int
#define casadi_int long long int
#endif

int casadi_planar(const float **arg, float **res, casadi_int *iw, float *w, int mem);
int casadi_spatial(const float **arg, float **res, casadi_int *iw, float *w, int mem);

static const float postures[BENCH_POSTURE_COUNT][3] = BENCH_POSTURES;
static float parameters[20];

const int job_runs = BENCH_POSTURE_COUNT;

void job_setup(void)
{
    plain_limb_t limb;
    plain_limb_from_bench(&limb);
#ifdef BENCH_SPATIAL
    const plain_link_t *link[2] = {&limb.coxa, &limb.femur};
    for (int i = 0; i < 2; i++) {
        const float p[6] = {link[i]->length,  link[i]->axial,   link[i]->bending,
                            link[i]->lateral, link[i]->torsion, link[i]->moment_transfer};
        for (int j = 0; j < 6; j++) {
            parameters[6 * i + j] = p[j];
        }
    }
    const float rest[8] = {limb.tibia.length,  limb.tibia.axial, limb.tibia.bending, limb.tibia.lateral,
                           limb.tibia.torsion, limb.joint[0],    limb.joint[1],      limb.joint[2]};
    for (int j = 0; j < 8; j++) {
        parameters[12 + j] = rest[j];
    }
#else
    const float p[9] = {
        limb.femur.length, limb.tibia.length,  limb.femur.axial, limb.femur.bending, limb.femur.moment_transfer,
        limb.tibia.axial,  limb.tibia.bending, limb.joint[1],    limb.joint[2]};
    for (int j = 0; j < 9; j++) {
        parameters[j] = p[j];
    }
#endif
}

#ifdef BENCH_SPATIAL
const int job_out_count = 12;

void job_run(int index, float *out)
{
    const float *arg[4] = {&postures[index][0], &postures[index][1], &postures[index][2], parameters};
    float *res[1] = {out};
    casadi_spatial(arg, res, 0, 0, 0);
}
#else
const int job_out_count = 6;

void job_run(int index, float *out)
{
    const float *arg[3] = {&postures[index][1], &postures[index][2], parameters};
    float *res[1] = {out};
    casadi_planar(arg, res, 0, 0, 0);
}
#endif
