/* What others ask of the node over CAN: one request a tick is taken and answered in it; the next waits in
 * the bus' own ring. A request is refused or answered, never left; what has a wrong length is none, and counted. */
#ifndef BRACE_APP_REQUESTS_H
#define BRACE_APP_REQUESTS_H

#include "brace/app.h"

/* Nothing waits, nothing is open. */
void requests_start(brace_app_t *app);

/* Looks through what has come, at most 4 frames a millisecond of the tick and a line of SLCAN, until one is a
 * request to this node. Before the tick's other work. At most 250 instructions; with SLCAN 700.
 * returns whether there is one, and room for its answer */
bool requests_take(brace_app_t *app);

/* While a commit or roll-back is to be answered: answers it once its end has come, before anything else may be stored.
 * At most 60 instructions. */
void requests_end_storing(brace_app_t *app);

/* Answers the request taken. At most 1,000 instructions; in CONFIGURATION 2,200. */
void requests_serve(brace_app_t *app);

/* What of the answers finds room on the bus. At most 60 instructions for each of four frames. */
void requests_send(brace_app_t *app);

#endif
