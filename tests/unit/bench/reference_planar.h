/* K in the plane in double precision, by the sum C = a11 p1 p1' + ... of docs/physics.md: what the variants
 * are judged by. Shares nothing with the core. */
#ifndef REFERENCE_PLANAR_H
#define REFERENCE_PLANAR_H

#include <math.h>

#include "brace/limb.h"
#include "brace/stiffness.h"

typedef struct {
    double c_xx, c_xz, c_zz;
    double k_xx, k_xz, k_zz, lambda_min, lambda_max, axis_rad;
} reference_planar_t;

static inline void reference_add(reference_planar_t *r, double s, double ax, double az, double bx, double bz)
{
    r->c_xx += s * ax * bx;
    r->c_xz += 0.5 * s * (ax * bz + az * bx);
    r->c_zz += s * az * bz;
}

static inline void reference_ellipsoid(reference_planar_t *r, const brace_link_t *link, double angle)
{
    const double c = cos(angle + (double)link->tilt_rad), s = sin(angle + (double)link->tilt_rad);
    reference_add(r, (double)link->axial_mm_per_n, c, s, c, s);
    reference_add(r, (double)link->bending_mm_per_n, -s, c, -s, c);
}

static inline reference_planar_t reference_planar(const brace_limb_t *limb, double theta1, double theta2)
{
    const double l1 = (double)limb->femur_mm, l2 = (double)limb->tibia_mm, theta12 = theta1 - theta2;
    const brace_link_t *femur = &limb->link[BRACE_FEMUR];
    const double p2x = -l2 * sin(theta12), p2z = l2 * cos(theta12);
    const double p1x = p2x - l1 * sin(theta1), p1z = p2z + l1 * cos(theta1);
    reference_planar_t r = {(double)limb->base.x_mm_per_n, 0.0, (double)limb->base.z_mm_per_n, 0, 0, 0, 0, 0, 0};
    reference_ellipsoid(&r, femur, theta1);
    reference_ellipsoid(&r, &limb->link[BRACE_TIBIA], theta12);
    const double bent = (double)femur->bending_mm_per_n * (double)femur->moment_transfer;
    const double across = theta1 + (double)femur->tilt_rad;
    reference_add(&r, 3.0 * bent / l1, -sin(across), cos(across), p2x, p2z);
    reference_add(&r, 3.0 * bent / (l1 * l1), p2x, p2z, p2x, p2z);
    reference_add(&r,
                  (double)limb->joint[BRACE_FEMUR].compliance_rad_per_n_mm + (double)limb->base.rotation_rad_per_n_mm,
                  p1x, p1z, p1x, p1z);
    reference_add(&r, (double)limb->joint[BRACE_TIBIA].compliance_rad_per_n_mm, p2x, p2z, p2x, p2z);

    const double det = r.c_xx * r.c_zz - r.c_xz * r.c_xz;
    const double mean = 0.5 * (r.c_xx + r.c_zz), dev = hypot(0.5 * (r.c_xx - r.c_zz), r.c_xz);
    r.k_xx = r.c_zz / det;
    r.k_xz = -r.c_xz / det;
    r.k_zz = r.c_xx / det;
    r.lambda_min = 1.0 / (mean + dev);
    r.lambda_max = (mean + dev) / det;
    r.axis_rad = 0.5 * atan2(-2.0 * r.c_xz, r.c_zz - r.c_xx);
    return r;
}

/* Worst of K over lambda_max and of both eigenvalues, relative. */
static inline double reference_error(const reference_planar_t *r, const brace_stiffness_t *k)
{
    double worst = fabs((double)k->k_xx_n_per_mm - r->k_xx) / r->lambda_max;
    worst = fmax(worst, fabs((double)k->k_xz_n_per_mm - r->k_xz) / r->lambda_max);
    worst = fmax(worst, fabs((double)k->k_zz_n_per_mm - r->k_zz) / r->lambda_max);
    worst = fmax(worst, fabs((double)k->lambda_min_n_per_mm / r->lambda_min - 1.0));
    return fmax(worst, fabs((double)k->lambda_max_n_per_mm / r->lambda_max - 1.0));
}

/* How far the axis is off, less where C is nearly round and its own rounding turns it further. */
static inline double reference_axis_error(const reference_planar_t *r, const brace_stiffness_t *k)
{
    const double pi = 3.14159265358979324;
    const double off = (double)k->stiff_axis_rad - r->axis_rad;
    return fabs(off - pi * floor(off / pi + 0.5)) * (1.0 - r->lambda_min / r->lambda_max);
}

#endif
