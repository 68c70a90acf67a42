/* What a stiffness means at a contact: sag under a load, force from a deflection, and whether a foot slides.
 *
 * Everything is taken at the tip, in the limb's plane, x outwards and z up. In the body's frame, a body that sags by s
 * moves the planted tip by -s. K times that displacement is the force that the ground puts on the tip.
 * Pure functions, no loop: any thread or interrupt. A refused call leaves its outputs untouched.
 */
#ifndef BRACE_CONTACT_H
#define BRACE_CONTACT_H

#include "brace/stiffness.h"

typedef struct {
    float x_n;
    float z_n;
} brace_force_t;

typedef struct {
    float x_mm;
    float z_mm;
} brace_displacement_t;

typedef struct {
    brace_force_t force;
    float magnitude_n;
    float low_n;  /* least force that any deflection of this size gives: lambda_min |d| */
    float high_n; /* largest force that any deflection of this size gives: lambda_max |d| */
} brace_contact_force_t;

typedef enum {
    BRACE_CONTACT_HOLDS = 0, /* inside the friction cone or on it */
    BRACE_CONTACT_SLIDES = 1,
    BRACE_CONTACT_LIFTS = 2 /* the tip does not press against the surface */
} brace_contact_state_t;

typedef struct {
    float normal_n;       /* force along the surface's normal; > 0 presses */
    float tangent_n;      /* force along the surface, >= 0 */
    float margin_n;       /* mu normal - tangent: force that may be added along the surface before the tip slides */
    float angle_left_rad; /* from the force to the edge of the cone; negative outside, 0 without any force */
    brace_contact_state_t state;
} brace_contact_grip_t;

/* Displacement of the tip under a force on it: d = C f. Sag under a payload of weight W: f = (0, -W).
 *   stiffness: K at the posture; load [+-1e6 N]
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_NOT_FINITE, BRACE_E_RANGE (a load outside its range; eigenvalues
 *   that are not positive and in order; an entry of K beyond 1e12 N/mm)
 * accuracy: 5e-6 |f| / lambda_min, for the K of any of the core's planar paths.
 * cost: at most 160 instructions on a Cortex-M4F; stack at most 100 bytes. */
brace_status_t brace_contact_sag(const brace_stiffness_t *stiffness, brace_force_t load, brace_displacement_t *sag);

/* Force on the tip that holds it at a displacement: f = K d, with the bounds of the paper's eq. 2.
 *   stiffness: K at the posture; displacement [+-1e4 mm]
 * returns as brace_contact_sag
 * accuracy: 5e-6 lambda_max |d|; low <= magnitude <= high, because the magnitude is limited to what K can give.
 * cost: at most 180 instructions; stack at most 120 bytes. */
brace_status_t brace_contact_force(const brace_stiffness_t *stiffness, brace_displacement_t displacement,
                                   brace_contact_force_t *contact);

/* How far a force on the tip is from sliding: the friction cone of the paper's Fig. 2.
 *   force [+-1e6 N]: of the surface on the tip
 *   normal_x, normal_z: unit vector out of the surface, towards the limb; length [0.99, 1.01], normalised inside
 *   friction_ratio [0, 10]: mu
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_NOT_FINITE, BRACE_E_RANGE. A foot that slides or lifts is no refusal; it is a
 *   result, and grip->state holds it.
 * accuracy: forces 5e-7 |f|, margin 5e-7 (1 + mu) |f|, angle 7e-7 rad.
 * cost: at most 180 instructions; stack at most 60 bytes. */
brace_status_t brace_contact_grip(brace_force_t force, float normal_x, float normal_z, float friction_ratio,
                                  brace_contact_grip_t *grip);

#endif
