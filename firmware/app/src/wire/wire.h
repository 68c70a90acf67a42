/* What every wire is given in a tick, and what it counts. */
#ifndef BRACE_WIRE_WIRE_H
#define BRACE_WIRE_WIRE_H

#include <stdbool.h>
#include <stdint.h>

#include "brace/measured.h"
#include "brace_hal.h"
#include "brace/requests.h"

/* How much a port has done in a tick, counted in short answers. */
enum {
    WIRE_NOTHING = 0,
    WIRE_TAKEN = 1,          /* a request, answered or not */
    WIRE_DATA_ARE_TAKEN = 1, /* a snapshot for process data */
    WIRE_K_ANSWERED = 2,     /* to a request that has waited for it */
    WIRE_DATA_ARE_SET_UP = 3, /* their periods, for another set of parameters */
    WIRE_BURST_IS_SORTED = 8 /* far more at once than a line carries in a tick */
};

typedef struct {
    const brace_hal_t *hal;
    brace_app_t *app;                 /* whom to ask: brace/requests.h */
    brace_app_counters_t *counters;   /* where troubles of the wires are counted */
    const brace_measured_t *measured; /* all values of the newest snapshot that may be read; one for all wires */
    uint32_t now_us;
} wire_tick_t;

#endif
