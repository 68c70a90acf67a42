/* The drift check over a record, for drift_record.py; not part of the product. */
#include <stddef.h>
#include <stdint.h>

#include "brace/chain.h"
#include "brace/drift.h"

/* Row by row; each row is one brace_drift_reading_t, its posture's K from the general path. run[]: where it changes, a
 * new run begins. reports (may be null): one per row. Stops at the first alarm when asked to. Returns the rows taken
 * in, or a negative status. */
long drift_watch(brace_drift_t *drift, const brace_limb_t *limb, size_t count, const brace_drift_reading_t *row,
                 const int32_t *run, int stop, brace_drift_report_t *reports)
{
    brace_chain_t chain;
    brace_stiffness_t stiffness = {0};
    brace_status_t status = brace_chain_build(limb, &chain);
    for (size_t i = 0; status == BRACE_OK && i < count; i++) {
        if (i == 0 || row[i].theta1_rad != row[i - 1].theta1_rad || row[i].theta2_rad != row[i - 1].theta2_rad) {
            status = brace_chain_stiffness(&chain, row[i].theta1_rad, row[i].theta2_rad, &stiffness);
        }
        if (status == BRACE_OK && (i == 0 || run[i] != run[i - 1])) {
            status = brace_drift_run(drift);
        }
        if (status == BRACE_OK) {
            status = brace_drift_step(drift, limb, &stiffness, &row[i]);
        }
        if (status == BRACE_OK && reports != NULL) {
            status = brace_drift_report(drift, limb, &reports[i]);
        }
        if (status == BRACE_OK && stop && drift->state == BRACE_DRIFT_DRIFTED) {
            return (long)i + 1;
        }
    }
    return status == BRACE_OK ? (long)count : status;
}

/* The outlook of a reading like this one, with the posture's K from the general path. */
int drift_outlook_at(const brace_drift_t *drift, const brace_limb_t *limb, const brace_drift_reading_t *reading,
                     brace_drift_outlook_t *outlook)
{
    brace_chain_t chain;
    brace_stiffness_t stiffness;
    brace_status_t status = brace_chain_build(limb, &chain);
    if (status == BRACE_OK) {
        status = brace_chain_stiffness(&chain, reading->theta1_rad, reading->theta2_rad, &stiffness);
    }
    return status == BRACE_OK ? brace_drift_outlook(drift, limb, &stiffness, reading, outlook) : status;
}
