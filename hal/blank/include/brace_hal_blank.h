/* A door (brace_hal.h) without hardware: every entry answers that nothing is behind it. It compiles anywhere, and a
 * port starts from it: copy hal/blank, rename it, fill in one entry after another, and let hal/selftest say what is
 * wrong; docs/porting.md shows each step.
 */
#ifndef BRACE_HAL_BLANK_H
#define BRACE_HAL_BLANK_H

#include "brace_hal.h"

/* The door, constant; never null. Any code may call this at any time. */
const brace_hal_t *brace_hal_blank(void);

#endif
