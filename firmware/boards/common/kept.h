/* Memory that a reset leaves alone: why the processor started, and its last crash.
 *
 * It lies in RAM that no start-up code clears, behind a magic number and a checksum. These show whether the memory was
 * written or has just been powered. Fault handlers write it, so it uses no library and no floating point, and every
 * call is bounded.
 */
#ifndef BRACE_BOARDS_KEPT_H
#define BRACE_BOARDS_KEPT_H

#include "brace_hal.h"

/* Call once, early in start-up. Finds out whether this is power-on (nothing sound is kept; it forgets all) or a
 * reset. */
void kept_start(void);

/* True if the last reset left nothing sound: power was off. */
bool kept_is_cold(void);

/* Why the processor started. A reset that nobody announced came from the pin. The context is not used. */
brace_reset_cause_t kept_reset_cause(void *context);

/* Stores the cause of the reset that will follow. */
void kept_announce(brace_reset_cause_t cause);

/* Stores a crash record, and fills in its count. */
void kept_crash_store(const brace_crash_record_t *record);

/* As brace_hal.h's crash_read and crash_clear. The context is not used. */
int32_t kept_crash_read(void *context, brace_crash_record_t *record);
void kept_crash_clear(void *context);

/* As brace_hal.h's restart: announces the reset and resets. */
void kept_restart(void *context);

#endif
