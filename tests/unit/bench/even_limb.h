/* Limbs in space by chance, of which every part yields by much the same under a load. */
#ifndef EVEN_LIMB_H
#define EVEN_LIMB_H

#include "loaded_paths.h"

static uint32_t state;

static inline double any(double least, double most)
{
    state = state * 1664525u + 1013904223u;
    return least + (most - least) * ((double)(state >> 8) / 16777216.0);
}

/* A limb of which every part yields by much the same under a load, so that no part hides behind another. Its links turn
 * by up to `turn_rad` each. */
static inline void be_even(double turn_rad, double force_n)
{
    limb = sample_limb[SAMPLE_BEAM];
    limb.coxa_mm = (float)any(40.0, 120.0);
    limb.femur_mm = (float)any(90.0, 240.0), limb.tibia_mm = (float)any(90.0, 240.0);
    const double reach_mm = (double)(limb.coxa_mm + limb.femur_mm + limb.tibia_mm);
    const double per_n_mm = turn_rad / (force_n * reach_mm);
    const float length_mm[BRACE_LINK_COUNT] = {limb.coxa_mm, limb.femur_mm, limb.tibia_mm};
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        const double square = (double)length_mm[i] * (double)length_mm[i];
        limb.link[i] = (brace_link_t){.axial_mm_per_n = (float)(any(0.02, 0.2) * per_n_mm * square),
                                      .bending_mm_per_n = (float)(any(0.1, 0.4) * per_n_mm * square),
                                      .lateral_mm_per_n = (float)(any(0.1, 0.4) * per_n_mm * square),
                                      .torsion_rad_per_n_mm = (float)(any(0.2, 1.0) * per_n_mm),
                                      .tilt_rad = (float)any(-0.5, 0.5),
                                      .moment_transfer = (float)any(0.0, 1.0)};
        limb.joint[i].compliance_rad_per_n_mm = (float)(any(0.2, 1.0) * per_n_mm);
    }
    limb.base = (brace_base_t){(float)(any(0.01, 0.05) * per_n_mm * 1e4), (float)(any(0.01, 0.05) * per_n_mm * 1e4),
                               (float)(any(0.1, 0.5) * per_n_mm)};
    weights = (brace_gravity_t){.femur_n = (float)(any(0.0, 0.2) * force_n),
                                .knee_n = (float)(any(0.0, 0.2) * force_n),
                                .tibia_n = (float)(any(0.0, 0.2) * force_n)};
    theta1_rad = any(-3.0, 3.0), theta2_rad = any(-2.5, 2.5);
}

/* A force on the tip from any side, weights that pull to any side, and the joints' own springs. */
static inline void be_pressed(double force_n)
{
    const double down_rad = any(-3.2, 3.2), force_rad = any(-3.2, 3.2), up = any(-1.0, 1.0), out = sqrt(1.0 - up * up);
    space_load.down = (brace_vec3_t){(float)(0.6 * cos(down_rad)), 0.8f, (float)(0.6 * sin(down_rad))};
    space_load.tip_n = (brace_vec3_t){(float)(force_n * out * cos(force_rad)), (float)(force_n * up),
                                      (float)(force_n * out * sin(force_rad))};
    space_load.yaw = spring_of(BRACE_COXA);
    space_load.hip = spring_of(BRACE_FEMUR);
    space_load.knee = spring_of(BRACE_TIBIA);
}

#endif
