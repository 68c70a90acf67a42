/* Loops over postures for accuracy_planar.py; not part of the product. */
#include <stddef.h>
#include <stdint.h>

#include "brace/chain.h"
#include "brace/planar.h"

/* One posture after the other into rows of six floats and the flags; the first status that is not BRACE_OK. */
int planar_rows(const brace_limb_t *limb, size_t n, const float *theta1, const float *theta2, brace_stiffness_t *row)
{
    brace_planar_t planar;
    brace_status_t status = brace_planar_collapse(limb, &planar);
    for (size_t i = 0; status == BRACE_OK && i < n; i++) {
        status = brace_planar_stiffness(&planar, theta1[i], theta2[i], &row[i]);
    }
    return status;
}

int planar_general_rows(const brace_limb_t *limb, size_t n, const float *theta1, const float *theta2,
                        brace_stiffness_t *row)
{
    brace_chain_t chain;
    brace_status_t status = brace_chain_build(limb, &chain);
    for (size_t i = 0; status == BRACE_OK && i < n; i++) {
        status = brace_chain_stiffness(&chain, theta1[i], theta2[i], &row[i]);
    }
    return status;
}
