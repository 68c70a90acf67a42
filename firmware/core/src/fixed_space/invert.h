/* The inverse of a symmetric matrix in space, in fixed point. */
#ifndef BRACE_CORE_FIXED_SPACE_INVERT_H
#define BRACE_CORE_FIXED_SPACE_INVERT_H

#include "brace/loaded_space_types.h"
#include "fixed_space/sum.h"

#define TRACE_LEAST_Q54 (1u << 20)
/* Least over largest eigenvalue about 2e-7: rounding is a hundredth of it. */
#define DETERMINANT_LEAST ((int64_t)1 << 38)

INLINE int32_t to_word(int64_t number, uint32_t zeros)
{
    return brace_high_word((int64_t)((uint64_t)number << zeros));
}

/* |number|; one unit too small for a negative one. */
INLINE uint64_t size_of(int64_t number)
{
    return (uint64_t)(number ^ (number >> 63));
}

/* Does to_word lose no bit of any of three? Of a matrix that is positive definite none is above the trace. */
INLINE bool fit_words(int64_t a, int64_t b, int64_t c, uint32_t zeros)
{
    return (size_of(a) | size_of(b) | size_of(c)) >> (63u - zeros) == 0u;
}

/* a b - c d */
INLINE int64_t minor_of(int32_t a, int32_t b, int32_t c, int32_t d)
{
    return (int64_t)a * b - (int64_t)c * d;
}

/* exponent_field: as of float_bits */
INLINE float entry_of(int32_t cofactor, uint32_t per_det, uint32_t exponent_field)
{
    const uint32_t magnitude = high_unsigned(magnitude_of(cofactor), per_det), is_none = (uint32_t)(magnitude == 0u);
    return float_of((float_bits(magnitude | is_none, exponent_field) | sign_of(cofactor)) & (is_none - 1u));
}

/* C (q54) to K, times 2^exponent. returns whether K is positive definite */
INLINE bool fixed_inverse3(const fixed_tensor3_t *c, int32_t exponent, brace_k3_t *k)
{
    const uint64_t trace = (uint64_t)c->xx + (uint64_t)c->yy + (uint64_t)c->zz;
    if (c->xx < 0 || c->yy < 0 || c->zz < 0 || trace < TRACE_LEAST_Q54) {
        return false;
    }
    /* All entries are at most half of a word, and all cofactors an eighth of two. */
    const uint32_t zeros = zeros_of(trace) - 1u;
    if (!fit_words(c->xy, c->xz, c->yz, zeros)) {
        return false;
    }
    const int32_t xx = to_word(c->xx, zeros) >> 1, xy = to_word(c->xy, zeros) >> 1, xz = to_word(c->xz, zeros) >> 1;
    const int32_t yy = to_word(c->yy, zeros) >> 1, yz = to_word(c->yz, zeros) >> 1, zz = to_word(c->zz, zeros) >> 1;
    const int64_t of_xx = minor_of(yy, zz, yz, yz), of_yy = minor_of(xx, zz, xz, xz), of_zz = minor_of(xx, yy, xy, xy);
    const int64_t of_xy = minor_of(xz, yz, xy, zz), of_xz = minor_of(xy, yz, xz, yy), of_yz = minor_of(xy, xz, xx, yz);
    const uint32_t up = zeros_of((uint64_t)of_xx + (uint64_t)of_yy + (uint64_t)of_zz) - 1u;
    if (of_xx < 0 || of_yy < 0 || of_zz < 0 || !fit_words(of_xy, of_xz, of_yz, up)) {
        return false;
    }
    const int32_t k_xx = to_word(of_xx, up), k_yy = to_word(of_yy, up), k_zz = to_word(of_zz, up);
    const int32_t k_xy = to_word(of_xy, up), k_xz = to_word(of_xz, up), k_yz = to_word(of_yz, up);
    const int64_t det = sum3(xx, k_xx, xy, k_xy, xz, k_xz);
    if (det < DETERMINANT_LEAST) {
        return false;
    }
    const uint32_t det_up = zeros_of((uint64_t)det);
    const uint32_t per_det = over_q61(leading_of((uint64_t)det, det_up));
    const uint32_t field = (uint32_t)(117 + (int32_t)(det_up + zeros) + exponent) << 23;
    *k = (brace_k3_t){entry_of(k_xx, per_det, field), entry_of(k_xy, per_det, field),
                      entry_of(k_xz, per_det, field), entry_of(k_yy, per_det, field),
                      entry_of(k_yz, per_det, field), entry_of(k_zz, per_det, field)};
    return true;
}

#endif
