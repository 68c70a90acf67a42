/* The dictionary's entries, which may be read one by one or as a block over any wire. What is measured is all of the
 * newest snapshot. */
#ifndef BRACE_WIRE_MEASURED_H
#define BRACE_WIRE_MEASURED_H

#include "brace/measured.h"
#include "brace/requests.h"

/* Fills every value from the newest snapshot, so that nothing is mixed from two ticks. K is NaN while it is not
 * valid, as in the snapshot. What the drift check says of a cause is NaN or all ones while there is no cause.
 *   counters: of the controller and of its wires
 *   now_us: the HAL's clock, for the age
 * At most 330 instructions. */
void measured_take(const brace_app_t *app, const brace_app_counters_t *counters, uint32_t now_us,
                   brace_measured_t *measured);

/* The cause of a drift as `drift_cause` reports it. */
uint32_t measured_drift_cause(const brace_drift_report_t *report);

/* A value by its number in the dictionary (from BRACE_ENTRY_MEASURED on), as its 32 bits.
 * returns BRACE_OK, BRACE_E_RANGE: no such entry, value untouched */
brace_status_t measured_entry(const brace_measured_t *measured, uint32_t entry, uint32_t *value);

/* A parameter by its number on the wire (brace_parameter_index), as its 32 bits.
 * returns BRACE_OK, BRACE_E_RANGE: no such parameter, value untouched */
brace_status_t parameter_entry(const brace_parameters_t *parameters, uint32_t number, uint32_t *value);

/* A parameter by its place in the struct, and so in a block; index < BRACE_PARAMETER_COUNT. */
uint32_t parameter_member(const brace_parameters_t *parameters, uint32_t index);

#endif
