/* K of the paper's limb at one posture, in a project that takes Brace as a library. */
#include <stdio.h>

#include "brace/planar.h"

int main(void)
{
    const brace_limb_t limb = {
        .femur_mm = 185.0f,
        .tibia_mm = 313.5f,
        .link[BRACE_FEMUR] = {.axial_mm_per_n = 0.001f, .bending_mm_per_n = 0.06f},
        .link[BRACE_TIBIA] = {.axial_mm_per_n = 0.002f, .bending_mm_per_n = 0.25f},
        .joint[BRACE_FEMUR] = {.compliance_rad_per_n_mm = 1.0e-5f},
        .joint[BRACE_TIBIA] = {.compliance_rad_per_n_mm = 1.6e-5f},
    };
    brace_planar_t planar; /* collapse once, when parameters change */
    brace_stiffness_t k;   /* and ask for K in each tick */
    if (brace_planar_collapse(&limb, &planar) != BRACE_OK ||
        brace_planar_stiffness(&planar, 1.0f, 1.4f, &k) != BRACE_OK) {
        return 1;
    }
    printf("k_xx %.5f k_xz %.5f k_zz %.5f N/mm\n", (double)k.k_xx_n_per_mm, (double)k.k_xz_n_per_mm,
           (double)k.k_zz_n_per_mm);
    return 0;
}
