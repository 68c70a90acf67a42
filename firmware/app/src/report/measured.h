/* The values that may be read one by one or as a block, over any bus: all of the newest snapshot. */
#ifndef BRACE_APP_MEASURED_H
#define BRACE_APP_MEASURED_H

#include "brace/app.h"
#include "brace/measured.h"

/* Fills all of it from the newest snapshot, so that nothing is mixed from two ticks. K and what follows from
 * it is NaN while it is not valid.
 *   now_us: the HAL's clock, for the age
 * About 350 instructions. */
void brace_measured_take(const brace_app_t *app, uint32_t now_us, brace_measured_t *measured);

/* A value of it by its number in the dictionary (BRACE_ENTRY_MEASURED on), as 32 bits.
 * returns BRACE_OK, BRACE_E_RANGE: no such entry, value untouched */
brace_status_t measured_entry(const brace_measured_t *measured, uint32_t entry, uint32_t *value);

#endif
