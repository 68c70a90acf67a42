#include <math.h>

#include "base/trig.h"
#include "base/vec.h"
#include "brace/loaded_space.h"

/* Of a uniform beam of bending b and length L under a force and a moment at its end, one part is a turn of compliance
 * 3 b/L^2, half of it on either side of the chord, and what is left moves the end across by b/4 of the force. That and
 * the spring at the link's end make one spring; `ends` is the share of the latter, which turns with the link's end
 * where the beam's turns half way. */
static brace_space_link_t link_of(const brace_link_t *link, float length_mm, float weight_n)
{
    const brace_vec_t along = brace_direction(link->tilt_rad);
    const float beam = length_mm > 0.0f ? link->moment_transfer : 0.0f;
    const float per_mm = length_mm > 0.0f ? 1.0f / length_mm : 0.0f;
    const float springs = 1.0f - 0.75f * beam, beams = 0.25f * beam / springs, ends = 1.0f - beams;
    const float turn = 3.0f * beam * per_mm * per_mm, spread = springs * beams * ends * per_mm * per_mm;
    const brace_vec_t off_line_mm = {length_mm - length_mm * along.x, -length_mm * along.z}; /* of the elastic line */
    return (brace_space_link_t){.length_mm = length_mm,
                                .stretch_root = vec_scaled(along, sqrtf(link->axial_mm_per_n)),
                                .across = vec_quarter(along),
                                .twist_rad_per_n_mm = link->torsion_rad_per_n_mm,
                                .sideways_rad_per_n_mm = turn * link->lateral_mm_per_n,
                                .bend_rad_per_n_mm = turn * link->bending_mm_per_n,
                                .across_mm_per_n = springs * link->bending_mm_per_n,
                                .sideways_mm_per_n = springs * link->lateral_mm_per_n,
                                .end_share = 0.5f * ends,
                                .stretch_end_share = 0.5f - beam,
                                .twist_end_half = 0.5f - 0.5f * beam,
                                .twist_share = beam * (1.0f - 0.5f * beams),
                                .curl_per_mm = beams * per_mm,
                                .across_spread_per_n_mm = spread * link->bending_mm_per_n,
                                .sideways_spread_per_n_mm = spread * link->lateral_mm_per_n,
                                .shortens_per_mm = 0.6f * beams * beams * per_mm,
                                .tilt_mm = vec_scaled(vec_quarter(off_line_mm), -0.5f),
                                .bow_mm = vec_plus_scaled(vec_scaled(off_line_mm, -0.125f), along, -length_mm / 24.0f),
                                .twelfth_mm = length_mm / 12.0f,
                                .own_share = 0.5f * beams,
                                .weight_n = weight_n};
}

void brace_loaded_space_collapse(const brace_limb_t *limb, const brace_gravity_t *weights, brace_loaded_space_t *loaded)
{
    loaded->coxa = link_of(&limb->link[BRACE_COXA], limb->coxa_mm, 0.0f);
    loaded->femur = link_of(&limb->link[BRACE_FEMUR], limb->femur_mm, weights->femur_n);
    loaded->tibia = link_of(&limb->link[BRACE_TIBIA], limb->tibia_mm, weights->tibia_n);
    loaded->beyond_femur_n = weights->knee_n + weights->tibia_n;
    loaded->beyond_coxa_n = loaded->beyond_femur_n + weights->femur_n;
    loaded->base_x_mm_per_n = limb->base.x_mm_per_n;
    loaded->base_z_mm_per_n = limb->base.z_mm_per_n;
    loaded->base_rotation_rad_per_n_mm = limb->base.rotation_rad_per_n_mm;
}
