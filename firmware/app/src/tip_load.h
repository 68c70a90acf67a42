/* The force of the ground on the tip, as K counts it. */
#ifndef BRACE_TIP_LOAD_H
#define BRACE_TIP_LOAD_H

#include "controller.h"

/* Does the tip's sensor measure the force in the limb's plane? Without a posture nobody could use it. */
static inline bool tip_load_is_sensed(const controller_t *controller)
{
    return controller->tip_force.known && controller->posture.has_levers;
}

/* The force in the limb's plane: by the tip's sensor, else from what the joints carry. Across it, only the coxa joint
 * measures it.
 *   load_n_mm: of each joint in its motor's sense, weight included; NaN: not known
 * returns the force in the frame of the limb's plane; NaN where it is not known */
static inline brace_vec3_t tip_load_n(const controller_t *controller, const float load_n_mm[BRACE_LINK_COUNT])
{
    const posture_t *posture = &controller->posture;
    const brace_parameters_t *parameters = &controller->parameters.in_force;
    const brace_vec3_t down = controller->gravity.down;
    const bool is_sensed = tip_load_is_sensed(controller);
    brace_vec3_t tip_n = {controller->tip_force.x_n, __builtin_nanf(""), controller->tip_force.z_n};
    if (!is_sensed) {
        posture_force_of_loads(posture, parameters, down, load_n_mm[BRACE_FEMUR], load_n_mm[BRACE_TIBIA], &tip_n.x,
                               &tip_n.z);
    }
    if (controller->joints.joint[BRACE_COXA].sound) {
        tip_n.y = posture_force_across_n(posture, parameters, down, load_n_mm[BRACE_COXA], !is_sensed, &tip_n.x);
    }
    return tip_n;
}

#endif
