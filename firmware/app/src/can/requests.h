/* What others ask of the node over CAN: one request taken and answered per tick, and not two ticks in a row
 * while K is computed, since a tick that answers computes none (the snapshot before stays, its age tells).
 * The next request waits in the bus' own ring. K at a tip's place takes two such ticks where the limb takes
 * the general path. A request is refused or answered, never left; what has a wrong length is none, and
 * counted. */
#ifndef BRACE_APP_REQUESTS_H
#define BRACE_APP_REQUESTS_H

#include "brace/app.h"

/* Nothing waits, nothing is open. */
void requests_start(brace_app_t *app);

/* Looks through what has come, at most 4 frames a millisecond of the tick, until one is a request to this
 * node. Before the tick's other work. At most 350 instructions.
 *   may_serve: this tick has room for an answer
 *   brief: there is other work; one frame only
 * returns whether one will be answered in this tick */
bool requests_take(brace_app_t *app, bool may_serve, bool brief);

/* Answers the request taken. At most 2,200 instructions; a commit, in CONFIGURATION only, 21,000. */
void requests_serve(brace_app_t *app);

/* The answer to a commit or roll-back whose end has come, and what of the answers finds room on the bus. At
 * most 60 instructions and 60 for each of four frames. */
void requests_send(brace_app_t *app);

#endif
