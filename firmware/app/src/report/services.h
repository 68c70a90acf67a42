/* What the controller does besides K, a bounded piece per tick. Services see the newest snapshot only: it
 * is the one source of what goes out. A bus protocol is one more call in services_run. */
#ifndef BRACE_APP_SERVICES_H
#define BRACE_APP_SERVICES_H

#include "brace/app.h"

/* After the tick's snapshot is sealed. At most 400 instructions. */
void services_run(brace_app_t *app);

#endif
