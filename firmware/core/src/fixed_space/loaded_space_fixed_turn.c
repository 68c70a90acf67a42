#include "brace/loaded_space_fixed.h"
#include "fixed_space/jacobi.h"

/* From K in the limb's plane's frame: its eigenvalues and axes, in the plane and in the robot's frame. */

#define ANGLE_MOST_Q28 2120640102 /* BRACE_ANGLE_LIMIT_RAD, 7.9 */
#define INFINITE_BITS 0x7f800000u
#define EXPONENT_MOST 50
#define SLENDER_BY_PLANE_Q32 85899u /* BRACE_SLENDER of chain/tensor.h, 2e-5 */
#define SLENDER_PER_LEAST 10000     /* least over largest eigenvalue, inverse: as in loaded_space.c */

/* K as integers: each entry times 2^format, below 2^28. */
typedef struct {
    fixed_sym3_t k;
    int32_t format;
} k_words_t;

INLINE uint32_t larger_magnitude(uint32_t a, float b)
{
    const uint32_t bits = bits_of(b) & 0x7fffffffu;
    return a > bits ? a : bits;
}

/* returns whether K has entries that its words hold */
INLINE bool words_of(const brace_k3_t *k, k_words_t *words)
{
    uint32_t most = larger_magnitude(0u, k->xx_n_per_mm);
    most = larger_magnitude(larger_magnitude(most, k->xy_n_per_mm), k->xz_n_per_mm);
    most = larger_magnitude(larger_magnitude(most, k->yy_n_per_mm), k->yz_n_per_mm);
    most = larger_magnitude(most, k->zz_n_per_mm);
    const int32_t exponent = exponent_above(most), format = 28 - exponent;
    if (exponent > EXPONENT_MOST || exponent < -EXPONENT_MOST) {
        return false;
    }
    words->format = format;
    words->k = (fixed_sym3_t){fixed_of(bits_of(k->xx_n_per_mm), format), fixed_of(bits_of(k->xy_n_per_mm), format),
                              fixed_of(bits_of(k->xz_n_per_mm), format), fixed_of(bits_of(k->yy_n_per_mm), format),
                              fixed_of(bits_of(k->yz_n_per_mm), format), fixed_of(bits_of(k->zz_n_per_mm), format)};
    return true;
}

brace_status_t brace_loaded_space_fixed_in_plane(const brace_k3_t *k, brace_stiffness_t *plane)
{
    const brace_k3_t alone = {
        .xx_n_per_mm = k->xx_n_per_mm, .xz_n_per_mm = k->xz_n_per_mm, .zz_n_per_mm = k->zz_n_per_mm};
    k_words_t words;
    if (!words_of(&alone, &words)) {
        return BRACE_E_SINGULAR;
    }
    const int32_t xx = words.k.xx, xz = words.k.xz, zz = words.k.zz;
    const int64_t det = whole_product(xx, zz) - whole_product(xz, xz);
    const uint32_t mean = (uint32_t)((xx + zz) >> 1), squared = high_unsigned(mean, mean);
    const int32_t det_high = brace_high_word(det);
    if (xx <= 0 || zz <= 0 || det < 1 << 26) {
        return BRACE_E_SINGULAR;
    }
    const int32_t apart = (xx - zz) >> 1;
    const fixed_length_t radius = fixed_length_of(apart, -xz);
    const uint32_t most = mean + radius.length, zeros = leading_zeros(most), det_zeros = zeros_of((uint64_t)det);
    const uint32_t least = high_unsigned(leading_of((uint64_t)det, det_zeros), over_q61(most << zeros));
    *plane = (brace_stiffness_t){
        .k_xx_n_per_mm = k->xx_n_per_mm,
        .k_xz_n_per_mm = k->xz_n_per_mm,
        .k_zz_n_per_mm = k->zz_n_per_mm,
        .lambda_min_n_per_mm = float_of(
            float_bits(least, (uint32_t)(160 + (int32_t)zeros - (int32_t)det_zeros - words.format) << 23)),
        .lambda_max_n_per_mm = float_of(float_bits(most, (uint32_t)(157 - words.format) << 23)),
        .stiff_axis_rad = fixed_axis_rad(apart, -xz, &radius, 0u),
        .flags = (uint32_t)det_high < high_unsigned(squared, SLENDER_BY_PLANE_Q32) ? BRACE_FLAG_NEAR_SINGULAR : 0u};
    return BRACE_OK;
}

/* The axis points outwards in the limb's plane, or to the left where it is across it. */
INLINE fixed3_t outwards_axis(fixed3_t axis)
{
    const int32_t sign = (axis.x + (axis.y >> 13)) >> 31; /* decides only where rounding would */
    return fixed3((axis.x ^ sign) - sign, (axis.y ^ sign) - sign, (axis.z ^ sign) - sign);
}

brace_status_t brace_loaded_space_fixed_turn(float theta0_rad, const brace_k3_t *k,
                                             brace_stiffness_spatial_t *stiffness)
{
    const uint32_t theta0 = bits_of(theta0_rad);
    if ((theta0 & INFINITE_BITS) == INFINITE_BITS) {
        return BRACE_E_NOT_FINITE;
    }
    k_words_t words;
    if (exponent_above(theta0) > 3 || fixed_of(theta0 & 0x7fffffffu, 28) > ANGLE_MOST_Q28) {
        return BRACE_E_RANGE;
    }
    if (!words_of(k, &words)) {
        return BRACE_E_SINGULAR;
    }
    /* With a diagonal above zero the eigenvalues, and what Jacobi's method meets on its way to them, lie less than
     * 3.7 times the largest entry apart; else up to 4.2 times, which a word does not hold. */
    if (words.k.xx <= 0 || words.k.yy <= 0 || words.k.zz <= 0) {
        return BRACE_E_SINGULAR;
    }
    fixed_jacobi_t j = {.m = words.k};
    fixed_jacobi(&j);
    const bool x_is_less = j.m.xx < j.m.yy;
    const int32_t low = x_is_less ? j.m.xx : j.m.yy, high = x_is_less ? j.m.yy : j.m.xx, zz = j.m.zz;
    const int32_t least = zz < low ? zz : low, most = zz > high ? zz : high;
    const int32_t middle = less(plus(plus(low, high), zz), plus(least, most));
    if (least <= 0) {
        return BRACE_E_SINGULAR;
    }
    const uint32_t z_is_most = (uint32_t)(zz > high), y_is_more = (uint32_t)x_is_less & (z_is_most - 1u);
    const fixed3_t axis = outwards_axis(j.axis[2u * z_is_most + y_is_more]);
    const fixed_vec_t yaw = fixed_direction(brace_turn_from_q28(fixed_of(theta0, 28)));
    fixed_sym3_t turned = words.k;
    fixed_sym3_about_z(&turned, yaw);
    const fixed3_t turned_axis = fixed_about_z(axis, yaw);
    const int32_t format = words.format;
    *stiffness = (brace_stiffness_spatial_t){
        .k_xx_n_per_mm = float_from(turned.xx, format), .k_xy_n_per_mm = float_from(turned.xy, format),
        .k_xz_n_per_mm = float_from(turned.xz, format), .k_yy_n_per_mm = float_from(turned.yy, format),
        .k_yz_n_per_mm = float_from(turned.yz, format), .k_zz_n_per_mm = k->zz_n_per_mm,
        .lambda_n_per_mm = {float_from(least, format), float_from(middle, format), float_from(most, format)},
        .stiff_axis = {float_from(turned_axis.x, 30), float_from(turned_axis.y, 30), float_from(turned_axis.z, 30)},
        .flags = (int64_t)least * SLENDER_PER_LEAST < most ? BRACE_FLAG_NEAR_SINGULAR : 0u};
    return BRACE_OK;
}
