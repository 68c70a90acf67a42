#include "brace/play.h"

#include <math.h>
#include <stddef.h>

#include "brace/backlash.h"

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

brace_engagement_t brace_play_engagement(int named, bool is_proven, bool is_expected, int held)
{
    const bool is_named = named != 0 && (!is_expected || held == named);
    return (brace_engagement_t){named, is_proven || is_named, is_named && !is_proven};
}

brace_engagement_t brace_play_at_rest(const brace_play_joint_t *joint, const brace_backlash_t *machine, float load_n_mm,
                                      float lever_mm, bool is_expected)
{
    const brace_play_t play = brace_play_under_load(joint, load_n_mm, lever_mm);
    const brace_backlash_sample_t sample = {.torque_n_mm = load_n_mm,
                                            .load_is_expected = is_expected,
                                            .expected_n_mm = load_n_mm,
                                            .expected_off_n_mm = play.off_n_mm};
    int flank = 0;
    bool is_proven = false;
    if (machine == NULL || brace_backlash_at_rest(machine, &sample, &flank, &is_proven) != BRACE_OK) {
        return (brace_engagement_t){0, false, false};
    }
    return brace_play_engagement(flank, is_proven, is_expected, play.flank);
}
