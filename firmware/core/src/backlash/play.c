#include "brace/play.h"

#include <math.h>

brace_play_t brace_play_under_load(const brace_play_joint_t *joint, float load_n_mm, float lever_mm)
{
    const float size_n_mm = fabsf(load_n_mm), ratio = joint->coulomb_per_load_ratio;
    /* The spring carries up to the load and the friction; friction holds up to coulomb + ratio |spring|. */
    const float friction_n_mm = (joint->coulomb_n_mm + ratio * size_n_mm) / (1.0f - ratio);
    const float noise_n_mm = BRACE_PLAY_SIGMAS * joint->noise_n * lever_mm;
    const float trust_ratio = BRACE_PLAY_LEVER_OFF_RATIO + BRACE_PLAY_SIGMAS * joint->gain_rel;
    const float off_n_mm = noise_n_mm + trust_ratio * size_n_mm + friction_n_mm;
    return (brace_play_t){(load_n_mm > off_n_mm) - (load_n_mm < -off_n_mm), off_n_mm};
}
