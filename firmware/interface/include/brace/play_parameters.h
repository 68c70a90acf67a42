/* What the parameters say about the play of a joint and the friction of its gear, in the core's own terms. */
#ifndef BRACE_PLAY_PARAMETERS_H
#define BRACE_PLAY_PARAMETERS_H

#include "brace/backlash_types.h"
#include "brace/load_band.h"
#include "brace/parameters.h"
#include "brace/play.h"

/* For brace_backlash_init. parameters: not null; joint_index: BRACE_COXA to BRACE_TIBIA. Cost: 80 instructions. */
brace_backlash_params_t brace_play_watched(const brace_parameters_t *parameters, int joint_index);

/* For brace_play_under_load. Arguments as above. Cost: 20 instructions. */
brace_play_joint_t brace_play_joint(const brace_parameters_t *parameters, int joint_index);

/* For brace_load_band. Arguments as above. Cost: 20 instructions. */
brace_gear_t brace_gear(const brace_parameters_t *parameters, int joint_index);

#endif
