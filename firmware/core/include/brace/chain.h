/* The general path (brace/general.h) with the limb's own springs. It checks every argument: for hosts and tests.
 *
 * Formulas: docs/physics.md (C = sum T' S T) and docs/kernel.md.
 * Thread rule: pure functions of their arguments; safe from any context once the arguments are not written.
 */
#ifndef BRACE_CHAIN_H
#define BRACE_CHAIN_H

#include "brace/general.h"
#include "brace/limb.h"
#include "brace/status.h"
#include "brace/stiffness.h"

/* The planar compliance chain of a limb: femur, tibia, joints 1 and 2, base. Coxa link and joint 0 count as rigid. */
typedef struct {
    brace_general_t general;
    float hip_rad_per_n_mm, knee_rad_per_n_mm;
} brace_chain_t;

/* chain: written on success only.
 * returns BRACE_OK, BRACE_E_NULL or what brace_limb_check says. */
brace_status_t brace_chain_build(const brace_limb_t *limb, brace_chain_t *chain);

/* As brace_general_compliance; det may be null.
 * returns also BRACE_E_NULL. */
brace_status_t brace_chain_compliance(const brace_chain_t *chain, float theta1_rad, float theta2_rad,
                                      brace_compliance_t *compliance, float *det);

/* As brace_general_stiffness.
 * returns also BRACE_E_NULL. */
brace_status_t brace_chain_stiffness(const brace_chain_t *chain, float theta1_rad, float theta2_rad,
                                     brace_stiffness_t *stiffness);

#endif
