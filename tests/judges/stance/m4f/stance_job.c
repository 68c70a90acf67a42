/* A job of the harness of the bench: statics of a body on six limbs, from no load to weight and payload in one step. */
#include "brace/stance.h"
#include "job.h"
#include "stances.h"

const int job_runs = STANCES;
const int job_out_count = 6; /* contacts of the feet: each says how the run went */

static const brace_stance_t stances[STANCES] = {STANCE_ROWS};
static const double offsets_mm[STANCES][18] = {OFFSET_ROWS};
static brace_stance_state_t state;
static brace_stance_load_t load;

void job_setup(void)
{
    brace_stance_load_add(&load, (double[3]){0.0, 0.0, -30.0}, (double[3]){0.0, 0.0, 0.0});
    brace_stance_load_add(&load, (double[3]){3.0, 0.0, -5.0}, (double[3]){30.0, 0.0, 0.0});
}

void job_run(int index, float *out)
{
    int32_t status = brace_stance_place(&stances[index], offsets_mm[index], &state);
    if (status == BRACE_STANCE_OK) {
        status = brace_stance_settle(&stances[index], &load, 1, &state, 0);
    }
    for (int i = 0; i < job_out_count; i++) {
        out[i] = status == BRACE_STANCE_OK ? (float)state.foot[i].contact : (float)status;
    }
}
