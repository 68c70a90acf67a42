/* What the kinematics refuse, and that a refusal leaves its outputs alone. */
#include <string.h>

#include "brace/kinematics.h"
#include "proof.h"

/* Any angle that the header allows for what is asked. */
float brace_atan2(float y, float x)
{
    const float angle = any_float();
    PROVE(x >= -1e37f && x <= 1e37f && y >= -1e37f && y <= 1e37f, "a vector that has an angle");
    ASSUME(angle >= -3.1415928f && angle <= 3.1415928f);
    ASSUME(!(x >= 0.0f) || (angle >= -1.5707964f && angle <= 1.5707964f));
    ASSUME(!(y >= 0.0f) || angle >= 0.0f);
    return angle;
}

static uint32_t bits(float value)
{
    uint32_t word;
    memcpy(&word, &value, sizeof word);
    return word;
}

int main(void)
{
    brace_limb_t limb; /* of any content */
    const brace_polar_t tip = {any_float(), any_float()};
    const int32_t knee = any_i32();
    const bool no_limb = any_bool(), no_output = any_bool();
    float theta1 = any_float(), theta2 = any_float();
    const uint32_t before1 = bits(theta1), before2 = bits(theta2);
    const brace_status_t status = brace_kinematics_inverse_polar(no_limb ? NULL : &limb, tip, (brace_knee_t)knee,
                                                                 &theta1, no_output ? NULL : &theta2);
    PROVE(!(no_limb || no_output) || status == BRACE_E_NULL, "null is refused as such");
    PROVE(status != BRACE_OK || (tip.r_mm >= 0.0f && tip.r_mm <= 2e6f), "a radius that is none, NaN too, is refused");
    PROVE(status != BRACE_OK || (tip.phi_rad >= -7.9f && tip.phi_rad <= 7.9f), "so is a direction");
    PROVE(status != BRACE_OK || knee == 0 || knee == 1, "so is a knee that is neither");
    PROVE(status != BRACE_OK || (limb.femur_mm >= 1.0f && limb.tibia_mm >= 1.0f && limb.tibia_mm <= 1e4f),
          "so is a link without a length");
    PROVE(status == BRACE_OK || (bits(theta1) == before1 && bits(theta2) == before2),
          "refused: the outputs are untouched");
    PROVE(status != BRACE_OK || (theta1 >= -3.1415928f && theta1 <= 3.1415928f), "theta1 within half a turn");
    PROVE(status != BRACE_OK ||
              (knee == 0 ? theta2 >= 0.0f && theta2 <= 3.141594f : theta2 <= 0.0f && theta2 >= -3.141594f),
          "the knee bends the way that was asked for");
    return 0;
}
