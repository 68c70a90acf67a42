/* What the controller does besides K, a bounded piece per tick. Services see the newest snapshot only: it
 * is the one source of what goes out. A bus protocol is one more call in services_run. */
#ifndef BRACE_APP_SERVICES_H
#define BRACE_APP_SERVICES_H

#include "brace/app.h"

/* At start; not for the tick. */
void services_start(brace_app_t *app);

/* What else a tick has to do. */
typedef enum {
    SERVICES_BESIDE_K = 0,     /* K of this tick */
    SERVICES_BESIDE_A_READING, /* of a loading test, and this tick's samples */
    SERVICES_BESIDE_SOME,      /* a piece of a loading test that a tick is for; an answer goes beside it */
    SERVICES_BESIDE_MUCH,      /* the same, and the dearest answer does not */
    SERVICES_BESIDE_LITTLE,    /* CONFIGURATION, no K */
    SERVICES_BESIDE_A_PIECE    /* CONFIGURATION, and a set of parameters on its way */
} services_room_t;

enum {
    SERVICES_BLIND = 254,  /* no samples are taken in this tick */
    SERVICES_K_WHOLE = 255 /* all of K, of this tick's samples; the piece of work */
};

/* What has come, and what there is to say, before the tick's other work. A request over CAN is answered in the tick
 * that takes it, always; what the tick has room for beside it is worked out here. Where K as a whole has none, as on
 * limbs of the general path with play, it comes in pieces; a tick without even one, for Modbus or for what there is to
 * say, is followed by one in which they wait.
 * returns how many pieces of K, or of other work, fit; or SERVICES_... */
uint32_t services_listen(brace_app_t *app, services_room_t room);

/* After the tick's snapshot is sealed. */
void services_run(brace_app_t *app);

#endif
