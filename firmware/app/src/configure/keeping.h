/* What the drift check knows of the limb, over restarts: brace/journal.h, in the slot of the parameters in force.
 *
 * A record is written after a loading test or a cleared alarm, when the check's state has changed, when its evidence
 * has moved by KEEPING_EVIDENCE either way, or after 512 readings while it learns, 4,096 while it watches. Evidence
 * that fell is kept as well: a start that found it high again and again would be an alarm in the end. */
#ifndef BRACE_APP_KEEPING_H
#define BRACE_APP_KEEPING_H

#include "brace/app.h"

/* The set in force has changed, and the check has begun to learn: what is known of that set's limb is looked for.
 *   erased: its slot has just been written, so there is nothing */
void keeping_open(brace_app_t *app, bool erased);

/* One piece of that, at most 1,000 instructions; false once it is done. */
bool keeping_scan(brace_app_t *app);

/* The check has learned something, or was told to forget. */
void keeping_look(brace_app_t *app);

/* While there is anything to do (keeping.look): is this tick for a piece of it? One in eight, in MONITOR and FAULT. */
bool keeping_due(brace_app_t *app);

/* The piece: at most 900 instructions and two calls to the memory, in a tick that computes no K. */
void keeping_piece(brace_app_t *app);

#endif
