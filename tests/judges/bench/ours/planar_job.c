/* The bench's job for brace_planar_stiffness. */
#include <stdlib.h>

#include "bench_data.h"
#include "brace/planar.h"
#include "job.h"
#include "result.h"

static const float postures[BENCH_ALL_COUNT][3] = BENCH_ALL;
static brace_planar_t planar;

const int job_runs = BENCH_ALL_COUNT;
const int job_out_count = 6;

void job_setup(void)
{
    static const brace_limb_t limb = BENCH_LIMB;
    if (brace_planar_collapse(&limb, &planar) != BRACE_OK) {
        exit(1);
    }
}

void job_run(int index, float *out)
{
    brace_stiffness_t stiffness;
    if (brace_planar_stiffness(&planar, postures[index][1], postures[index][2], &stiffness) != BRACE_OK) {
        exit(1);
    }
    put_result(&stiffness, out);
}
