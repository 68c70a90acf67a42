/* What is asked about the limb from outside, whatever bus asks: from the newest snapshot,
 * or of places where the limb is not. */
#ifndef BRACE_APP_QUESTIONS_H
#define BRACE_APP_QUESTIONS_H

#include "brace/app.h"
#include "brace/contact.h"

/* K with the tip at a place, as hypothetical_stiffness; also what brace_kinematics_inverse returns. At most 1,100
 * instructions. */
brace_status_t question_k_at_tip(brace_app_t *app, brace_point_t tip, brace_knee_t knee, brace_stiffness_t *stiffness);

/* What the K of now makes of a displacement, and of a load.
 * returns as brace_contact_force and brace_contact_sag; BRACE_E_MODE: there is no valid K */
brace_status_t question_contact_force(const brace_app_t *app, brace_displacement_t displacement,
                                      brace_contact_force_t *contact);
brace_status_t question_sag(const brace_app_t *app, brace_force_t load, brace_displacement_t *sag);

/* How far the force of now is from sliding on a surface.
 * returns as brace_contact_grip; BRACE_E_NOT_FINITE also where the force is not known */
brace_status_t question_grip(const brace_app_t *app, float normal_rad, float friction_ratio,
                             brace_contact_grip_t *grip);

#endif
