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
    brace_element_t element[BRACE_CHAIN_FIRM], base;
    const float iso = brace_chain_base(limb, &base) + brace_chain_firm(limb, element);
    brace_harmonics_list(iso, element, BRACE_CHAIN_FIRM - 2, &general->firm); /* without the springs */
    general->femur_mm = limb->femur_mm;
    general->tibia_mm = limb->tibia_mm;
    general->base = base.base;
}

brace_status_t brace_general_stiffness(const brace_general_t *general, float theta1_rad, float theta2_rad,
                                       float hip_rad_per_n_mm, float knee_rad_per_n_mm, brace_stiffness_t *stiffness)
{
    const brace_status_t status = brace_check_reach(theta1_rad, theta2_rad);
    if (status != BRACE_OK) {
        return status;
    }
    brace_posture_t at;
    brace_posture(theta1_rad, theta2_rad, &at);
    const float femur_mm = general->femur_mm, tibia_mm = general->tibia_mm;
    const brace_vec_t hip_lever = {(tibia_mm - femur_mm) * at.half.z, (tibia_mm + femur_mm) * at.half.x};
    const brace_vec_t knee_lever = {tibia_mm * at.half.z, tibia_mm * at.half.x};
    brace_tensor_t c = brace_harmonics_at(&general->firm, at.half);
    c = brace_tensor_plus(c, vec_scaled(hip_lever, brace_sqrt(hip_rad_per_n_mm)));
    c = brace_tensor_plus(c, vec_scaled(knee_lever, brace_sqrt(knee_rad_per_n_mm)));
    if (general->base.x + general->base.z > 0.0f) {
        c = brace_tensor_plus(c, brace_seen_from(general->base, at.bisector));
    }
    return brace_tensor_inverse(brace_tensor_to_world(c, at.bisector), stiffness);
}
