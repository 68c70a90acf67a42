#include "brace/chain_batch.h"

#define NOT_A_NUMBER __builtin_nanf("")

size_t brace_chain_batch(const brace_chain_t *chain, size_t n, const float *theta1_rad, const float *theta2_rad,
                         const brace_stiffness_soa_t *stiffness, const brace_compliance_soa_t *compliance,
                         uint32_t *flags)
{
    const brace_stiffness_t no_stiffness = {
        NOT_A_NUMBER, NOT_A_NUMBER, NOT_A_NUMBER, NOT_A_NUMBER, NOT_A_NUMBER, NOT_A_NUMBER, 0u};
    const brace_compliance_t no_compliance = {NOT_A_NUMBER, NOT_A_NUMBER, NOT_A_NUMBER};
    size_t refused = 0;
    for (size_t i = 0; i < n; i++) { /* at most the host's columns */
        brace_stiffness_t k = no_stiffness;
        brace_compliance_t c = no_compliance;
        if (brace_chain_stiffness(chain, theta1_rad[i], theta2_rad[i], &k) != BRACE_OK) {
            refused++;
        }
        stiffness->k_xx_n_per_mm[i] = k.k_xx_n_per_mm;
        stiffness->k_xz_n_per_mm[i] = k.k_xz_n_per_mm;
        stiffness->k_zz_n_per_mm[i] = k.k_zz_n_per_mm;
        stiffness->lambda_min_n_per_mm[i] = k.lambda_min_n_per_mm;
        stiffness->lambda_max_n_per_mm[i] = k.lambda_max_n_per_mm;
        stiffness->stiff_axis_rad[i] = k.stiff_axis_rad;
        if (compliance != NULL) {
            (void)brace_chain_compliance(chain, theta1_rad[i], theta2_rad[i], &c, NULL); /* refused: c stays NaN */
            compliance->c_xx_mm_per_n[i] = c.c_xx_mm_per_n;
            compliance->c_xz_mm_per_n[i] = c.c_xz_mm_per_n;
            compliance->c_zz_mm_per_n[i] = c.c_zz_mm_per_n;
        }
        if (flags != NULL) {
            flags[i] = k.flags;
        }
    }
    return refused;
}
