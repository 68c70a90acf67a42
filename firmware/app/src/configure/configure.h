/* Puts parameters in force, a piece per tick: each piece costs as much as a tick may. */
#ifndef BRACE_APP_CONFIGURE_H
#define BRACE_APP_CONFIGURE_H

#include "brace/app.h"

/* app->parameters, parameter_crc and origin have changed: everything that follows from them is to be
 * worked out anew. */
void configure_begin(brace_app_t *app);

/* One piece, at most 3,800 instructions; false once nothing is left to do. */
bool configure_piece(brace_app_t *app);

#endif
