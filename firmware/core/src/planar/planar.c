#include "brace/planar.h"

#include "planar/planar_tables.h"
#include "base/turn.h"

/* Straight-line code, in an order of operations that GCC turns into few instructions for ARMv7E-M: sums of 64-bit
 * products of 32-bit factors (one smlal each), only high words used. */
#define PRODUCT(a, b) ((int64_t)(int32_t)(a) * (int32_t)(b))
#define HIGH(sum) ((int32_t)(uint32_t)((uint64_t)(sum) >> 32))

/* 2^29 units are one turn: from radians q28, 2^29/(2 pi) * 16 by high words. 2^23 units are one table entry. */
#define TURN_PER_RAD 1367130551
#define HALF_ENTRY 0x00400000u

/* Of d q31, where 1 is half an entry, pi/64, and e = d^2 q30: sin q31 = d (SIN_D - e SIN_D3), 1 - cos q31 =
 * e VERSIN_D2, the best parabola for it, error 4e-8 and none at the entry itself. */
#define SIN_D 210828714
#define SIN_D3 338671
#define VERSIN_D2 10347309
#define ONE_Q31 0x7fffffff

/* Sine and cosine q30 of a fraction of a turn. */
static inline brace_sincos_t sincos_q30(const brace_planar_t *planar, uint32_t turn)
{
    const uint32_t entry = 2u * ((turn + HALF_ENTRY) >> 23 & (BRACE_TURN_TABLE_SIZE - 1));
    const int32_t sin = planar->sine[entry], cos = planar->cosine[entry];
    const int32_t d = (int32_t)(turn << 9);
    const int32_t e = HIGH(PRODUCT(d, d));
    const int32_t versin_d = HIGH(PRODUCT(e, VERSIN_D2));
    const int32_t sin_d = HIGH(PRODUCT(d, SIN_D - HIGH(PRODUCT(e, SIN_D3))));
    const int32_t cos_d = ONE_Q31 - versin_d;
    return (brace_sincos_t){HIGH(PRODUCT(sin, cos_d) + PRODUCT(cos, sin_d)),
                            HIGH(PRODUCT(cos, cos_d) + PRODUCT(sin, -sin_d))};
}

static inline int32_t harmonic(const brace_planar_harmonic_t *h, brace_sincos_t knee)
{
    const int64_t sum = h->start + PRODUCT(h->per_sin, knee.sin);
    return HIGH(sum + PRODUCT(h->start, knee.cos));
}

/* Half the angle whose tangent of the half is t (q31), turned by a right angle for dev_x > 0; rad q29. */
static inline int32_t axis(const brace_planar_t *planar, int32_t t, int32_t dev_x)
{
    const uintptr_t half = ((uint32_t)dev_x >> 31) * (sizeof(brace_axis_row_t) * BRACE_AXIS_ROWS / 2);
    const brace_axis_row_t *row =
        (const brace_axis_row_t *)((uintptr_t)((const brace_axis_row_t *)planar->axis + (t >> 28)) - half);
    const int32_t d = t & 0x0fffffff;
    const int32_t square = HIGH(row->c2_c3 + PRODUCT(row->c2_c3, d));
    const int32_t slope = (int32_t)row->c0_c1 + HIGH(PRODUCT(square, d));
    return HIGH(row->c0_c1 + PRODUCT(slope, d));
}

brace_status_t brace_planar_stiffness(const brace_planar_t *planar, float theta1_rad, float theta2_rad,
                                      brace_stiffness_t *stiffness)
{
    const float reach = theta1_rad * theta1_rad + theta2_rad * theta2_rad;
    if (!(reach <= BRACE_PLANAR_REACH_RAD2)) {
        return reach <= 3.4028234e38f ? BRACE_E_RANGE : BRACE_E_NOT_FINITE;
    }
    const uint32_t knee_turn = (uint32_t)HIGH(PRODUCT(theta2_rad * 0x1p28f, TURN_PER_RAD));
    const uint32_t femur_turn = (uint32_t)HIGH(PRODUCT(theta1_rad * 0x1p28f, TURN_PER_RAD));

    /* In the frame of the bisector. */
    const brace_sincos_t knee = sincos_q30(planar, knee_turn);
    const int32_t x = harmonic(&planar->dev_x, knee);
    const int32_t y = harmonic(&planar->dev_y, knee);
    const float mean = (float)harmonic(&planar->mean, knee);
    const float cross = (float)harmonic(&planar->cross, knee);

    /* Into the world's frame. Never zero, so that the axis of a round C is some axis. */
    const brace_sincos_t to_world = sincos_q30(planar, 2u * femur_turn - knee_turn);
    const int32_t world_x = HIGH(PRODUCT(x, to_world.cos) + PRODUCT(y, -to_world.sin)) | 1;
    const float dev_x = (float)world_x;
    const float dev_y = (float)HIGH(PRODUCT(x, to_world.sin) + PRODUCT(y, to_world.cos));

    const float rest = __builtin_fmaf(mean, planar->rest_per_mean, planar->rest);
    const float det = __builtin_fmaf(cross, cross, rest);
    const float radius = __builtin_sqrtf(__builtin_fmaf(dev_y, dev_y, dev_x * dev_x));
    const float longest = mean + radius;
    const float along = radius + __builtin_fabsf(dev_x);

    /* One division for 1/det, 1/longest and dev_y/along. */
    const float product = det * longest;
    const float inverse = planar->per_unit_n_per_mm / (product * along);
    const float per_product = inverse * along;
    const float per_det = per_product * longest;
    const float half_slope = dev_y * product * inverse * planar->slope_per_unit;

    stiffness->flags = 0;
    stiffness->lambda_min_n_per_mm = per_product * det;
    stiffness->lambda_max_n_per_mm = per_det * longest;
    stiffness->k_xx_n_per_mm = (mean - dev_x) * per_det;
    stiffness->k_zz_n_per_mm = (mean + dev_x) * per_det;
    stiffness->k_xz_n_per_mm = -(dev_y * per_det);
    stiffness->stiff_axis_rad = (float)axis(planar, (int32_t)half_slope, world_x) * 0x1p-29f;
    return BRACE_OK;
}
