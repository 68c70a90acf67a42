#include "brace/spatial.h"

#include <stddef.h>

#include "base/check.h"
#include "brace/kinematics.h"
#include "base/trig.h"
#include "chain/tensor.h"

#define fma __builtin_fmaf

/* det C over mean^2 in the plane below which K's error can reach 1e-5 of lambda_max; measured: 2.1e-7 over
 * its root. */
#define SLENDER 6e-4f

/* Added to a length [mm/N] that is divided by. */
#define NEARLY_NOTHING 1e-15f

/* Where the tip is in the plane. */
typedef struct {
    brace_vec_t tip_mm; /* from the femur's axis */
    float along_mm, aside_mm; /* from the knee, along and across the femur */
} reach_t;

static inline reach_t reach_of(const brace_spatial_t *s, const brace_posture_t *at)
{
    const brace_vec_t half = at->half;
    const brace_vec_t seen = {(s->femur_mm + s->tibia_mm) * half.x, (s->femur_mm - s->tibia_mm) * half.z};
    return (reach_t){
        .tip_mm = brace_turned(seen, at->bisector),
        .along_mm = s->tibia_mm * fma(2.0f * half.x, half.x, -1.0f),
        .aside_mm = s->tibia_mm * (2.0f * half.x * half.z),
    };
}

static inline float harmonic(const brace_harmonic_t *h, float one_plus_cos, float sin)
{
    return fma(h->per_cos, one_plus_cos, fma(h->per_sin, sin, h->at_fold));
}

/* Femur, tibia and their joints in the world's frame, and what yields equally in every direction of the plane:
 * det (A + iso I) = det A + iso (trace A + iso). */
static inline brace_tensor_t limb_of(const brace_harmonics_t *h, const brace_posture_t *at)
{
    const float one_plus_cos = 2.0f * at->half.x * at->half.x, sin = 2.0f * at->half.x * at->half.z;
    const float links = harmonic(&h->mean, one_plus_cos, sin), cross = harmonic(&h->cross, one_plus_cos, sin);
    const brace_vec_t seen = {harmonic(&h->dev_x, one_plus_cos, sin), harmonic(&h->dev_y, one_plus_cos, sin)};
    const brace_vec_t dev = brace_turned(seen, brace_doubled(at->bisector));
    const float mean = links + h->iso_mm_per_n, det = fma(cross, cross, harmonic(&h->rest, one_plus_cos, sin));
    return (brace_tensor_t){mean + dev.x, dev.z, mean - dev.x, fma(h->iso_mm_per_n, links + mean, det)};
}

/* And with them what stands still, and the coxa's moment transfer. */
static inline brace_tensor_t plane_of(const brace_spatial_t *s, const brace_posture_t *at, brace_vec_t tip_mm)
{
    const brace_coxa_t *coxa = &s->coxa;
    const brace_vec_t bent = {fma(-coxa->bent_per_mm, tip_mm.z, coxa->bent.x),
                              fma(coxa->bent_per_mm, tip_mm.x, coxa->bent.z)};
    const brace_vec_t more[3] = {coxa->excess, s->base, bent};
    brace_tensor_t c = limb_of(&s->plane, at);
    for (int i = 0; i < 3; i++) {
        c = brace_tensor_plus(c, more[i]);
    }
    return c;
}

static inline float aside_at(const brace_aside_t *link, float along_mm, float beside_mm)
{
    return fma(along_mm, fma(along_mm, link->per_mm2, link->per_mm), link->torsion * beside_mm * beside_mm);
}

/* The compliance across the plane [mm/N]. */
static inline float across(const brace_spatial_t *s, const reach_t *at)
{
    const float from_yaw = s->coxa_mm + at->tip_mm.x;
    return fma(s->yaw_rad_per_n_mm * from_yaw, from_yaw, s->across_mm_per_n) +
           aside_at(&s->aside[0], at->tip_mm.x, at->tip_mm.z) + aside_at(&s->aside[1], at->along_mm, at->aside_mm);
}

/* Unit vector of the least compliance, x not negative; x for a matrix that is the same in every direction. */
static inline brace_vec_t stiff_direction(float dev_x, float dev_y, float radius)
{
    const float longer = radius + __builtin_fabsf(dev_x) + NEARLY_NOTHING, shorter = __builtin_fabsf(dev_y);
    const float scale = 1.0f / brace_length(longer, shorter);
    const float x = scale * (dev_x > 0.0f ? shorter : longer), z = scale * (dev_x > 0.0f ? longer : shorter);
    return (brace_vec_t){x, dev_y > 0.0f ? -z : z};
}

/* The two in the plane, and the one across it between them, below or above. */
static inline void sort(float least, float most, float across, float ascending[3])
{
    const int below = across < least, above = across > most;
    ascending[0] = below ? across : least;
    ascending[1] = below ? least : above ? most : across;
    ascending[2] = above ? across : most;
}

static inline int usable(float angle_rad)
{
    return __builtin_fabsf(angle_rad) <= BRACE_ANGLE_LIMIT_RAD;
}

brace_status_t brace_spatial_stiffness(const brace_spatial_t *spatial, float theta0_rad, float theta1_rad,
                                       float theta2_rad, brace_stiffness_spatial_t *stiffness)
{
    if (spatial == NULL || stiffness == NULL) {
        return BRACE_E_NULL;
    }
    if (!(usable(theta0_rad) && usable(theta1_rad) && usable(theta2_rad))) {
        return brace_check_two(usable(theta0_rad) ? theta1_rad : theta0_rad, theta2_rad, BRACE_ANGLE_LIMIT_RAD);
    }
    brace_posture_t at;
    brace_posture(theta1_rad, theta2_rad, &at);
    const reach_t reach = reach_of(spatial, &at);
    const brace_tensor_t c = plane_of(spatial, &at, reach.tip_mm);
    const float c_yy = across(spatial, &reach);
    if (!(c.det > 0.0f && c_yy > 0.0f)) {
        return BRACE_E_SINGULAR;
    }
    const float mean = 0.5f * (c.xx + c.zz), dev_x = 0.5f * (c.xx - c.zz);
    const float radius = brace_length(dev_x, c.xz);
    const float per_det = 1.0f / c.det, side = 1.0f / c_yy;
    const float most = (mean + radius) * per_det;
    sort(1.0f / (mean + radius), most, side, stiffness->lambda_n_per_mm);

    const brace_vec_t yaw = brace_direction(brace_turn(theta0_rad));
    const float more = c.zz * per_det - side, skew = -c.xz * per_det; /* more: than aside, outwards */
    stiffness->k_xx_n_per_mm = fma(more * yaw.x, yaw.x, side);
    stiffness->k_xy_n_per_mm = more * yaw.x * yaw.z;
    stiffness->k_xz_n_per_mm = skew * yaw.x;
    stiffness->k_yy_n_per_mm = fma(more * yaw.z, yaw.z, side);
    stiffness->k_yz_n_per_mm = skew * yaw.z;
    stiffness->k_zz_n_per_mm = c.xx * per_det;

    const brace_vec_t stiff = stiff_direction(dev_x, c.xz, radius);
    const int sideways = side > most;
    stiffness->stiff_axis[0] = sideways ? -yaw.z : stiff.x * yaw.x;
    stiffness->stiff_axis[1] = sideways ? yaw.x : stiff.x * yaw.z;
    stiffness->stiff_axis[2] = sideways ? 0.0f : stiff.z;
    stiffness->flags = c.det < SLENDER * mean * mean ? BRACE_FLAG_NEAR_SINGULAR : 0u;
    return BRACE_OK;
}
