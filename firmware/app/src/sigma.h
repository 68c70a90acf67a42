/* What the controller's parts give the job that works out how exactly K is known (jobs/uncertainty). */
#ifndef BRACE_SIGMA_H
#define BRACE_SIGMA_H

#include "controller.h"

/* Begins a round with the inputs of the newest snapshot's K, if it is valid, in two steps: the inputs, then what they
 * would be at other loads of the joints. returns whether it has done one of them. At most 2,600 instructions. */
bool sigma_begin(controller_t *controller);

/* Writes into a snapshot, whose K is there, what is known of K's uncertainty: nothing where a sample is so old that its
 * joint may have moved further meanwhile than K's uncertainty covers. At most 650 instructions. */
void sigma_report(const controller_t *controller, brace_snapshot_t *snapshot);

#endif
