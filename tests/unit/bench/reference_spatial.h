/* K in space in double precision, from three-dimensional levers: every source of compliance moves the tip
 * along one direction or turns it about one axis. Shares nothing with the core. */
#ifndef REFERENCE_SPATIAL_H
#define REFERENCE_SPATIAL_H

#include <math.h>

#include "brace/limb.h"

typedef struct {
    double x, y, z;
} reference_vec_t;

typedef struct {
    double c[3][3], k[3][3], det_c;
} reference_spatial_t;

static inline reference_vec_t reference_cross(reference_vec_t a, reference_vec_t b)
{
    return (reference_vec_t){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static inline reference_vec_t reference_in_plane(double angle)
{
    return (reference_vec_t){cos(angle), 0.0, sin(angle)};
}

static inline void reference_dyad(reference_spatial_t *r, double s, reference_vec_t a, reference_vec_t b)
{
    const double u[3] = {a.x, a.y, a.z}, v[3] = {b.x, b.y, b.z};
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            r->c[i][j] += 0.5 * s * (u[i] * v[j] + v[i] * u[j]);
        }
    }
}

static inline void reference_turning(reference_spatial_t *r, float s, reference_vec_t axis, reference_vec_t arm)
{
    const reference_vec_t lever = reference_cross(axis, arm);
    reference_dyad(r, (double)s, lever, lever);
}

/* A uniform beam that bends towards `across` about `axis`, a unit vector, with the tip at `arm` beyond its
 * end. */
static inline void reference_bending(reference_spatial_t *r, double b, double kappa, double length,
                                     reference_vec_t across, reference_vec_t axis, reference_vec_t arm)
{
    const reference_vec_t lever = reference_cross(axis, arm);
    reference_dyad(r, b, across, across);
    if (kappa > 0.0) {
        reference_dyad(r, 3.0 * b * kappa / length, across, lever);
        reference_dyad(r, 3.0 * b * kappa / (length * length), lever, lever);
    }
}

static inline void reference_link(reference_spatial_t *r, const brace_link_t *link, double length, double angle,
                                  reference_vec_t arm, double kappa)
{
    const reference_vec_t own = reference_in_plane(angle), y = {0.0, 1.0, 0.0}, minus_y = {0.0, -1.0, 0.0};
    const double tilted = angle + (double)link->tilt_rad;
    reference_dyad(r, (double)link->axial_mm_per_n, reference_in_plane(tilted), reference_in_plane(tilted));
    reference_bending(r, (double)link->bending_mm_per_n, kappa, length,
                      reference_in_plane(tilted + 1.57079632679489662), minus_y, arm);
    reference_bending(r, (double)link->lateral_mm_per_n, kappa, length, y, reference_cross(own, y), arm);
    reference_turning(r, link->torsion_rad_per_n_mm, own, arm);
}

static inline void reference_invert(reference_spatial_t *r)
{
    double cofactor[3][3];
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            const int a = (i + 1) % 3, b = (i + 2) % 3, p = (j + 1) % 3, q = (j + 2) % 3;
            cofactor[i][j] = r->c[a][p] * r->c[b][q] - r->c[a][q] * r->c[b][p];
        }
    }
    r->det_c = r->c[0][0] * cofactor[0][0] + r->c[0][1] * cofactor[0][1] + r->c[0][2] * cofactor[0][2];
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            r->k[i][j] = cofactor[j][i] / r->det_c;
        }
    }
}

static inline reference_spatial_t reference_spatial(const brace_limb_t *limb, double theta0, double theta1,
                                                    double theta2)
{
    const double l0 = (double)limb->coxa_mm, l1 = (double)limb->femur_mm, l2 = (double)limb->tibia_mm;
    const brace_link_t *link = limb->link;
    const reference_vec_t femur = reference_in_plane(theta1), tibia = reference_in_plane(theta1 - theta2);
    const reference_vec_t shank = {l2 * tibia.x, 0.0, l2 * tibia.z};
    const reference_vec_t tip = {l1 * femur.x + shank.x, 0.0, l1 * femur.z + shank.z};
    const reference_vec_t from_yaw = {l0 + tip.x, 0.0, tip.z}, none = {0.0, 0.0, 0.0};
    const reference_vec_t x = {1.0, 0.0, 0.0}, y = {0.0, 1.0, 0.0}, z = {0.0, 0.0, 1.0};
    reference_spatial_t flat = {{{0}}, {{0}}, 0.0}, r = flat;
    reference_turning(&flat, limb->joint[BRACE_COXA].compliance_rad_per_n_mm, z, from_yaw);
    reference_turning(&flat, limb->joint[BRACE_FEMUR].compliance_rad_per_n_mm, y, tip);
    reference_turning(&flat, limb->base.rotation_rad_per_n_mm, y, tip);
    reference_turning(&flat, limb->joint[BRACE_TIBIA].compliance_rad_per_n_mm, y, shank);
    reference_link(&flat, &link[BRACE_COXA], l0, 0.0, tip, (double)link[BRACE_COXA].moment_transfer);
    reference_link(&flat, &link[BRACE_FEMUR], l1, theta1, shank, (double)link[BRACE_FEMUR].moment_transfer);
    reference_link(&flat, &link[BRACE_TIBIA], l2, theta1 - theta2, none, 0.0);
    reference_dyad(&flat, (double)limb->base.x_mm_per_n, x, x);
    reference_dyad(&flat, (double)limb->base.z_mm_per_n, z, z);

    const double turn[3][3] = {{cos(theta0), -sin(theta0), 0}, {sin(theta0), cos(theta0), 0}, {0, 0, 1}};
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            for (int p = 0; p < 9; p++) {
                r.c[i][j] += turn[i][p / 3] * flat.c[p / 3][p % 3] * turn[j][p % 3];
            }
        }
    }
    reference_invert(&r);
    return r;
}

#endif
