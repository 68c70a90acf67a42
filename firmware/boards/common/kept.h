/* What a reset leaves alone: why the processor started, and what its last crash was.
 *
 * Lives in RAM that no start-up code clears, behind a magic number and a checksum, so that memory which has just
 * been powered is told from memory that was written. Written by fault handlers: no library, no floating point,
 * bounded.
 */
#ifndef BRACE_BOARDS_KEPT_H
#define BRACE_BOARDS_KEPT_H

#include "brace_hal.h"

/* Once, early in start-up: tells power-on (nothing sound is kept; forgets all) from a reset. */
void kept_start(void);

/* The last reset left nothing sound behind: power was off. */
bool kept_is_cold(void);

/* Why this start; a reset that nobody announced is the pin's. The context is not used. */
brace_reset_cause_t kept_reset_cause(void *context);

/* Announces the reset to come. */
void kept_announce(brace_reset_cause_t cause);

/* Keeps a record; its count is filled in. */
void kept_crash_store(const brace_crash_record_t *record);

/* As brace_hal.h's crash_read and crash_clear. The context is not used. */
int32_t kept_crash_read(void *context, brace_crash_record_t *record);
void kept_crash_clear(void *context);

/* As brace_hal.h's restart: announces and resets. */
void kept_restart(void *context);

#endif
