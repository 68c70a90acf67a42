/* C of a loaded limb in fixed point, from the levers of its links, and K from C. */
#ifndef BRACE_CORE_LOADED_FIXED_COMPLIANCE_H
#define BRACE_CORE_LOADED_FIXED_COMPLIANCE_H

#include "brace/status.h"
#include "fixed/fixed_inverse.h"
#include "loaded/fixed_solve.h"

#define LEAST_TRACE_Q54 (1 << 20)
#define LEAST_DET_HIGH 4u         /* 3e-8 of the squared mean */
#define SLENDER_Q32 85899u        /* BRACE_SLENDER of chain/tensor.h, 2e-5 */

/* C, entry by entry, as whole sums of products. Those of one entry of the diagonal are not negative; entries wrap until
 * they are looked at. */
typedef struct {
    uint64_t xx, xz, zz;
} fixed_tensor_t;

/* c (q54) += by v v', v a lever, by at least 0. */
INLINE void add_scaled(fixed_tensor_t *c, fixed_vec_t v, int32_t by)
{
    const fixed_vec_t product_q26 = fixed_scaled(v, by, 31);
    c->xx += (uint64_t)whole_product(product_q26.x, v.x);
    c->xz += (uint64_t)whole_product(product_q26.x, v.z);
    c->zz += (uint64_t)whole_product(product_q26.z, v.z);
}

/* c (q60) += v v', v a spring's vector. */
INLINE void add_spring(fixed_tensor_t *c, fixed_vec_t v)
{
    c->xx += (uint64_t)whole_product(v.x, v.x);
    c->xz += (uint64_t)whole_product(v.x, v.z);
    c->zz += (uint64_t)whole_product(v.z, v.z);
}

/* Notes as lost an entry of the diagonal, q54, that reaches 256. Three of add_scaled's are below 3 256, whatever v and
 * `by`, so that two of these and springs do not wrap beyond it. */
INLINE void look_at(const fixed_tensor_t *c, lost_t *lost)
{
    *lost |= (uint32_t)(c->xx >> 32) >> 6 | (uint32_t)(c->zz >> 32) >> 6;
}

/* Levers (q28) less others times ratios (q27). */
INLINE fixed_vec_t less_scaled(fixed_vec_t v, fixed_vec_t a, int32_t by, fixed_vec_t b, int32_t to, lost_t *lost)
{
    return (fixed_vec_t){kept(sum3(v.x, ONE_Q27, a.x, -by, b.x, -to), 27, ROOM_LEVER_LESS, lost),
                         kept(sum3(v.z, ONE_Q27, a.z, -by, b.z, -to), 27, ROOM_LEVER_LESS, lost)};
}

/* As add_link of loaded.c. */
INLINE fixed_vec_t add_link(fixed_tensor_t *c, fixed_tensor_t *springs, const fixed_rest_t *rest,
                            const fixed_factors_t *f, uint32_t coarser, fixed_vec_t beyond, lost_t *lost)
{
    const fixed_vec_t none = {0, 0}, end = fixed_plus(rest->end, beyond), a = fixed_plus(rest->a, end);
    const fixed_vec_t b = less_scaled(fixed_plus(rest->b, end), a, f->b_by_a, none, 0, lost);
    const fixed_vec_t root = fixed_plus(fixed_minus(fixed_quarter(rest->tip), rest->aside), beyond);
    add_scaled(c, a, f->yields_a >> coarser);
    add_scaled(c, b, f->yields_b >> coarser);
    add_spring(springs, rest->root_spring);
    add_spring(springs, rest->end_spring);
    return less_scaled(root, a, f->root_by_a, b, f->root_by_b, lost);
}

/* K from C (q54 in units of length over force), seen from the femur. exponent: of force over length. */
static inline brace_status_t stiffness_of(const fixed_tensor_t *c, uint32_t theta1_turn, int32_t exponent,
                                          brace_stiffness_t *stiffness)
{
    const uint64_t trace_as_is = c->xx + c->zz;
    if ((int64_t)trace_as_is < LEAST_TRACE_Q54) { /* 512 and more are negative */
        return BRACE_E_SINGULAR;
    }
    const uint32_t zeros = (uint32_t)__builtin_clzll(trace_as_is) - 1u;
    const uint64_t xx = c->xx << zeros, zz = c->zz << zeros, xz = c->xz << zeros;
    /* det C, q60 of the unit of xx's high word: high and low words, so that the small difference of large products is
     * right to the last place */
    const int32_t xz_high = (int32_t)(uint32_t)(xz >> 32);
    const uint32_t xx_high = (uint32_t)(xx >> 32), zz_high = (uint32_t)(zz >> 32);
    const uint64_t across = (uint64_t)xx_high * (uint32_t)zz + (uint64_t)zz_high * (uint32_t)xx;
    const int64_t det = (int64_t)((uint64_t)xx_high * zz_high) - (int64_t)xz_high * xz_high + (int64_t)(across >> 32) -
                        (((int64_t)xz_high * (int64_t)(uint32_t)xz) >> 31);
    if (det < (int64_t)((uint64_t)LEAST_DET_HIGH << 32)) {
        return BRACE_E_SINGULAR;
    }
    const uint64_t trace = xx + zz;
    const uint32_t det_high = (uint32_t)((uint64_t)det >> 32), det_zeros = leading_zeros(det_high);
    const uint32_t mean = (uint32_t)(trace >> 33), slender = high_unsigned(high_unsigned(mean, mean), SLENDER_Q32);
    const fixed_circle_t circle = {.trace = (uint32_t)(trace >> 31),
                                   .minus_dev_x = brace_high_word((int64_t)(zz - xx)),
                                   .dev_z = shifted((int64_t)xz, 31),
                                   .det_leading = (uint32_t)(((uint64_t)det << det_zeros) >> 32),
                                   .exponent_k = (uint32_t)(120 + (int32_t)(zeros + det_zeros) + exponent) << 23,
                                   .exponent_min = (uint32_t)(121 + (int32_t)zeros + exponent) << 23,
                                   .twice_turn = 2u * theta1_turn};
    stiffness_of_circle(&circle, stiffness);
    stiffness->flags = det_high < slender ? BRACE_FLAG_NEAR_SINGULAR : 0u;
    return BRACE_OK;
}

#endif
