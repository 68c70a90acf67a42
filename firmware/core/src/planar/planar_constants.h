/* The tick's constants from a limb's harmonics. */
#ifndef BRACE_PLANAR_CONSTANTS_H
#define BRACE_PLANAR_CONSTANTS_H

#include "brace/planar.h"

/* h: of the elements alone (brace_harmonics_sum), with iso beside them; used up. planar: written on success only.
 * returns BRACE_OK, BRACE_E_PARAMETER, BRACE_E_UNSUPPORTED as brace_planar_collapse. */
brace_status_t brace_planar_constants(brace_harmonics_t *h, brace_planar_t *planar);

#endif
