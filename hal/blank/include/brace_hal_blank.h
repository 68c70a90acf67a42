/* The door (brace_hal.h) of no hardware at all: every entry is there and answers that there is nothing behind it. It
 * compiles anywhere, and is where a port starts: copy hal/blank, rename, fill in one entry after another, and let
 * hal/selftest say what is wrong; docs/porting.md.
 */
#ifndef BRACE_HAL_BLANK_H
#define BRACE_HAL_BLANK_H

#include "brace_hal.h"

/* The door, constant; never null. Call from anywhere, as often as wanted. */
const brace_hal_t *brace_hal_blank(void);

#endif
