/* x y + z, in one instruction where the processor has it. */
#ifndef BRACE_CORE_FMA_H
#define BRACE_CORE_FMA_H

#include <math.h>

#include "base/exact.h"

/* Without a floating-point unit, fmaf() keeps its single rounding by a detour through double precision, some 300
 * instructions long. Product and sum rounded apart cost a third of that. Where a single rounding is needed, the code
 * says fmaf(). */
static inline float brace_fma(float x, float y, float z)
{
#if defined(__SOFTFP__) || (defined(__riscv) && !defined(__riscv_flen))
    return x * y + z;
#else
    return fmaf(x, y, z);
#endif
}

#endif
