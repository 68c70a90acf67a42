/* C of a limb's five elements as functions of the knee angle. */
#ifndef BRACE_CORE_HARMONICS_H
#define BRACE_CORE_HARMONICS_H

#include "base/fma.h"
#include "brace/element.h"
#include "brace/harmonics.h"

/* Seen from the bisector of femur and tibia, psi = theta1 - theta2/2:
 *     sum v v' = mean I + [[dev_x, dev_z], [dev_z, -dev_x]],     det (sum v v') = rest + cross^2.
 * In the world's frame the deviator (dev_x, dev_z) is turned by 2 psi = 2 theta1 - theta2. */
typedef struct {
    brace_harmonic_t mean;  /* half the trace [mm/N] */
    brace_harmonic_t dev_x; /* [mm/N] */
    brace_harmonic_t dev_z; /* [mm/N] */
    brace_harmonic_t cross; /* [mm/N] */
    brace_harmonic_t rest;  /* [(mm/N)^2], never negative */
} brace_harmonics_t;

/* Cost on a Cortex-M4F: about 1,500 instructions. */
void brace_harmonics_of(const brace_element_t element[BRACE_ELEMENT_COUNT], brace_harmonics_t *harmonics);

/* A harmonic is middle + swing cos(theta2 - some angle). */
static inline float brace_harmonic_middle(const brace_harmonic_t *h)
{
    return brace_fma(0.5f, h->per_cos2, h->at_fold);
}

static inline float brace_harmonic_swing(const brace_harmonic_t *h)
{
    return 0.5f * sqrtf(brace_fma(h->per_cos2, h->per_cos2, h->per_sincos * h->per_sincos));
}

#endif
