/* What the controller does besides K, a bounded piece per tick. Services see the newest snapshot only: it
 * is the one source of what goes out. A bus protocol is one more call in services_run. */
#ifndef BRACE_APP_SERVICES_H
#define BRACE_APP_SERVICES_H

#include "brace/app.h"

/* At start; not for the tick. */
void services_start(brace_app_t *app);

/* What has come, and what there is to say, before the tick's other work. A tick with an answer to work out
 * is lean: K is left out. So is one with something to say when the limb takes the general path, whose K
 * fills a tick. Two lean ticks never follow each other.
 *   may_be_lean: nothing in this tick has to be done now
 * returns whether it is lean */
bool services_listen(brace_app_t *app, bool may_be_lean);

/* After the tick's snapshot is sealed. At most 450 instructions; in a lean tick 2,500; a commit, 21,000.
 *   lean: as services_listen said */
void services_run(brace_app_t *app, bool lean);

#endif
