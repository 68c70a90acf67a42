/* Puts parameters in force, a piece per tick: each piece costs as much as a tick may. */
#ifndef BRACE_APP_CONFIGURE_H
#define BRACE_APP_CONFIGURE_H

#include "brace/app.h"

/* app->parameters, parameter_crc and origin have changed: everything that follows from them is to be
 * worked out anew.
 *   fresh: the set has just been written; else it was there before, with what is known of its limb */
void configure_begin(brace_app_t *app, bool fresh);

/* One piece, at most 2,300 instructions; false once nothing is left to do. What the drift check knew of the limb is
 * found in pieces of its own: all of them, at most. */
enum { CONFIGURE_PIECES = 7 + BRACE_JOURNAL_SCANS };
bool configure_piece(brace_app_t *app);

#endif
