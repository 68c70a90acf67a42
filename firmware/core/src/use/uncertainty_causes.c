#include "brace/uncertainty_causes.h"

#include <math.h>
#include <stddef.h>

#include "base/eigen.h"
#include "base/trig.h"
#include "base/vec.h"
#include "brace/limb.h"

#define HALF_TURN_RAD 3.14159265f
#define NEAR_RATIO 0.05f

/* The causes, in the order of their numbers. */
enum {
    LINK_PARTS = 4,
    ANGLES = 0,            /* femur and tibia; that of the coxa joint is counted by brace_sigma_begin */
    LENGTHS = ANGLES + 2,  /* coxa, femur, tibia, and in this order below */
    LINKS = LENGTHS + BRACE_LINK_COUNT,
    JOINTS = LINKS + LINK_PARTS * BRACE_LINK_COUNT,
    BASE = JOINTS + BRACE_LINK_COUNT,
    CALIBRATION_GAIN = BASE + 3,
    SENSOR_GAIN = CALIBRATION_GAIN + 1
};
_Static_assert(SENSOR_GAIN + 1 == (int)BRACE_CAUSE_COUNT, "every cause has its number");

static bool add(float *value, float step)
{
    *value += step;
    return step != 0.0f;
}

static bool scale(float *value, float by_rel)
{
    return add(value, *value * by_rel);
}

static bool scale_spring(brace_loaded_joint_t *spring, float by_rel)
{
    const bool yields = scale(&spring->yields_by_rad_per_n_mm, by_rel);
    return scale(&spring->slope_rad_per_n_mm, by_rel) || yields;
}

/* A coxa link and what only acts across the plane play no part in it. */
static float *part_of_link(brace_limb_t *limb, uint32_t number, bool is_spatial)
{
    const uint32_t index = number / LINK_PARTS;
    brace_link_t *link = &limb->link[index];
    if (!is_spatial && (index == (uint32_t)BRACE_COXA || number % LINK_PARTS >= 2u)) {
        return NULL;
    }
    switch (number % LINK_PARTS) {
    case 0: return &link->axial_mm_per_n;
    case 1: return &link->bending_mm_per_n;
    case 2: return &link->lateral_mm_per_n;
    default: return &link->torsion_rad_per_n_mm;
    }
}

static float *part_of_base(brace_limb_t *limb, uint32_t number)
{
    switch (number) {
    case 0: return &limb->base.x_mm_per_n;
    case 1: return &limb->base.z_mm_per_n;
    default: return &limb->base.rotation_rad_per_n_mm;
    }
}

/* A sensor that reads too much makes every compliance too small. */
static bool change_all_compliances(brace_k_inputs_t *inputs, float by_rel)
{
    brace_limb_t *limb = &inputs->limb;
    for (uint32_t i = 0; i < (uint32_t)(LINK_PARTS * BRACE_LINK_COUNT); i++) {
        (void)scale(part_of_link(limb, i, true), by_rel);
    }
    for (uint32_t i = 0; i < 3u; i++) {
        (void)scale(part_of_base(limb, i), by_rel);
        (void)scale_spring(&inputs->spring[i], by_rel);
    }
    return by_rel != 0.0f;
}

static float *length_of(brace_limb_t *limb, uint32_t link)
{
    return link == (uint32_t)BRACE_COXA    ? &limb->coxa_mm
           : link == (uint32_t)BRACE_FEMUR ? &limb->femur_mm
                                           : &limb->tibia_mm;
}

bool brace_cause_change(uint32_t cause, bool is_spatial, brace_k_inputs_t *inputs)
{
    const brace_uncertainty_t *known = &inputs->limb.uncertainty;
    const float by_rel = BRACE_CAUSE_SIGMAS * known->compliance_rel;
    if (cause < (uint32_t)LENGTHS) {
        const uint32_t joint = cause - (uint32_t)ANGLES + (uint32_t)BRACE_FEMUR;
        return add(&inputs->angle_rad[joint], BRACE_CAUSE_SIGMAS * inputs->angle_sigma_rad[joint]);
    }
    if (cause < (uint32_t)LINKS) {
        const uint32_t link = cause - (uint32_t)LENGTHS;
        const bool plays_a_part = is_spatial || link != (uint32_t)BRACE_COXA;
        return plays_a_part && add(length_of(&inputs->limb, link), BRACE_CAUSE_SIGMAS * known->length_mm);
    }
    if (cause < (uint32_t)JOINTS) {
        float *part = part_of_link(&inputs->limb, cause - (uint32_t)LINKS, is_spatial);
        return part != NULL && scale(part, by_rel);
    }
    if (cause < (uint32_t)BASE) {
        const uint32_t joint = cause - (uint32_t)JOINTS;
        return (is_spatial || joint != (uint32_t)BRACE_COXA) && scale_spring(&inputs->spring[joint], by_rel);
    }
    if (cause < (uint32_t)CALIBRATION_GAIN) {
        return scale(part_of_base(&inputs->limb, cause - (uint32_t)BASE), by_rel);
    }
    if (cause == (uint32_t)CALIBRATION_GAIN) {
        const float gain_rel = BRACE_CAUSE_SIGMAS * known->gain_rel;
        return change_all_compliances(inputs, -gain_rel / (1.0f + gain_rel));
    }
    const float sensed_rel = BRACE_CAUSE_SIGMAS * inputs->sensor_gain_rel;
    const bool changes_x = scale(&inputs->tip_n.x, sensed_rel), changes_y = scale(&inputs->tip_n.y, sensed_rel);
    return scale(&inputs->tip_n.z, sensed_rel) || changes_x || changes_y;
}

static inline float square(float value)
{
    return value * value;
}

/* A change of K in space, seen in the robot's frame. */
static brace_k3_t turned(brace_k3_t k, brace_vec_t theta0)
{
    const float c = theta0.x, s = theta0.z, twice = 2.0f * c * s * k.xy_n_per_mm;
    return (brace_k3_t){.xx_n_per_mm = c * c * k.xx_n_per_mm - twice + s * s * k.yy_n_per_mm,
                        .xy_n_per_mm = c * s * (k.xx_n_per_mm - k.yy_n_per_mm) + (c * c - s * s) * k.xy_n_per_mm,
                        .xz_n_per_mm = c * k.xz_n_per_mm - s * k.yz_n_per_mm,
                        .yy_n_per_mm = s * s * k.xx_n_per_mm + twice + c * c * k.yy_n_per_mm,
                        .yz_n_per_mm = s * k.xz_n_per_mm + c * k.yz_n_per_mm,
                        .zz_n_per_mm = k.zz_n_per_mm};
}

/* Entries in the robot's frame. */
static void add_entries(brace_k3_t change, float factor, brace_space_sigma_t *variance)
{
    variance->k_xx_n_per_mm += square(factor * change.xx_n_per_mm);
    variance->k_xy_n_per_mm += square(factor * change.xy_n_per_mm);
    variance->k_xz_n_per_mm += square(factor * change.xz_n_per_mm);
    variance->k_yy_n_per_mm += square(factor * change.yy_n_per_mm);
    variance->k_yz_n_per_mm += square(factor * change.yz_n_per_mm);
    variance->k_zz_n_per_mm += square(factor * change.zz_n_per_mm);
}

static inline brace_vec3_t times(const brace_k3_t *k, brace_vec3_t v)
{
    return (brace_vec3_t){k->xx_n_per_mm * v.x + k->xy_n_per_mm * v.y + k->xz_n_per_mm * v.z,
                          k->xy_n_per_mm * v.x + k->yy_n_per_mm * v.y + k->yz_n_per_mm * v.z,
                          k->xz_n_per_mm * v.x + k->yz_n_per_mm * v.y + k->zz_n_per_mm * v.z};
}

static inline float dot(brace_vec3_t a, brace_vec3_t b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* Eigenvalues: each changes by what the change of K is along its own axis. Two that are nearly equal share a plane of
 * axes, and the change may turn the axes within it: what it is between them counts for both. */
static void add_eigenvalues(const brace_k_base_t *base, const brace_k3_t *change, float factor,
                            brace_space_sigma_t *variance)
{
    for (int i = 0; i < 3; i++) {
        const brace_vec3_t moved = times(change, base->axis[i]);
        variance->lambda_n_per_mm[i] += square(factor * dot(moved, base->axis[i]));
        if (i < 2 && base->is_near_next[i]) {
            const float between = square(factor * dot(moved, base->axis[i + 1]));
            variance->lambda_n_per_mm[i] += between;
            variance->lambda_n_per_mm[i + 1] += between;
        }
    }
}

static void swap_if_above(float *low, float *high, brace_vec3_t *axis_low, brace_vec3_t *axis_high)
{
    if (*low > *high) {
        const float value = *low;
        const brace_vec3_t axis = *axis_low;
        *low = *high;
        *high = value;
        *axis_low = *axis_high;
        *axis_high = axis;
    }
}

static void find_axes(brace_k_base_t *base)
{
    const brace_k3_t *k = &base->space;
    brace_jacobi_t m;
    brace_jacobi(k, &m);
    swap_if_above(&m.xx, &m.yy, &m.x, &m.y);
    swap_if_above(&m.yy, &m.zz, &m.y, &m.z);
    swap_if_above(&m.xx, &m.yy, &m.x, &m.y);
    base->axis[0] = m.x;
    base->axis[1] = m.y;
    base->axis[2] = m.z;
    base->is_near_next[0] = m.yy - m.xx < NEAR_RATIO * m.zz;
    base->is_near_next[1] = m.zz - m.yy < NEAR_RATIO * m.zz;
}

void brace_k_base_find(const brace_stiffness_t *plane, const brace_k3_t *space, float theta0_rad, bool is_spatial,
                       brace_k_base_t *base)
{
    base->plane = *plane;
    base->is_spatial = is_spatial;
    if (is_spatial) {
        base->space = *space;
        base->theta0 = brace_direction(theta0_rad);
        find_axes(base);
    }
}

void brace_sigma_begin(const brace_k_base_t *base, float theta0_sigma_rad, brace_k_sigma_t *variance)
{
    *variance = (brace_k_sigma_t){0};
    if (base->is_spatial) {
        const brace_k3_t k = turned(base->space, base->theta0);
        const brace_k3_t by_theta0 = {.xx_n_per_mm = -2.0f * k.xy_n_per_mm,
                                      .xy_n_per_mm = k.xx_n_per_mm - k.yy_n_per_mm,
                                      .xz_n_per_mm = -k.yz_n_per_mm,
                                      .yy_n_per_mm = 2.0f * k.xy_n_per_mm,
                                      .yz_n_per_mm = k.xz_n_per_mm,
                                      .zz_n_per_mm = 0.0f};
        add_entries(by_theta0, theta0_sigma_rad, &variance->space);
    }
}

/* The angle between two axes, each in [-pi/2, pi/2]. */
static float between_axes_rad(float one_rad, float other_rad)
{
    const float apart_rad = fabsf(one_rad - other_rad);
    return apart_rad > HALF_TURN_RAD - apart_rad ? HALF_TURN_RAD - apart_rad : apart_rad;
}

void brace_sigma_add(const brace_k_base_t *base, const brace_stiffness_t *plane, const brace_k3_t *space,
                     float by_sigmas, brace_k_sigma_t *variance)
{
    const brace_stiffness_t *k = &base->plane;
    const float factor = 1.0f / by_sigmas;
    brace_stiffness_sigma_t *of = &variance->plane;
    of->k_xx_n_per_mm += square(factor * (plane->k_xx_n_per_mm - k->k_xx_n_per_mm));
    of->k_xz_n_per_mm += square(factor * (plane->k_xz_n_per_mm - k->k_xz_n_per_mm));
    of->k_zz_n_per_mm += square(factor * (plane->k_zz_n_per_mm - k->k_zz_n_per_mm));
    of->lambda_min_n_per_mm += square(factor * (plane->lambda_min_n_per_mm - k->lambda_min_n_per_mm));
    of->lambda_max_n_per_mm += square(factor * (plane->lambda_max_n_per_mm - k->lambda_max_n_per_mm));
    of->stiff_axis_rad += square(factor * between_axes_rad(plane->stiff_axis_rad, k->stiff_axis_rad));
    if (base->is_spatial) {
        const brace_k3_t *b = &base->space;
        const brace_k3_t change = {
            space->xx_n_per_mm - b->xx_n_per_mm, space->xy_n_per_mm - b->xy_n_per_mm,
            space->xz_n_per_mm - b->xz_n_per_mm, space->yy_n_per_mm - b->yy_n_per_mm,
            space->yz_n_per_mm - b->yz_n_per_mm, space->zz_n_per_mm - b->zz_n_per_mm,
        };
        add_entries(turned(change, base->theta0), factor, &variance->space);
        add_eigenvalues(base, &change, factor, &variance->space);
        variance->space.across_n_per_mm += square(factor * change.yy_n_per_mm);
    }
}

void brace_sigma_add_scaled(const brace_k_sigma_t *more, float factor, brace_k_sigma_t *variance)
{
    const brace_stiffness_sigma_t *p = &more->plane;
    const brace_space_sigma_t *s = &more->space;
    variance->plane.k_xx_n_per_mm += factor * p->k_xx_n_per_mm;
    variance->plane.k_xz_n_per_mm += factor * p->k_xz_n_per_mm;
    variance->plane.k_zz_n_per_mm += factor * p->k_zz_n_per_mm;
    variance->plane.lambda_min_n_per_mm += factor * p->lambda_min_n_per_mm;
    variance->plane.lambda_max_n_per_mm += factor * p->lambda_max_n_per_mm;
    variance->plane.stiff_axis_rad += factor * p->stiff_axis_rad;
    variance->space.k_xx_n_per_mm += factor * s->k_xx_n_per_mm;
    variance->space.k_xy_n_per_mm += factor * s->k_xy_n_per_mm;
    variance->space.k_xz_n_per_mm += factor * s->k_xz_n_per_mm;
    variance->space.k_yy_n_per_mm += factor * s->k_yy_n_per_mm;
    variance->space.k_yz_n_per_mm += factor * s->k_yz_n_per_mm;
    variance->space.k_zz_n_per_mm += factor * s->k_zz_n_per_mm;
    for (int i = 0; i < 3; i++) {
        variance->space.lambda_n_per_mm[i] += factor * s->lambda_n_per_mm[i];
    }
    variance->space.across_n_per_mm += factor * s->across_n_per_mm;
}

void brace_sigma_end(const brace_k_sigma_t *variance, brace_k_sigma_t *sigma)
{
    const brace_stiffness_sigma_t *p = &variance->plane;
    const brace_space_sigma_t *s = &variance->space;
    const float axis_rad = sqrtf(p->stiff_axis_rad);
    const bool is_known = axis_rad < BRACE_UNKNOWN_AXIS_RAD;
    *sigma = (brace_k_sigma_t){.plane = {.k_xx_n_per_mm = sqrtf(p->k_xx_n_per_mm),
                                         .k_xz_n_per_mm = sqrtf(p->k_xz_n_per_mm),
                                         .k_zz_n_per_mm = sqrtf(p->k_zz_n_per_mm),
                                         .lambda_min_n_per_mm = sqrtf(p->lambda_min_n_per_mm),
                                         .lambda_max_n_per_mm = sqrtf(p->lambda_max_n_per_mm),
                                         .stiff_axis_rad = is_known ? axis_rad : BRACE_UNKNOWN_AXIS_RAD,
                                         .flags = is_known ? 0u : (uint32_t)BRACE_FLAG_SATURATED},
                               .space = {.k_xx_n_per_mm = sqrtf(s->k_xx_n_per_mm),
                                         .k_xy_n_per_mm = sqrtf(s->k_xy_n_per_mm),
                                         .k_xz_n_per_mm = sqrtf(s->k_xz_n_per_mm),
                                         .k_yy_n_per_mm = sqrtf(s->k_yy_n_per_mm),
                                         .k_yz_n_per_mm = sqrtf(s->k_yz_n_per_mm),
                                         .k_zz_n_per_mm = sqrtf(s->k_zz_n_per_mm),
                                         .lambda_n_per_mm = {sqrtf(s->lambda_n_per_mm[0]), sqrtf(s->lambda_n_per_mm[1]),
                                                             sqrtf(s->lambda_n_per_mm[2])},
                                         .across_n_per_mm = sqrtf(s->across_n_per_mm)}};
}
