/* K under a load at many postures at once, for maps, plans and tables on a host. */
#ifndef BRACE_LOADED_BATCH_H
#define BRACE_LOADED_BATCH_H

#include <stddef.h>

#include "brace/loaded.h"

/* K and rest at n postures, each with a force of its own. No argument is checked for null.
 * loaded: from brace_loaded_collapse. joints: direction of the weight and the joints' springs; its tip force is ignored.
 * theta1_rad, theta2_rad, x_n, z_n: n each, as brace_loaded_stiffness takes them.
 * results: n, flags with those of brace_loaded_flags; where brace_loaded_stiffness refuses, every number is NaN and
 * flags are 0.
 * returns how many were refused.
 * Cost: about 3 us a posture (one core of an Intel Xeon at 2.5 GHz, GCC 12; libm has the fused multiply-add).
 * Thread rule: a pure function of its arguments. */
size_t brace_loaded_batch(const brace_loaded_t *loaded, const brace_load_t *joints, size_t n, const float *theta1_rad,
                          const float *theta2_rad, const float *x_n, const float *z_n,
                          brace_loaded_stiffness_t *results);

#endif
