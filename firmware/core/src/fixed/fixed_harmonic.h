/* The value of a harmonic of the knee angle, in integers. */
#ifndef BRACE_CORE_FIXED_HARMONIC_H
#define BRACE_CORE_FIXED_HARMONIC_H

#include "brace/fixed_harmonic.h"
#include "fixed/fixed_sincos.h"

/* In the harmonic's own unit. */
static inline int32_t harmonic(const brace_fixed_harmonic_t *h, brace_sincos_t knee)
{
    return brace_high_word(h->constant_q32 + whole_product(h->per_cos, knee.cos_q31) +
                           whole_product(h->per_sin, knee.sin_q31));
}

#endif
