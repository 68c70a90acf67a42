#include "chain/elements.h"

#include <float.h>
#include <math.h>

#include "base/trig.h"
#include "base/vec.h"

/* A vector from a part that turns with the femur and a part that turns with the tibia. The femur stands half the knee
 * angle ahead of the bisector, the tibia half the knee angle behind it. So at the straight knee the parts add; at the
 * folded knee each is turned by a quarter, and they oppose each other. */
static brace_element_t element_of(brace_vec_t femur, brace_vec_t tibia)
{
    return (brace_element_t){.straight = vec_plus(femur, tibia), .folded = vec_quarter(vec_minus(femur, tibia))};
}

/* Root of the bending that comes with the moment: 0.75 of the link's, times the strength of moment transfer. A uniform
 * cantilever of bending b has [[b, 1.5 b/L], [1.5 b/L, 3 b/L^2]] for force and moment. That is bending alone of b/4,
 * and one vector of root sqrt(0.75 b). */
static float moment_root(const brace_link_t *link)
{
    return sqrtf(0.75f * link->moment_transfer * link->bending_mm_per_n);
}

float brace_elements_split(float axial_mm_per_n, float bending_mm_per_n, brace_vec_t along, brace_vec_t *longer)
{
    const float more = bending_mm_per_n - axial_mm_per_n;
    *longer = vec_scaled(more > 0.0f ? vec_quarter(along) : along, sqrtf(fabsf(more)));
    return more > 0.0f ? axial_mm_per_n : bending_mm_per_n;
}

/* Splits a link's ellipsoid without the bending that comes with the moment. */
static float split(const brace_link_t *link, float root, brace_vec_t along, brace_vec_t *longer)
{
    return brace_elements_split(link->axial_mm_per_n, brace_fma(-root, root, link->bending_mm_per_n), along, longer);
}

float brace_elements_of_links(const brace_limb_t *limb, brace_element_t element[BRACE_LINK_ELEMENT_COUNT])
{
    const brace_link_t *femur = &limb->link[BRACE_FEMUR], *tibia = &limb->link[BRACE_TIBIA];
    const brace_vec_t none = {0.0f, 0.0f};
    const brace_vec_t along_femur = brace_direction(femur->tilt_rad), along_tibia = brace_direction(tibia->tilt_rad);
    const float root = moment_root(femur);
    brace_vec_t femur_longer, tibia_longer;
    const float iso_mm_per_n =
        split(femur, root, along_femur, &femur_longer) + split(tibia, 0.0f, along_tibia, &tibia_longer);
    const brace_vec_t bent = vec_scaled(vec_quarter(along_femur), root);
    const brace_vec_t bent_by_moment = {0.0f, 2.0f * root * limb->tibia_mm / limb->femur_mm};
    element[BRACE_FEMUR_ELLIPSOID] = element_of(femur_longer, none);
    element[BRACE_FEMUR_MOMENT] = element_of(bent, bent_by_moment);
    element[BRACE_TIBIA_ELLIPSOID] = element_of(none, tibia_longer);
    return iso_mm_per_n;
}

/* A joint's spring adds the root of its compliance times the lever of the tip force about the joint. */
float brace_elements_of_limb(const brace_limb_t *limb, brace_element_t element[BRACE_ELEMENT_COUNT])
{
    const brace_vec_t none = {0.0f, 0.0f};
    const float hip = sqrtf(brace_hip_rad_per_n_mm(limb)), knee = sqrtf(brace_knee_rad_per_n_mm(limb));
    const brace_vec_t hip_by_femur = {0.0f, hip * limb->femur_mm}, hip_by_tibia = {0.0f, hip * limb->tibia_mm};
    const brace_vec_t knee_by_tibia = {0.0f, knee * limb->tibia_mm};
    element[BRACE_HIP_SPRING] = element_of(hip_by_femur, hip_by_tibia);
    element[BRACE_KNEE_SPRING] = element_of(none, knee_by_tibia);
    return brace_elements_of_links(limb, element);
}

float brace_elements_of_coxa(const brace_limb_t *limb, brace_coxa_elements_t *coxa)
{
    const brace_link_t *link = &limb->link[BRACE_COXA];
    const brace_vec_t along = brace_direction(link->tilt_rad);
    const float root = moment_root(link);
    coxa->moment = vec_scaled(vec_quarter(along), root);
    coxa->moment_per_lever_mm = 2.0f * root / (limb->coxa_mm + FLT_MIN); /* a coxa of no length passes no moment on */
    return split(link, root, along, &coxa->ellipsoid);
}

float brace_elements_of_base(const brace_limb_t *limb, brace_vec_t *more)
{
    return brace_elements_split(limb->base.x_mm_per_n, limb->base.z_mm_per_n, (brace_vec_t){1.0f, 0.0f}, more);
}
