/* Compiler built-ins and functions of the C library that CBMC has no meaning for, or one too dear for a proof. */
#include "proof.h"

float __builtin_copysignf(float magnitude, float sign)
{
    const float size = __builtin_fabsf(magnitude);
    return __builtin_signbit(sign) ? -size : size;
}

/* Any root that is neither negative nor greater than its square, or than 1 if that is greater: what it is worth is not
 * for these proofs. */
float __builtin_sqrtf(float value)
{
    const float root = any_float(), most = value > 1.0f ? value : 1.0f;
    ASSUME(value >= 0.0f ? root >= 0.0f && root <= most : root != root);
    return root;
}

float sqrtf(float value)
{
    return __builtin_sqrtf(value);
}

int __builtin_isfinite(float value)
{
    return __builtin_fabsf(value) <= 3.4028235e38f; /* the largest float; false for NaN too */
}
