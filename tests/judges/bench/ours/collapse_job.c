/* The bench's job for brace_planar_collapse: one limb after the other; its number is the status. */
#include <stdlib.h>

#include "bench_data.h"
#include "brace/planar.h"
#include "job.h"

static const brace_limb_t limbs[BENCH_LIMB_COUNT] = BENCH_LIMBS;

const int job_runs = BENCH_LIMB_COUNT;
const int job_out_count = 1;

void job_setup(void) {}

void job_run(int index, float *out)
{
    static brace_planar_t planar;
    const brace_status_t status = brace_planar_collapse(&limbs[index], &planar);
    if (status != BRACE_OK && status != BRACE_E_UNSUPPORTED) {
        exit(1);
    }
    out[0] = (float)status;
}
