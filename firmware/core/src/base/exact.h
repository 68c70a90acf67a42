/* What the core asks of the compiler's arithmetic: sums in the order in which they are written, and NaN. */
#ifndef BRACE_CORE_EXACT_H
#define BRACE_CORE_EXACT_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

/* -ffinite-math-only lets a compiler drop each comparison that refuses NaN; a dead encoder's NaN would then give
 * BRACE_OK and a K of NaN. -Ofast and -ffast-math contain it. */
#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ > 0) || defined(_M_FP_FAST)
#error "Brace's core needs NaN and sums in their order: compile its sources with -fno-fast-math (MSVC: /fp:precise)."
#endif

/* clang has no macro for -fassociative-math, which -funsafe-math-optimizations contains. */
#if defined(__clang__) && __clang_major__ >= 10
#pragma clang fp reassociate(off)
#endif

/* x, which a compiler that reorders sums must not look into. No instruction where the compiler takes GNU's asm. */
static inline float brace_opaque(float x)
{
#if defined(__GNUC__) && (defined(__SSE__) || defined(__x86_64__))
    __asm__("" : "+x"(x));
    return x;
#elif defined(__GNUC__) && defined(__arm__) && defined(__ARM_FP) && !defined(__SOFTFP__)
    __asm__("" : "+t"(x));
    return x;
#elif defined(__GNUC__) && defined(__aarch64__)
    __asm__("" : "+w"(x));
    return x;
#elif defined(__GNUC__) && defined(__riscv_flen)
    __asm__("" : "+f"(x));
    return x;
#elif defined(__GNUC__) && (defined(__arm__) || defined(__riscv))
    __asm__("" : "+r"(x));
    return x;
#else
    volatile float opaque = x;
    return opaque;
#endif
}

/* A float's bits. As unsigned numbers those of floats that are not negative have the floats' order, and those of
 * infinity and NaN are above them all. */
static inline uint32_t brace_bits(float x)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

#define BRACE_INFINITE_BITS 0x7f800000u

static inline uint32_t brace_magnitude_bits(float x)
{
    return brace_bits(x) & 0x7fffffffu;
}

/* Not NaN and not infinite, whatever the compiler believes of floats. */
static inline bool brace_is_finite(float x)
{
    return brace_magnitude_bits(x) < BRACE_INFINITE_BITS;
}

#endif
