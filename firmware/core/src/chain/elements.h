/* A limb's parameters as elements (brace/element.h), and beside them the compliance that is equal in every
 * direction. */
#ifndef BRACE_CORE_ELEMENTS_H
#define BRACE_CORE_ELEMENTS_H

#include "brace/element.h"
#include "brace/limb.h"

/* The coxa link, which lies along x and stands still in the limb's plane. The tip force has a moment about the hip, so
 * the link's second vector grows with the tip's lever. */
typedef struct {
    brace_vec_t ellipsoid;     /* [sqrt(mm/N)] */
    brace_vec_t moment;        /* [sqrt(mm/N)] */
    float moment_per_lever_mm; /* added to `moment` for each mm of the tip's lever about the hip [sqrt(mm/N)/mm] */
} brace_coxa_elements_t;

/* The limb has passed brace_limb_check. A function that returns a float returns the compliance of its parts that is
 * equal in every direction [mm/N]. */

float brace_elements_of_links(const brace_limb_t *limb, brace_element_t element[BRACE_LINK_ELEMENT_COUNT]);

/* All five elements. The springs are the limb's own. */
float brace_elements_of_limb(const brace_limb_t *limb, brace_element_t element[BRACE_ELEMENT_COUNT]);

float brace_elements_of_coxa(const brace_limb_t *limb, brace_coxa_elements_t *coxa);

/* more: the base's compliance along x beyond that along z, or the reverse, as a vector [sqrt(mm/N)]. */
float brace_elements_of_base(const brace_limb_t *limb, brace_vec_t *more);

/* The compliances of the limb's two springs in the plane, as in its parameters. */
static inline float brace_hip_rad_per_n_mm(const brace_limb_t *limb)
{
    return limb->joint[BRACE_FEMUR].compliance_rad_per_n_mm + limb->base.rotation_rad_per_n_mm;
}

static inline float brace_knee_rad_per_n_mm(const brace_limb_t *limb)
{
    return limb->joint[BRACE_TIBIA].compliance_rad_per_n_mm;
}

/* Splits an ellipsoid of two principal compliances into a vector along its longer axis and the compliance that is equal
 * in every direction. along: the axial direction, a unit vector. returns that compliance [mm/N] */
float brace_elements_split(float axial_mm_per_n, float bending_mm_per_n, brace_vec_t along, brace_vec_t *longer);

#endif
