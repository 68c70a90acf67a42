/* The bench's job for brace_drift_step and brace_drift_report: loading runs at changing postures, learning first,
 * then watching; a tibia that goes soft ends it. Its number is the check's state. */
#include <stdlib.h>

#include "bench_data.h"
#include "brace/drift.h"
#include "brace/planar.h"
#include "job.h"

enum { READINGS = BENCH_ALL_COUNT, RUN = 16 };

static const float postures[BENCH_ALL_COUNT][3] = BENCH_ALL;
static const brace_limb_t limb = BENCH_LIMB;
static brace_planar_t planar;
static brace_drift_t drift;
static uint32_t random_state = 1;

const int job_runs = READINGS;
const int job_out_count = 1;

static float noise(void)
{
    random_state = random_state * 1664525u + 1013904223u;
    return (float)(int32_t)random_state * 0x1p-31f;
}

void job_setup(void)
{
    const brace_drift_setup_t setup = {0.1f, 0.001f, 0.02f, 0.2f};
    if (brace_planar_collapse(&limb, &planar) != BRACE_OK || brace_drift_learn(&drift, &limb, &setup) != BRACE_OK) {
        exit(1);
    }
}

void job_run(int index, float *out)
{
    brace_stiffness_t k;
    const float *posture = postures[index / RUN];
    if (brace_planar_stiffness(&planar, posture[1], posture[2], &k) != BRACE_OK) {
        exit(1);
    }
    const float scale = index > READINGS / 4 * 3 ? 0.9f : 1.0f, d = 0.635f * (float)(index % RUN - RUN / 2);
    const brace_drift_reading_t reading = {posture[1],
                                           posture[2],
                                           d,
                                           0.1f * d,
                                           scale * d * (k.k_xx_n_per_mm + 0.1f * k.k_xz_n_per_mm) + 0.2f * noise(),
                                           scale * d * (k.k_xz_n_per_mm + 0.1f * k.k_zz_n_per_mm) + 0.2f * noise(),
                                           10.0f * noise()};
    if (brace_drift_step(&drift, &limb, &k, &reading) != BRACE_OK) {
        exit(1);
    }
    if (index == READINGS / 4) {
        drift.state = BRACE_DRIFT_WATCHING;
    }
    brace_drift_report_t report;
    if (brace_drift_report(&drift, &limb, &report) != BRACE_OK) {
        exit(1);
    }
    out[0] = (float)report.state;
}
