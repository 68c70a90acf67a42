/* The compliance chain of a limb in its plane, and what follows from it.
 *
 * Every source of compliance is one or two rank-one elements, each a vector v(posture), so that
 *     C = iso I + sum_i v_i v_i',    v_i = R(theta1) femur_i + R(theta1 - theta2) tibia_i + base_i.
 * With s the element's compliance: an ellipsoid is its smaller compliance in every direction (iso) and
 * v = sqrt(excess) times its longer axis; a joint spring is v = sqrt(s) times the lever of the tip force about
 * the joint; a femur that passes moments on adds v = sqrt(0.75 kappa b) (n + (2/L) p_knee), n across the femur.
 * A richer limb is a longer list, never another formula. The list has
 *     det C = iso^2 + iso sum_i |v_i|^2 + sum_{i<j} (v_i x v_j)^2,
 * in which nothing cancels however slender the ellipsoids are. Added up element by element it is
 *     det (A + v v') = det A + v' adj(A) v,    v' adj(A) v trace A = |adj(A) v|^2 + det A |v|^2.
 *
 * Formulas: docs/physics.md (C = sum T' S T); the harmonic form is derived in docs/kernel.md.
 * Thread rule: pure functions of their arguments; safe from any context once the arguments are not written.
 */
#ifndef BRACE_CHAIN_H
#define BRACE_CHAIN_H

#include "brace/limb.h"
#include "brace/status.h"
#include "brace/stiffness.h"

/* Capacity: femur ellipsoid, femur moment transfer, tibia ellipsoid, two joint springs, base, and for the
 * spatial limb seen in its plane the coxa ellipsoid and its moment transfer. */
enum { BRACE_CHAIN_MAX = 8 };

/* A vector in the limb's plane, x outwards, z up; in the frame its user names. */
typedef struct {
    float x, z;
} brace_vec_t;

/* One element, in sqrt(mm/N). */
typedef struct {
    brace_vec_t femur; /* part of v turning with the femur, at theta1 */
    brace_vec_t tibia; /* part of v turning with the tibia, at theta1 - theta2 */
    brace_vec_t base;  /* part of v that does not turn */
} brace_element_t;

/* Femur ellipsoid, femur moment transfer, tibia ellipsoid, joints 1 and 2: the limb's elements without base part. */
enum { BRACE_CHAIN_FIRM = 5 };

/* One of them. Seen from the bisector of femur and tibia it is v = straight cos h + folded sin h with h = theta2/2:
 * halved, as nearly all use it, the same place holds what is left of it at the straight and at the folded knee. */
typedef union {
    struct {
        brace_vec_t femur, tibia;
    };
    struct {
        brace_vec_t straight, folded;
    };
    brace_vec_t part[2];
} brace_swing_t;

/* The coxa link, which lies along x, its moment being that of the tip force about the hip: its ellipsoid's excess,
 * and of its moment transfer the bending that goes with it and what each mm of the tip's lever adds to that. */
typedef struct {
    brace_vec_t excess, bent; /* [sqrt(mm/N)] */
    float bent_per_mm;
} brace_coxa_t;

typedef struct {
    float iso_mm_per_n; /* compliance shared by every direction */
    uint32_t count;     /* elements in use, [0, BRACE_CHAIN_MAX] */
    brace_element_t element[BRACE_CHAIN_MAX];
} brace_chain_t;

/* The planar chain of a limb: femur, tibia, joints 1 and 2, base. Coxa link and joint 0 are rigid here.
 * limb: checked with brace_limb_check. chain: written on success only.
 * returns BRACE_OK or what brace_limb_check says. */
brace_status_t brace_chain_build(const brace_limb_t *limb, brace_chain_t *chain);

/* The same with the in-plane compliance of the coxa link added: the spatial limb seen in its own plane. */
brace_status_t brace_chain_build_with_coxa(const brace_limb_t *limb, brace_chain_t *chain);

/* C at a posture, and if det is not null det C [(mm/N)^2] as the sum of positive terms.
 * theta1_rad, theta2_rad: true angles, theta1^2 + theta2^2 <= BRACE_PLANAR_REACH_RAD2 (31, brace/planar.h): both
 * may lie anywhere within [-3.9, 3.9]. Outputs are written on success only.
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_NOT_FINITE, BRACE_E_RANGE. */
brace_status_t brace_chain_compliance(const brace_chain_t *chain, float theta1_rad, float theta2_rad,
                                      brace_compliance_t *compliance, float *det);

/* K at a posture for any limb, yielding base included: the general path.
 * Accuracy: each entry of K within 2e-6 of lambda_max, eigenvalues within 2e-6 of themselves, stiff axis within 1e-6
 * rad times lambda_max / (lambda_max - lambda_min), unless flagged.
 * flags: BRACE_FLAG_NEAR_SINGULAR when C is so slender (det C < 2e-5 of the squared half trace) that this is not
 * promised.
 * Cost on a Cortex-M4F: at most 530 instructions for six elements, 45 an element; 120 bytes of stack. The tick has
 * brace/general.h.
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_NOT_FINITE, BRACE_E_RANGE, BRACE_E_SINGULAR (det C is zero). */
brace_status_t brace_chain_stiffness(const brace_chain_t *chain, float theta1_rad, float theta2_rad,
                                     brace_stiffness_t *stiffness);

/* A function of the knee angle alone: at_fold + per_cos (1 + cos theta2) + per_sin sin theta2. Anchored
 * at the folded knee, where the levers nearly cancel: (at_fold + per_cos), added up in more than a float, is
 * the constant of the plain form, and nothing is lost at the fold. */
typedef struct {
    float at_fold, per_cos, per_sin;
} brace_harmonic_t;

/* A chain whose base does not yield (or yields equally in every direction), seen from the bisector of femur
 * and tibia, psi = theta1 - theta2/2 (femur at +theta2/2 from it, tibia at -theta2/2):
 *     C = mean I + [[dev_x, dev_y], [dev_y, -dev_x]]     det C = rest + cross^2
 * In the world's frame (dev_x + i dev_y) turns by 2 psi = 2 theta1 - theta2. With r = |dev|:
 *     lambda_min = 1/(mean + r), lambda_max = (mean + r)/det, K = (mean I - dev)/det,
 *     stiff axis = 1/2 atan2(-dev_y, -dev_x) in the world's frame.
 * rest > 0 is nearly always what cross^2 leaves: forming det from the two loses nothing. */
typedef struct {
    brace_harmonic_t mean;  /* half the trace of C [mm/N] */
    brace_harmonic_t dev_x; /* deviator of C [mm/N] */
    brace_harmonic_t dev_y; /* [mm/N] */
    brace_harmonic_t cross; /* [mm/N] */
    brace_harmonic_t rest;  /* [(mm/N)^2] */
    float iso_mm_per_n;     /* the chain's: compliance shared by every direction */
} brace_harmonics_t;

/* The chain's harmonics.
 * returns BRACE_OK, BRACE_E_NULL,
 *         BRACE_E_UNSUPPORTED: the base yields unequally (or there are more than the five elements of femur, tibia and
 *         joints); brace_chain_stiffness serves such a limb. */
brace_status_t brace_harmonics(const brace_chain_t *chain, brace_harmonics_t *harmonics);

#endif
