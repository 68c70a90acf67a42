/* Compiler built-ins that CBMC has no meaning for. */
#include "proof.h"

float __builtin_copysignf(float magnitude, float sign)
{
    const float size = __builtin_fabsf(magnitude);
    return __builtin_signbit(sign) ? -size : size;
}

/* Any root that is not negative: what it is worth is not for these proofs. */
float __builtin_sqrtf(float value)
{
    const float root = any_float();
    ASSUME(value >= 0.0f ? root >= 0.0f : root != root);
    return root;
}
