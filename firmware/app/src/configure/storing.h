/* The controller's dealings with the parameter store: start, commit, roll back, a step per tick. */
#ifndef BRACE_APP_STORING_H
#define BRACE_APP_STORING_H

#include "brace/app.h"

/* Takes the parameters in force from the store. */
void storing_start(brace_app_t *app);

/* Stores a set: checked by the store in its first steps. returns BRACE_OK, BRACE_E_UNSUPPORTED (busy). At most 800
 * instructions. */
brace_status_t storing_commit(brace_app_t *app, const brace_parameters_t *parameters);
brace_status_t storing_rollback(brace_app_t *app);

/* One step; what is done goes in force. At most 2,000 instructions. */
void storing_step(brace_app_t *app);

/* Is anything being stored or put in force? */
bool storing_busy(const brace_app_t *app);

#endif
