#include "brace/general.h"

#include "base/off_tick.h"
#include "base/trig.h"
#include "chain/chain_list.h"
#include "chain/tensor.h"
#include "base/vec.h"

/* On the tick: of every controller whose limb brace_planar_stiffness does not serve. tests/bench/tick_cost.py holds that
 * whole tick to 4,000 instructions. */

BRACE_OFF_TICK void brace_general_collapse(const brace_limb_t *limb, brace_general_t *general)
{
    const float iso = brace_chain_firm(limb, 1.0f, 1.0f, general->element) + FLT_MIN;
    const float x = iso + limb->base.x_mm_per_n, z = iso + limb->base.z_mm_per_n;
    general->mean_mm_per_n = 0.5f * (x + z);
    general->dev_mm_per_n = 0.5f * (x - z);
    general->det = x * z;
}

brace_status_t brace_general_stiffness(const brace_general_t *general, float theta1_rad, float theta2_rad,
                                       float hip_rad_per_n_mm, float knee_rad_per_n_mm, brace_stiffness_t *stiffness)
{
    const brace_status_t status = brace_check_reach(theta1_rad, theta2_rad);
    if (status != BRACE_OK) {
        return status;
    }
    const float hip = brace_sqrt(hip_rad_per_n_mm), knee = brace_sqrt(knee_rad_per_n_mm);
    const float root[BRACE_CHAIN_FIRM] = {1.0f, 1.0f, 1.0f, hip, knee};
    const uint32_t knee_turn = brace_turn(theta2_rad), femur_turn = brace_turn(theta1_rad);
    const brace_vec_t to_world = brace_direction(2u * femur_turn - knee_turn);
    /* Of half the knee, or half a turn beyond: that changes every element's sign and no square. */
    const brace_vec_t half = brace_direction(knee_turn / 2u);
    const float mean = general->mean_mm_per_n, dev = general->dev_mm_per_n * to_world.x;
    brace_tensor_t c = {mean + dev, -general->dev_mm_per_n * to_world.z, mean - dev, general->det};
    for (int i = 0; i < BRACE_CHAIN_FIRM; i++) {
        c = brace_tensor_plus(c, brace_swing_at(&general->element[i], vec_scaled(half, root[i])));
    }
    return brace_tensor_inverse(c, to_world, stiffness);
}
