#include "brace/load_band.h"

#include <math.h>

#define LOCKED_RATIO 0.05f /* of a gear that no load turns back: its band has an end all the same */

/* The load at one end of what friction of this share lets it be; way: against which the friction stands, +1 or -1.
 * torque >= 0. A small torque leaves a load of the other sign, whose share grows the other way. */
static float load_n_mm(const brace_gear_t *gear, float torque_n_mm, float share, float way)
{
    const float signed_share = way * share, rubs_n_mm = signed_share * gear->friction_n_mm;
    const float by_torque_n_mm = signed_share * gear->per_torque_ratio * torque_n_mm;
    const float by_load = signed_share * gear->per_load_ratio, least = torque_n_mm - rubs_n_mm;
    const float divisor = 1.0f + by_load > LOCKED_RATIO ? 1.0f + by_load : LOCKED_RATIO;
    const float same_n_mm = (least - by_torque_n_mm) / divisor;
    if (same_n_mm >= 0.0f) {
        return same_n_mm;
    }
    const float other_divisor = 1.0f - by_load > LOCKED_RATIO ? 1.0f - by_load : LOCKED_RATIO;
    const float other_n_mm = (least + by_torque_n_mm) / other_divisor;
    return other_n_mm < same_n_mm ? other_n_mm : same_n_mm;
}

void brace_load_band(const brace_gear_t *gear, float torque_n_mm, float way, bool is_moving, brace_load_band_t *band)
{
    const float sense = copysignf(1.0f, torque_n_mm), size_n_mm = fabsf(torque_n_mm), turned = way * sense;
    const float tolerance = gear->tolerance_ratio, most = 1.0f + tolerance;
    float low_n_mm, high_n_mm, near_end = 0.0f;
    if (is_moving && way != 0.0f) {
        /* The tolerance counts whole: it stands also for viscosity, which the law leaves out. */
        const float least_n_mm = load_n_mm(gear, size_n_mm, gear->sliding_ratio * (1.0f - tolerance), turned);
        const float most_n_mm = load_n_mm(gear, size_n_mm, most, turned);
        low_n_mm = turned > 0.0f ? most_n_mm : least_n_mm;
        high_n_mm = turned > 0.0f ? least_n_mm : most_n_mm;
    } else {
        /* Friction that may be off by a factor from 1 - tolerance to 1 + tolerance moves the 90 % of an even band by
         * about a third of the tolerance's square. The end at which the joint came to stand has all of it. */
        const float even = 1.0f + 0.333f * tolerance * tolerance;
        low_n_mm = load_n_mm(gear, size_n_mm, turned > 0.0f ? most : even, 1.0f);
        high_n_mm = load_n_mm(gear, size_n_mm, turned < 0.0f ? most : even, -1.0f);
        near_end = -way;
    }
    const float low_size_n_mm = fabsf(low_n_mm), high_size_n_mm = fabsf(high_n_mm);
    low_n_mm -= gear->joint_n_mm + gear->joint_per_load_ratio * low_size_n_mm;
    high_n_mm += gear->joint_n_mm + gear->joint_per_load_ratio * high_size_n_mm;
    band->middle_n_mm = sense * 0.5f * (low_n_mm + high_n_mm);
    band->half_n_mm = 0.5f * (high_n_mm - low_n_mm);
    band->noise_n_mm = 0.0f;
    band->near_end = near_end;
}

/* How far inside the end of the sum of two bands this share of it lies beyond. wide >= narrow >= 0: half widths. share:
 * 0.05 or 0.1. The sum's density is a trapezoid. */
static float inside(float wide, float narrow, float share)
{
    return narrow >= 2.0f * share * wide ? sqrtf(8.0f * share * wide * narrow) : 2.0f * share * wide + narrow;
}

/* The middle, with noise added to the distances of both ends. */
static brace_interval_t around(float middle, float below, float above, float variance)
{
    const float noise = BRACE_NORMAL_90_SIGMAS * BRACE_NORMAL_90_SIGMAS * variance;
    return (brace_interval_t){middle - sqrtf(below * below + noise), middle + sqrtf(above * above + noise)};
}

brace_interval_t brace_load_band_alone(const brace_load_band_t *band)
{
    const float even_n_mm = band->half_n_mm * (1.0f - 2.0f * 0.05f);
    return around(band->middle_n_mm, band->near_end < 0.0f ? band->half_n_mm : even_n_mm,
                  band->near_end > 0.0f ? band->half_n_mm : even_n_mm, band->noise_n_mm * band->noise_n_mm);
}

brace_interval_t brace_load_band_sum(const brace_load_band_t *one, float one_ratio, const brace_load_band_t *two,
                                     float two_ratio, float middle)
{
    const float first = fabsf(one_ratio) * one->half_n_mm, second = fabsf(two_ratio) * two->half_n_mm;
    const float wide = first > second ? first : second, narrow = first > second ? second : first;
    const float noise_one = one_ratio * one->noise_n_mm, noise_two = two_ratio * two->noise_n_mm;
    /* Where the sum is, from its middle, if both joints still stand as they came to stand: many do. */
    const float came = copysignf(first, one_ratio) * one->near_end + copysignf(second, two_ratio) * two->near_end;
    float below = first + second - inside(wide, narrow, 0.05f), above = below;
    if (fabsf(came) > below) {
        const float far = first + second - inside(wide, narrow, 0.1f);
        below = came < 0.0f ? -came : far;
        above = came > 0.0f ? came : far;
    }
    return around(middle, below, above, noise_one * noise_one + noise_two * noise_two);
}
