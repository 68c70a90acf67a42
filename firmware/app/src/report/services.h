/* What the controller does besides K, a bounded piece per tick. Services see the newest snapshot only: it
 * is the one source of what goes out. A bus protocol is one more call in services_run. */
#ifndef BRACE_APP_SERVICES_H
#define BRACE_APP_SERVICES_H

#include "brace/app.h"

/* At start; not for the tick. */
void services_start(brace_app_t *app);

/* What has come, before the tick's other work. may_serve: this tick has room for an answer.
 * returns whether it is to be kept free for one: services_run answers it then */
bool services_listen(brace_app_t *app, bool may_serve);

/* After the tick's snapshot is sealed. At most 500 instructions; 2,500 when a request is answered; a commit, 21,000.
 *   serves: as services_listen said */
void services_run(brace_app_t *app, bool serves);

#endif
