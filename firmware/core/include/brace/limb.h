/* The limb as its calibration describes it: lengths, compliances, and how far each is trusted.
 *
 * Units: mm, N, N mm, rad. Frames and signs: docs/physics.md. One block of plain floats, so that the
 * model file, the parameter block on the controller and the simulation carry the same facts.
 */
#ifndef BRACE_LIMB_H
#define BRACE_LIMB_H

#include "brace/status.h"

/* The three links and, by the same index, the joint at the near end of each. */
enum { BRACE_COXA = 0, BRACE_FEMUR = 1, BRACE_TIBIA = 2, BRACE_LINK_COUNT = 3 };

/* A link's compliance ellipsoid: principal compliances of its far end under a force there, link clamped
 * at its near end. All [0, 1e3]; zero is rigid. */
typedef struct {
    float axial_mm_per_n;        /* along the link (turned by tilt_rad) */
    float bending_mm_per_n;      /* across the link, in the limb's plane */
    float tilt_rad;              /* turn of the ellipsoid's axes from the link's, in the plane [-pi/2, pi/2] */
    float lateral_mm_per_n;      /* out of the limb's plane; spatial only */
    float torsion_rad_per_n_mm;  /* about the link's axis; spatial only */
    float moment_transfer_ratio; /* strength of the uniform-beam coupling of force and moment [0, 1] */
} brace_link_t;

typedef struct {
    float compliance_rad_per_n_mm; /* gearbox and servo, about the joint's axis [0, 1] */
    float gap_rad;                 /* full width of the play [0, 0.5] */
    float zero_offset_rad;         /* true angle = commanded + offset [-0.5, 0.5] */
} brace_joint_t;

typedef struct {
    float x_mm_per_n;            /* [0, 1e3] */
    float z_mm_per_n;            /* [0, 1e3] */
    float rotation_rad_per_n_mm; /* about the femur joint's axis [0, 1] */
} brace_base_t;

/* One sigma of what the calibration is trusted to. */
typedef struct {
    float length_mm;      /* [0, 100] */
    float angle_rad;      /* [0, 0.5] */
    float compliance_rel; /* [0, 1] */
    float gain_rel;       /* [0, 1] */
} brace_uncertainty_t;

typedef struct {
    float coxa_mm;  /* [0, 1e4] */
    float femur_mm; /* [1, 1e4] */
    float tibia_mm; /* [1, 1e4] */
    brace_link_t link[BRACE_LINK_COUNT];
    brace_joint_t joint[BRACE_LINK_COUNT];
    brace_base_t base;
    brace_uncertainty_t uncertainty;
} brace_limb_t;

/* Is this a limb that can exist? Every field finite and in its range, and something yields in each
 * direction of the plane; a coxa that passes moments on is at least 1 mm long.
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_NOT_FINITE, BRACE_E_PARAMETER */
brace_status_t brace_limb_check(const brace_limb_t *limb);

/* The angle of joint `index` (BRACE_COXA..BRACE_TIBIA) for a commanded one [rad]. */
float brace_limb_true_angle(const brace_limb_t *limb, int index, float commanded_rad);

#endif
