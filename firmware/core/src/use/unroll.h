/* Short loops of fixed length: written out by the compiler, or kept as loops where size matters more. */
#ifndef BRACE_UNROLL_H
#define BRACE_UNROLL_H

#if defined(__clang__)
#define UNROLLED _Pragma("unroll")
#define ROLLED _Pragma("nounroll")
#define INLINED inline __attribute__((always_inline))
#elif defined(__GNUC__)
#define UNROLLED _Pragma("GCC unroll 8")
#define ROLLED _Pragma("GCC unroll 1")
#define INLINED inline __attribute__((always_inline))
#else
#define UNROLLED
#define ROLLED
#define INLINED inline
#endif

#endif
