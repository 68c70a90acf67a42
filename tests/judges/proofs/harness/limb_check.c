#include "brace/limb.h"
#include "proof.h"

int main(void)
{
    brace_limb_t limb; /* of any content */
    const uint32_t field = any_u32();
    ASSUME(field < sizeof limb / sizeof(float));
    const bool none = any_bool();
    const brace_status_t status = brace_limb_check(none ? NULL : &limb);
    const float value = ((const float *)&limb)[field];
    PROVE(status == BRACE_OK || status == BRACE_E_NULL || status == BRACE_E_NOT_FINITE || status == BRACE_E_PARAMETER,
          "a status as stated");
    PROVE((status == BRACE_E_NULL) == none, "null is refused as such");
    PROVE(none || __builtin_fabsf(value) <= 3.4028234e38f || status == BRACE_E_NOT_FINITE, "so is NaN, and infinity");
    if (status == BRACE_OK) {
        PROVE(value >= -1.5708f && value <= 1e4f, "accepted: every field is finite and in the widest range there is");
        PROVE(limb.femur_mm >= 1.0f && limb.tibia_mm >= 1.0f, "accepted: links have a length to divide by");
        PROVE(limb.coxa_mm >= 1.0f || !(limb.link[BRACE_COXA].moment_transfer > 0.0f),
              "accepted: so has a coxa that passes moments on");
        PROVE(limb.joint[BRACE_FEMUR].gap_rad >= 0.0f && limb.joint[BRACE_FEMUR].gap_rad <= 0.5f,
              "accepted: play is in its range");
    }
    return 0;
}
