/* Straight-line code with more values in flight than registers: scheduling before registers are allotted costs
 * spills. */
#if defined(__arm__) && defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("no-schedule-insns")
#endif

#include "brace/planar.h"

#include "planar/planar_tables.h"
#include "base/turn.h"

/* Straight-line code, in an order of operations that GCC turns into few instructions for ARMv7E-M: sums of 64-bit
 * products of 32-bit factors (one smlal each), only high words used. */
#define PRODUCT BRACE_PRODUCT
#define HIGH BRACE_HIGH

/* 2^29 units are one turn: from radians q28, 2^29/(2 pi) * 16 by high words. 2^24 units are one table entry. */
#define TURN_PER_RAD 1367130551
#define HALF_ENTRY 0x00800000u

/* Minus sine and minus cosine of a fraction of a turn. */
static inline brace_sum_sincos_t opposite(const brace_planar_t *planar, uint32_t turn)
{
    const uint32_t entry = (turn + HALF_ENTRY) >> 24 & (BRACE_SINE_TABLE_SIZE - 1);
    return brace_opposite(planar->sine[entry], planar->cosine[entry], brace_off_entry((int32_t)(turn << 8)));
}

/* The sum starts from whatever low word is at hand: it weighs half a unit of the last place on average, which makes
 * up for taking the high word alone. */
static inline int64_t harmonic(int64_t any, const brace_planar_harmonic_t *h, brace_sum_sincos_t knee)
{
    const int64_t start = (int64_t)((uint64_t)(uint32_t)h->constant << 32 | (uint32_t)any);
    return start + PRODUCT(h->per_cos, HIGH(knee.cos)) + PRODUCT(h->per_sin, HIGH(knee.sin));
}

/* One step of a polynomial in t: c + t times the sum so far, by high words. As above it starts from the low word that
 * is at hand. */
static inline int64_t step(int32_t c, int64_t sum, int32_t t)
{
    return (int64_t)((uint64_t)(uint32_t)c << 32 | (uint32_t)sum) + PRODUCT(HIGH(sum), t);
}

/* pi/4 - atan t, rad q29. The tick's address of the table is one row short, so that no part of a row lies at it. */
static inline int32_t axis(const brace_planar_t *planar, int32_t t)
{
    const int32_t place = t >> 29;
    const uintptr_t row_before = (uintptr_t)((const brace_axis_row_t *)planar->axis + place);
    const brace_axis_row_t *row = (const brace_axis_row_t *)(row_before + sizeof(brace_axis_row_t));
    const int64_t c2_c3 = row->c2_c3, c0_c1 = row->c0_c1;
    const int64_t fourth = (int64_t)((uint64_t)(uint32_t)((uint32_t)c2_c3 << 16) << 32 | (uint32_t)place);
    const int64_t cubic = step((int32_t)c2_c3, fourth, t);
    return HIGH(step(HIGH(c0_c1), step((int32_t)c0_c1, step(HIGH(c2_c3), cubic, t), t), t));
}

brace_status_t brace_planar_stiffness(const brace_planar_t *planar, float theta1_rad, float theta2_rad,
                                      brace_stiffness_t *stiffness)
{
    const float reach = theta1_rad * theta1_rad + theta2_rad * theta2_rad;
    if (!(reach <= BRACE_PLANAR_REACH_RAD2)) {
        return reach - reach == 0.0f ? BRACE_E_RANGE : BRACE_E_NOT_FINITE;
    }
    const uint32_t knee_turn = (uint32_t)HIGH(PRODUCT(theta2_rad * 0x1p28f, TURN_PER_RAD));
    const uint32_t femur_turn = (uint32_t)HIGH(PRODUCT(theta1_rad * 0x1p28f, TURN_PER_RAD));
    const brace_sum_sincos_t to_world = opposite(planar, 2u * femur_turn - knee_turn);
    const brace_sum_sincos_t knee = opposite(planar, knee_turn);

    /* In the frame of the bisector: the mean in units, all else in quarters of a unit. */
    const int64_t cross_sum = harmonic(knee.cos, &planar->cross, knee);
    const int64_t x = harmonic(cross_sum, &planar->dev_x, knee);
    const float cross = (float)HIGH(cross_sum) * 0.25f;
    const int64_t mean_sum = harmonic(x, &planar->mean, knee);
    const float mean = (float)HIGH(mean_sum);
    const int64_t y = harmonic(mean_sum, &planar->dev_y, knee);

    /* Minus the deviator in the world's frame, in units. Never zero, so that the axis of a round C is some axis. */
    const int32_t world_y =
        HIGH(PRODUCT(HIGH(y), HIGH(to_world.cos)) + PRODUCT(HIGH(x), HIGH(to_world.sin))) | 1;
    const float dev_y = (float)world_y;
    const float dev_x =
        (float)HIGH(PRODUCT(HIGH(x), HIGH(to_world.cos)) + PRODUCT(HIGH(y), -HIGH(to_world.sin)));

    const float rest = __builtin_fmaf(mean, planar->rest_per_mean, planar->rest);
    const float det = __builtin_fmaf(cross, cross, rest);
    const float radius = __builtin_sqrtf(__builtin_fmaf(dev_y, dev_y, dev_x * dev_x));
    const float longest = mean + radius;
    const float along = radius + __builtin_fabsf(dev_y);

    /* One division for 1/det, 1/longest and dev_x/along. */
    const float product = det * longest;
    const float inverse = planar->per_unit_n_per_mm / (product * along);
    const float per_product = inverse * along;
    const float per_det = per_product * longest;
    const float half_slope = dev_x * product * inverse * planar->slope_per_unit;

    stiffness->lambda_min_n_per_mm = per_product * det;
    stiffness->lambda_max_n_per_mm = per_det * longest;
    stiffness->k_xx_n_per_mm = (mean + dev_x) * per_det;
    stiffness->k_zz_n_per_mm = (mean - dev_x) * per_det;
    stiffness->k_xz_n_per_mm = dev_y * per_det;
    /* Half the angle from 0 to pi, with the sign of dev_y. */
    stiffness->stiff_axis_rad = (float)(axis(planar, (int32_t)half_slope) ^ (world_y >> 31)) * 0x1p-29f;
    stiffness->flags = 0;
    return BRACE_OK;
}
