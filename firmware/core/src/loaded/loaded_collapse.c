#include <math.h>

#include "base/trig.h"
#include "base/vec.h"
#include "brace/loaded.h"
#include "chain/elements.h"

/* A uniform beam of bending b and length L has the curvature compliance 3 b/L^2 in all; each of the two Gauss points
 * has half of it. */
static brace_loaded_link_t link_of(const brace_link_t *link, float length_mm, float weight_n)
{
    const brace_vec_t along = brace_direction(link->tilt_rad);
    const float beam = link->moment_transfer, rest = 1.0f - beam;
    brace_loaded_link_t loaded = {.length_mm = length_mm,
                                  .beam_mm = vec_scaled(along, length_mm),
                                  .bend_rad_per_n_mm = 1.5f * beam * link->bending_mm_per_n / length_mm / length_mm,
                                  .root_root = vec_scaled(along, sqrtf(beam * link->axial_mm_per_n)),
                                  .weight_n = weight_n};
    loaded.to_beam_mm = (brace_vec_t){length_mm - loaded.beam_mm.x, -loaded.beam_mm.z};
    loaded.end_mm_per_n =
        brace_elements_split(rest * link->axial_mm_per_n, rest * link->bending_mm_per_n, along, &loaded.end_root);
    return loaded;
}

void brace_loaded_collapse(const brace_limb_t *limb, const brace_gravity_t *weights, brace_loaded_t *loaded)
{
    loaded->femur = link_of(&limb->link[BRACE_FEMUR], limb->femur_mm, weights->femur_n);
    loaded->tibia = link_of(&limb->link[BRACE_TIBIA], limb->tibia_mm, weights->tibia_n);
    loaded->knee_n = weights->knee_n + weights->tibia_n;
    loaded->weight_n = loaded->knee_n + weights->femur_n;
    loaded->base_mm_per_n = brace_elements_of_base(limb, &loaded->base_root);
    loaded->base_rotation_rad_per_n_mm = limb->base.rotation_rad_per_n_mm;
}
