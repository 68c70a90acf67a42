/* The set of parameters that is being written, member by member, over any bus: begun as a copy of the set in force,
 * in force itself only once it is committed. Forgotten when CONFIGURATION is entered anew. */
#ifndef BRACE_APP_STAGING_H
#define BRACE_APP_STAGING_H

#include "brace/app.h"

/* A member as its 32 bits: staged if any has been written, else in force. index < BRACE_PARAMETER_COUNT */
uint32_t staging_read(const brace_app_t *app, uint32_t index);

/* Somebody is at it: CONFIGURATION lasts BRACE_CONFIGURATION_PATIENCE_US from here. */
void staging_keep(brace_app_t *app);

/* Leaves CONFIGURATION when nobody has been at it for that long. Each tick of it. */
void staging_watch(brace_app_t *app);

/* May members be written now? That somebody asks keeps CONFIGURATION going. returns BRACE_OK, BRACE_E_MODE (not
 * CONFIGURATION), BRACE_E_UNSUPPORTED (a set is being stored) */
brace_status_t staging_open(brace_app_t *app);

/* Writes one. returns as staging_open; BRACE_E_RANGE (no such member), BRACE_E_PARAMETER, BRACE_E_NOT_FINITE (not in
 * its own range; what members say together is judged by the commit). At most 450 instructions, the first time;
 * else 60. */
brace_status_t staging_write(brace_app_t *app, uint32_t index, uint32_t word);

/* Stores what has been written. What members say together is judged at once, the rest as it was written.
 *   wrong_index (out, may be null): as brace_parameters_check
 * returns as staging_open; BRACE_E_PARAMETER, BRACE_E_NOT_FINITE. At most 2,000 instructions. */
brace_status_t staging_commit(brace_app_t *app, uint32_t *wrong_index);

#endif
