/* Angles for many places of the tip at once, for maps and plans on a host. */
#ifndef BRACE_KINEMATICS_BATCH_H
#define BRACE_KINEMATICS_BATCH_H

#include <stddef.h>
#include <stdint.h>

#include "brace/kinematics.h"

/* The angles that put the tip at n points, each with a knee of its own. No argument is checked for null.
 * x_mm, z_mm: n each; knee: n of brace_knee_t.
 * theta1_rad, theta2_rad (out): n each, as brace_kinematics_inverse gives them; NaN where it refuses.
 * returns how many were refused. */
size_t brace_kinematics_inverse_batch(const brace_limb_t *limb, size_t n, const float *x_mm, const float *z_mm,
                                      const uint8_t *knee, float *theta1_rad, float *theta2_rad);

#endif
