#include "planar_constants.h"

#include "planar_tables.h"
#include "turn.h"
#include "vec.h"

/* What the tick's sine of a quarter turn is, q30. */
#define TICK_ONE 1073740799
#define TICK_ONE_Q30 (TICK_ONE / 1073741824.0f)

/* det C = per_mean mean + constant + cross^2. */
typedef struct {
    float per_mean, constant;
} rest_t;

/* Brings the rest into this form. Of a first harmonic beyond 2 iso mean, what stands across `cross` in the plane of
 * (1 + cos, sin) is taken up by more of the mean, what lies along it by shifting cross. */
static rest_t affine_rest(brace_harmonics_t *h)
{
    const float iso = h->iso_mm_per_n;
    const brace_vec_t mean = {h->mean.per_cos, h->mean.per_sin};
    const brace_vec_t cross = {h->cross.per_cos, h->cross.per_sin};
    const brace_vec_t beyond = {__builtin_fmaf(-2.0f * iso, mean.x, h->rest.per_cos),
                                __builtin_fmaf(-2.0f * iso, mean.z, h->rest.per_sin)};
    const float square = vec_dot(cross, cross);
    const float across = vec_cross(cross, beyond);
    const float rounding = 3e-7f * iso * (h->mean.at_fold + __builtin_fabsf(mean.x)) * __builtin_sqrtf(square);
    const float more = __builtin_fabsf(across) > rounding ? across / vec_cross(cross, mean) : 0.0f;
    const float along = vec_dot(cross, beyond) - more * vec_dot(cross, mean);
    const float shift = square > 0.0f ? 0.5f * along / square : 0.0f;
    const float per_mean = 2.0f * iso + more;
    const float constant =
        h->rest.at_fold - per_mean * h->mean.at_fold - shift * (2.0f * h->cross.at_fold + shift);
    h->cross.at_fold += shift;
    return (rest_t){per_mean, constant};
}

static float largest(float a, float b)
{
    return a > b ? a : b;
}

static float swing(const brace_harmonic_t *h)
{
    return __builtin_sqrtf(h->per_cos * h->per_cos + h->per_sin * h->per_sin);
}

/* Is the accuracy of the tick safe? Where rest could lose digits against its parts, at the mean's least and most, and
 * where det is least, at the zeros of cross: there an error of cross, from rounded constants and from the last place
 * of the tick, must stay well below the square root of the rest. */
static int accurate(const brace_harmonics_t *h, rest_t rest, float unit)
{
    const float mean_swing = swing(&h->mean);
    const float middle = h->mean.at_fold + h->mean.per_cos;
    const float least = h->mean.per_cos > 0.0f
                            ? h->mean.at_fold - h->mean.per_sin * h->mean.per_sin / (mean_swing + h->mean.per_cos)
                            : middle - mean_swing;
    const float low = rest.per_mean * least + rest.constant;
    const float high = rest.per_mean * (middle + mean_swing) + rest.constant;
    const float smaller = low < high ? low : high;
    const float error = 2.0f * unit + 6e-8f * (__builtin_fabsf(h->cross.per_cos) + __builtin_fabsf(h->cross.at_fold));
    return __builtin_fabsf(rest.constant) < 16.0f * smaller && least > 0.0f &&
           error < 2e-6f * __builtin_sqrtf(smaller) &&
           unit + 5e-8f * __builtin_fabsf(h->mean.per_cos) < 1.2e-6f * least;
}

/* The low word of start is the factor of the cosine; the high word makes up for it, and for the tick's rounding down. */
static brace_planar_harmonic_t fixed(const brace_harmonic_t *h, float units)
{
    const float units_per_one = units * (4.0f / TICK_ONE_Q30);
    const int32_t per_cos = (int32_t)(h->per_cos * units_per_one);
    const int64_t constant =
        (int32_t)(2.0f * h->at_fold * units) * (INT64_C(1) << 31) + (int64_t)per_cos * TICK_ONE;
    const uint32_t high = (uint32_t)((uint64_t)(constant + 0x100000000 - (uint32_t)per_cos) >> 32);
    return (brace_planar_harmonic_t){(int64_t)((uint64_t)high << 32 | (uint32_t)per_cos),
                                     (int32_t)(h->per_sin * units_per_one), 0};
}

brace_status_t brace_planar_constants(brace_harmonics_t *h, brace_planar_t *planar)
{
    const rest_t rest = affine_rest(h);

    /* Every factor below its word, the mean below two scales. */
    const float most = h->mean.at_fold + h->mean.per_cos + swing(&h->mean);
    const float scale = 1.001f * largest(0.51f * most, largest(swing(&h->dev_x), swing(&h->dev_y)));
    if (!(scale > 0.0f && scale < 1e9f)) {
        return BRACE_E_PARAMETER;
    }
    const float units = 0x1p27f / scale;
    if (!accurate(h, rest, 1.0f / units)) {
        return BRACE_E_UNSUPPORTED;
    }
    /* The deviators bring two bits more into the turn to the world's frame, which takes them again. */
    const brace_harmonic_t *from[] = {&h->mean, &h->dev_x, &h->dev_y, &h->cross};
    brace_planar_harmonic_t *to = &planar->mean;
    for (int i = 0; i < 4; i++) {
        to[i] = fixed(from[i], i == 1 || i == 2 ? units * (4.0f / TICK_ONE_Q30) : units);
    }
    planar->sine = &brace_turn_table[0].sin;
    planar->cosine = &brace_turn_table[0].cos;
    planar->axis = &brace_axis_table[BRACE_AXIS_MIDDLE];
    planar->rest_per_mean = rest.per_mean * units;
    planar->rest = rest.constant * units * units;
    planar->per_unit_n_per_mm = units;
    planar->slope_per_unit = 0x1p31f / units;
    return BRACE_OK;
}
