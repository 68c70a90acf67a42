/* Faults with their hysteresis, and the mode that follows from them. */
#ifndef BRACE_APP_SUPERVISOR_H
#define BRACE_APP_SUPERVISOR_H

#include "brace/app.h"

/* The faults of this tick, from what the tick found. late: it came more than two periods late. */
void supervisor_faults(brace_app_t *app, bool late);

/* The same of a tick that looks at nothing else. */
void supervisor_late(brace_app_t *app, bool late);

/* The mode that follows: from START and FAULT to MONITOR, from anywhere to FAULT, back from what has ended. */
void supervisor_mode(brace_app_t *app);

/* Sets a fault that only a request clears. */
void supervisor_latch(brace_app_t *app, uint32_t fault);

#endif
