#include "brace/general.h"

#include "base/check.h"
#include "chain/elements.h"
#include "chain/general.h"
#include "chain/tensor.h"

void brace_general_collapse(const brace_limb_t *limb, brace_general_t *general)
{
    general->iso_mm_per_n = brace_elements_of_links(limb, general->element);
    general->iso_mm_per_n += brace_elements_of_base(limb, &general->base);
    general->femur_mm = limb->femur_mm;
    general->tibia_mm = limb->tibia_mm;
}

static brace_status_t check_reach(float theta1_rad, float theta2_rad)
{
    const float reach = theta1_rad * theta1_rad + theta2_rad * theta2_rad;
    return brace_check_magnitude(reach, BRACE_REACH_RAD2);
}

brace_status_t brace_general_stiffness(const brace_general_t *general, float theta1_rad, float theta2_rad,
                                       float hip_rad_per_n_mm, float knee_rad_per_n_mm, brace_stiffness_t *stiffness)
{
    const brace_status_t status = check_reach(theta1_rad, theta2_rad);
    if (status != BRACE_OK) {
        return status;
    }
    const brace_posture_t at = brace_posture(theta1_rad, theta2_rad);
    const brace_vec_t tip_mm = brace_general_tip_seen(general, at.half);
    const brace_tensor_t c = brace_general_sum(general, &at, tip_mm, sqrtf(hip_rad_per_n_mm), sqrtf(knee_rad_per_n_mm));
    return brace_tensor_inverse(&c, vec_doubled(at.bisector), stiffness);
}

brace_status_t brace_general_compliance(const brace_general_t *general, float theta1_rad, float theta2_rad,
                                        float hip_rad_per_n_mm, float knee_rad_per_n_mm, brace_compliance_t *compliance,
                                        float *det)
{
    const brace_status_t status = check_reach(theta1_rad, theta2_rad);
    if (status != BRACE_OK) {
        return status;
    }
    const brace_posture_t at = brace_posture(theta1_rad, theta2_rad);
    const brace_vec_t tip_mm = brace_general_tip_seen(general, at.half);
    const brace_tensor_t c = brace_general_sum(general, &at, tip_mm, sqrtf(hip_rad_per_n_mm), sqrtf(knee_rad_per_n_mm));
    const brace_circle_t circle = brace_tensor_circle(&c);
    const brace_vec_t dev = vec_turned(circle.dev, vec_doubled(at.bisector));
    *compliance = (brace_compliance_t){circle.mean + dev.x, dev.z, circle.mean - dev.x};
    *det = brace_tensor_det(&c);
    return BRACE_OK;
}
