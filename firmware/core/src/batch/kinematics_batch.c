#include "brace/kinematics_batch.h"

size_t brace_kinematics_inverse_batch(const brace_limb_t *limb, size_t n, const float *x_mm, const float *z_mm,
                                      const uint8_t *knee, float *theta1_rad, float *theta2_rad)
{
    size_t refused = 0;
    for (size_t i = 0; i < n; i++) { /* at most the host's columns */
        const brace_point_t tip = {x_mm[i], z_mm[i]};
        theta1_rad[i] = theta2_rad[i] = __builtin_nanf("");
        if (brace_kinematics_inverse(limb, tip, (brace_knee_t)knee[i], &theta1_rad[i], &theta2_rad[i]) != BRACE_OK) {
            refused++;
        }
    }
    return refused;
}
