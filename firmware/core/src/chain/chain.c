#include "brace/chain.h"

#include <stddef.h>

#include "chain/elements.h"

brace_status_t brace_chain_build(const brace_limb_t *limb, brace_chain_t *chain)
{
    const brace_status_t status = chain == NULL ? BRACE_E_NULL : brace_limb_check(limb);
    if (status == BRACE_OK) {
        brace_general_collapse(limb, &chain->general);
        chain->hip_rad_per_n_mm = brace_hip_rad_per_n_mm(limb);
        chain->knee_rad_per_n_mm = brace_knee_rad_per_n_mm(limb);
    }
    return status;
}

brace_status_t brace_chain_compliance(const brace_chain_t *chain, float theta1_rad, float theta2_rad,
                                      brace_compliance_t *compliance, float *det)
{
    if (chain == NULL || compliance == NULL) {
        return BRACE_E_NULL;
    }
    float unused;
    return brace_general_compliance(&chain->general, theta1_rad, theta2_rad, chain->hip_rad_per_n_mm,
                                    chain->knee_rad_per_n_mm, compliance, det != NULL ? det : &unused);
}

brace_status_t brace_chain_stiffness(const brace_chain_t *chain, float theta1_rad, float theta2_rad,
                                     brace_stiffness_t *stiffness)
{
    if (chain == NULL || stiffness == NULL) {
        return BRACE_E_NULL;
    }
    return brace_general_stiffness(&chain->general, theta1_rad, theta2_rad, chain->hip_rad_per_n_mm,
                                   chain->knee_rad_per_n_mm, stiffness);
}
