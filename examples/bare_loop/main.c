/* K in the loop of a program that has nothing else of Brace than two files, brace_core.h and brace_core.c, and a limb
 * as const data.
 *
 * The Makefile builds it for this machine, and for emulated boards with a Cortex-M4F, a Cortex-M3 and a RISC-V.
 */
#include <stdio.h>

#include "limb.h" /* the paper's limb; yours: brace export --model limb.toml --c limb.c */

/* Yours reads two encoders, and never ends. */
static bool read_joints(float *theta1_rad, float *theta2_rad)
{
    static const float samples[][2] = {{1.0f, 1.4f}, {0.8f, 1.6f}, {0.6f, 1.8f}};
    static size_t next;
    if (next == sizeof samples / sizeof *samples) {
        return false;
    }
    *theta1_rad = samples[next][0];
    *theta2_rad = samples[next][1];
    next++;
    return true;
}

int main(void)
{
    brace_status_t status = limb_check(); /* numbers as exported, and constants of this very core */
    float theta1_rad, theta2_rad;
    while (status == BRACE_OK && read_joints(&theta1_rad, &theta2_rad)) {
        brace_stiffness_t k;
        status = brace_planar_stiffness(&limb_planar, theta1_rad, theta2_rad, &k);
        if (status == BRACE_OK) { /* a refused call leaves k untouched */
            printf("k_xx %.5f k_xz %.5f k_zz %.5f N/mm\n", (double)k.k_xx_n_per_mm, (double)k.k_xz_n_per_mm,
                   (double)k.k_zz_n_per_mm);
        }
    }
    if (status != BRACE_OK) {
        printf("refused: %d, see brace_status_t\n", (int)status);
    }
    return status == BRACE_OK ? 0 : 1;
}
