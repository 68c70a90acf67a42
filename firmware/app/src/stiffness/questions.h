/* What somebody asks about the limb: K where the limb is not, and what K of now means at the contact. */
#ifndef BRACE_STIFFNESS_QUESTIONS_H
#define BRACE_STIFFNESS_QUESTIONS_H

#include "brace/contact.h"
#include "brace/snapshot.h"
#include "sense/joints.h"
#include "stiffness/model.h"

/* What every question about K elsewhere is answered from. */
typedef struct {
    model_t *model;
    const brace_parameters_t *parameters;
    brace_parameter_origin_t origin;
    const joints_t *joints; /* for their temperatures */
} question_limb_t;

/* K in the limb's plane with every gap closed at true joint angles, with the joints' temperatures of now and no load on
 * their springs. Flags: UNCALIBRATED, OUT_OF_RANGE (outside the drives' travel), and the model's own.
 * returns BRACE_OK, BRACE_E_NOT_FINITE, BRACE_E_RANGE and what model_stiffness returns; stiffness untouched then
 * At most 600 instructions. */
brace_status_t question_k_at_posture(const question_limb_t *limb, float theta1_rad, float theta2_rad,
                                     brace_stiffness_t *stiffness);

/* The same with the tip at a place in the limb's plane; returns also what brace_kinematics_inverse returns. */
brace_status_t question_k_at_tip(const question_limb_t *limb, brace_point_t tip, brace_knee_t knee,
                                 brace_stiffness_t *stiffness);

/* K in space at true joint angles; returns also BRACE_E_UNSUPPORTED: the limb has no coxa joint. */
brace_status_t question_k_in_space(const question_limb_t *limb, float theta0_rad, float theta1_rad, float theta2_rad,
                                   brace_stiffness_spatial_t *stiffness);

/* What the K of now makes of a displacement, and of a load.
 * returns as brace_contact_force and brace_contact_sag; BRACE_E_MODE: there is no valid K */
brace_status_t question_contact_force(const brace_snapshot_t *now, brace_displacement_t displacement,
                                      brace_contact_force_t *contact);
brace_status_t question_sag(const brace_snapshot_t *now, brace_force_t load, brace_displacement_t *sag);

/* How far the force of now is from sliding on a surface.
 * returns as brace_contact_grip; BRACE_E_NOT_FINITE also where the force is not known */
brace_status_t question_grip(const brace_snapshot_t *now, float normal_rad, float friction_ratio,
                             brace_contact_grip_t *grip);

#endif
