/* K where the limb is not: the model of the tick at angles that somebody asks about. */
#ifndef BRACE_APP_HYPOTHETICAL_H
#define BRACE_APP_HYPOTHETICAL_H

#include "brace/app.h"

/* K with every gap closed at true joint angles, with the joints' temperatures of now and no load on their springs.
 * Flags: UNCALIBRATED, OUT_OF_RANGE (outside the drives' travel), and the model's own.
 * returns BRACE_OK, BRACE_E_NOT_FINITE, BRACE_E_RANGE, BRACE_E_MODE (parameters are being put in force), and what
 *   brace_planar_stiffness or brace_general_stiffness do; stiffness untouched then
 * At most 750 instructions. */
brace_status_t hypothetical_stiffness(brace_app_t *app, float theta1_rad, float theta2_rad,
                                      brace_stiffness_t *stiffness);

#endif
