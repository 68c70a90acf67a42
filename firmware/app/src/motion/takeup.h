/* Taking up the play of both joints: one after the other, held, and let go in the reverse order. */
#ifndef BRACE_APP_TAKEUP_H
#define BRACE_APP_TAKEUP_H

#include "brace/app.h"

brace_status_t takeup_request(brace_app_t *app, int32_t joint_index, int32_t flank);

/* Begins to let every joint go. */
void takeup_let_go(brace_app_t *app);

/* After the joints' state machines: one that failed takes the others with it, one that is back makes room
 * for the next. */
void takeup_advance(brace_app_t *app, const brace_snapshot_t *snapshot);

/* Is any joint taken up, being taken up or let go? */
bool takeup_active(const brace_app_t *app);

/* Has every joint that was asked taken its flank? */
bool takeup_holds(const brace_app_t *app);

#endif
