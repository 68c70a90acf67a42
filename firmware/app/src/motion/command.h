/* What the drives are told: the take-up's command and the loading test's offset, added up. */
#ifndef BRACE_APP_COMMAND_H
#define BRACE_APP_COMMAND_H

#include "brace/app.h"

/* Tells the drives, every tick while there is something to tell, and once that there is no more. */
void command_send(brace_app_t *app, const brace_snapshot_t *snapshot);

#endif
