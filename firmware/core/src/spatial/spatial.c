#include "brace/spatial.h"

#include <stddef.h>

#include "base/check.h"
#include "brace/kinematics.h"
#include "base/trig.h"
#include "base/vec.h"

#define fma __builtin_fmaf

/* det C over mean^2 in the plane below which K's error can reach 1e-5 of lambda_max; measured: 2.1e-7 over
 * its root. */
#define SLENDER 6e-4f

/* A symmetric 2 by 2 matrix mean I + [[dev_x, dev_y], [dev_y, -dev_x]] and its determinant. */
typedef struct {
    float mean, dev_x, dev_y, det;
} plane_t;

/* The plane's posture. */
typedef struct {
    brace_vec_t turn2;  /* direction of twice the bisector's angle */
    brace_vec_t tip_mm; /* from the femur's axis */
    float sin_knee, one_plus_cos_knee;
} posture_t;

static inline brace_vec_t direction_product(brace_vec_t a, brace_vec_t b)
{
    return (brace_vec_t){fma(a.x, b.x, -(a.z * b.z)), fma(a.x, b.z, a.z * b.x)};
}

/* From the bisector and half the knee angle: both small numbers at the folded knee stay exact. */
static inline posture_t posture_of(const brace_spatial_t *s, float theta1_rad, float theta2_rad)
{
    const uint32_t half_turn = (uint32_t)((int32_t)brace_turn(theta2_rad) / 2);
    const brace_vec_t half = brace_direction(half_turn);
    const brace_vec_t bisector = brace_direction(brace_turn(theta1_rad) - half_turn);
    const brace_vec_t femur = direction_product(bisector, half);
    const brace_vec_t tibia = direction_product(bisector, (brace_vec_t){half.x, -half.z});
    return (posture_t){
        .turn2 = direction_product(bisector, bisector),
        .tip_mm = {fma(s->femur_mm, femur.x, s->tibia_mm * tibia.x),
                   fma(s->femur_mm, femur.z, s->tibia_mm * tibia.z)},
        .sin_knee = 2.0f * half.x * half.z,
        .one_plus_cos_knee = 2.0f * half.x * half.x,
    };
}

static inline float harmonic(const brace_harmonic_t *h, const posture_t *at)
{
    return fma(h->per_cos, at->one_plus_cos_knee, fma(h->per_sin, at->sin_knee, h->at_fold));
}

/* What femur, tibia and their joints give. */
static inline plane_t moving_part(const brace_harmonics_t *h, const posture_t *at)
{
    const brace_vec_t dev =
        direction_product((brace_vec_t){harmonic(&h->dev_x, at), harmonic(&h->dev_y, at)}, at->turn2);
    const float cross = harmonic(&h->cross, at);
    return (plane_t){harmonic(&h->mean, at), dev.x, dev.z, fma(cross, cross, harmonic(&h->rest, at))};
}

/* |adj(A) v|^2 + det A |v|^2 = 2 mean v' adj(A) v, in positive terms. */
static inline float adjugate_form(const plane_t *a, brace_vec_t v)
{
    const float x = fma(a->mean - a->dev_x, v.x, -(a->dev_y * v.z));
    const float z = fma(a->mean + a->dev_x, v.z, -(a->dev_y * v.x));
    return fma(x, x, fma(z, z, a->det * vec_dot(v, v)));
}

/* A + v v' + w w'. */
static inline plane_t with_still_part(const plane_t *a, brace_vec_t v, brace_vec_t w)
{
    const float cross = vec_cross(v, w);
    const float forms = (adjugate_form(a, v) + adjugate_form(a, w)) * (0.5f / a->mean);
    return (plane_t){
        fma(0.5f, vec_dot(v, v) + vec_dot(w, w), a->mean),
        fma(0.5f, fma(v.x, v.x, -(v.z * v.z)) + fma(w.x, w.x, -(w.z * w.z)), a->dev_x),
        fma(v.x, v.z, fma(w.x, w.z, a->dev_y)),
        fma(cross, cross, a->det + forms),
    };
}

static inline plane_t plane_of(const brace_spatial_t *s, const posture_t *at)
{
    const plane_t moving = moving_part(&s->plane, at);
    const brace_vec_t bent = {fma(-s->coxa_per_mm, at->tip_mm.z, s->coxa.x),
                              fma(s->coxa_per_mm, at->tip_mm.x, s->coxa.z)};
    return with_still_part(&moving, s->still, bent);
}

/* The compliance across the plane [mm/N]. */
static inline float across(const brace_spatial_t *s, const posture_t *at)
{
    const float reach = at->tip_mm.x, height = at->tip_mm.z, from_yaw = s->coxa_mm + reach;
    const float along = s->tibia_mm * (at->one_plus_cos_knee - 1.0f), aside = s->tibia_mm * at->sin_knee;
    float sum = s->across_mm_per_n;
    sum = fma(reach, fma(reach, s->across_per_reach[1], s->across_per_reach[0]), sum);
    sum = fma(along, fma(along, s->across_per_along[1], s->across_per_along[0]), sum);
    sum = fma(s->across_per_height2 * height, height, sum);
    sum = fma(s->across_per_aside2 * aside, aside, sum);
    return fma(s->yaw_rad_per_n_mm * from_yaw, from_yaw, sum);
}

/* Unit vector of the least compliance, x not negative; x for a matrix that is the same in every direction. */
static inline brace_vec_t stiff_direction(const plane_t *c, float radius)
{
    const float lever = radius + __builtin_fabsf(c->dev_x);
    const float scale = lever > 0.0f ? 1.0f / brace_length(lever, c->dev_y) : 0.0f;
    const float larger = lever * scale, smaller = -c->dev_y * scale;
    if (!(c->dev_x > 0.0f)) {
        return (brace_vec_t){lever > 0.0f ? larger : 1.0f, smaller};
    }
    return smaller < 0.0f ? (brace_vec_t){-smaller, -larger} : (brace_vec_t){smaller, larger};
}

static inline void sort(float least, float most, float other, float ascending[3])
{
    ascending[0] = other < least ? other : least;
    ascending[1] = other < least ? least : other > most ? most : other;
    ascending[2] = other > most ? other : most;
}

static brace_status_t check(float theta0_rad, float theta1_rad, float theta2_rad)
{
    const float angle[3] = {theta0_rad, theta1_rad, theta2_rad};
    brace_status_t status = BRACE_OK;
    for (int i = 0; i < 3 && status == BRACE_OK; i++) {
        status = brace_check_magnitude(angle[i], BRACE_ANGLE_LIMIT_RAD);
    }
    return status;
}

brace_status_t brace_spatial_stiffness(const brace_spatial_t *spatial, float theta0_rad, float theta1_rad,
                                       float theta2_rad, brace_stiffness_spatial_t *stiffness)
{
    if (spatial == NULL || stiffness == NULL) {
        return BRACE_E_NULL;
    }
    const brace_status_t status = check(theta0_rad, theta1_rad, theta2_rad);
    if (status != BRACE_OK) {
        return status;
    }
    const posture_t at = posture_of(spatial, theta1_rad, theta2_rad);
    const plane_t c = plane_of(spatial, &at);
    const float c_yy = across(spatial, &at);
    if (!(c.det > 0.0f && c_yy > 0.0f)) {
        return BRACE_E_SINGULAR;
    }
    const float radius = brace_length(c.dev_x, c.dev_y);
    const float per_det = 1.0f / c.det, side = 1.0f / c_yy;
    const float most = (c.mean + radius) * per_det;
    sort(1.0f / (c.mean + radius), most, side, stiffness->lambda_n_per_mm);

    const brace_vec_t yaw = brace_direction(brace_turn(theta0_rad));
    const float out = (c.mean - c.dev_x) * per_det, skew = -c.dev_y * per_det;
    stiffness->k_xx_n_per_mm = fma(out * yaw.x, yaw.x, side * yaw.z * yaw.z);
    stiffness->k_xy_n_per_mm = (out - side) * yaw.x * yaw.z;
    stiffness->k_xz_n_per_mm = skew * yaw.x;
    stiffness->k_yy_n_per_mm = fma(out * yaw.z, yaw.z, side * yaw.x * yaw.x);
    stiffness->k_yz_n_per_mm = skew * yaw.z;
    stiffness->k_zz_n_per_mm = (c.mean + c.dev_x) * per_det;

    const brace_vec_t stiff = stiff_direction(&c, radius);
    const int sideways = side > most;
    stiffness->stiff_axis[0] = sideways ? -yaw.z : stiff.x * yaw.x;
    stiffness->stiff_axis[1] = sideways ? yaw.x : stiff.x * yaw.z;
    stiffness->stiff_axis[2] = sideways ? 0.0f : stiff.z;
    stiffness->flags = c.det < SLENDER * c.mean * c.mean ? BRACE_FLAG_NEAR_SINGULAR : 0u;
    return BRACE_OK;
}
