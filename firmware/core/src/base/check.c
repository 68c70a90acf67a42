#include "base/check.h"

brace_status_t brace_refusal_of(float a, float b)
{
    return brace_is_finite(a) && brace_is_finite(b) ? BRACE_E_RANGE : BRACE_E_NOT_FINITE;
}
