/* K of the paper's limb at one posture, in a project that takes Brace as a library. */
#include <stdio.h>

#include "limb.h" /* written by brace export --model limb.toml --c limb.c */

int main(void)
{
    brace_stiffness_t k;
    if (limb_check() != BRACE_OK || brace_planar_stiffness(&limb_planar, 1.0f, 1.4f, &k) != BRACE_OK) {
        return 1;
    }
    printf("k_xx %.5f k_xz %.5f k_zz %.5f N/mm\n", (double)k.k_xx_n_per_mm, (double)k.k_xz_n_per_mm,
           (double)k.k_zz_n_per_mm);
    return 0;
}
