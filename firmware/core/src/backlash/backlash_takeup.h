/* The take-up's part of a tick. */
#ifndef BRACE_BACKLASH_TAKEUP_H
#define BRACE_BACKLASH_TAKEUP_H

#include "brace/backlash_types.h"

/* Moves command and phase on by a tick; proven: the flank that the load proves.
 * returns FACT_TAKING_UP while the flank is not yet verified, else FACT_NOT_TAKING_UP */
uint32_t backlash_takeup_advance(brace_backlash_t *joint, uint32_t facts, int proven);

/* The same while the take-up stands: nothing goes on. */
uint32_t backlash_takeup_stand(const brace_backlash_t *joint);

void backlash_takeup_report(const brace_backlash_t *joint, brace_backlash_out_t *out);

#endif
