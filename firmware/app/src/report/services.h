/* What the controller does besides K, a bounded piece per tick. Services see the newest snapshot only: it
 * is the one source of what goes out. A bus protocol is one more call in services_run. */
#ifndef BRACE_APP_SERVICES_H
#define BRACE_APP_SERVICES_H

#include "brace/app.h"

/* At start; not for the tick. */
void services_start(brace_app_t *app);

/* What else a tick has to do. */
typedef enum {
    SERVICES_BESIDE_K = 0,    /* K of this tick */
    SERVICES_BESIDE_LITTLE,   /* no K is due */
    SERVICES_BESIDE_A_PIECE   /* a piece of work that may wait for a tick */
} services_room_t;

/* What has come, and what there is to say, before the tick's other work. A request over CAN is answered in the tick that
 * takes it; K is worked out beside it, and beside what is said. What does not go into one tick is told apart here: on limbs
 * of the general path K yields to Modbus, and to an answer beside which something else is due; a piece of work yields to
 * any answer. That happens in no two ticks in a row: the second time it is Modbus, and what there is to say, that waits.
 * returns whether the tick is lean: K, or the piece, is left out */
bool services_listen(brace_app_t *app, services_room_t room);

/* After the tick's snapshot is sealed. At most 1,300 instructions; in a lean tick 2,000.
 *   lean: as services_listen said */
void services_run(brace_app_t *app, bool lean);

#endif
