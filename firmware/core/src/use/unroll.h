/* Short loops of fixed length, written out by the compiler. */
#ifndef BRACE_UNROLL_H
#define BRACE_UNROLL_H

#if defined(__clang__)
#define UNROLLED _Pragma("unroll")
#define INLINED inline __attribute__((always_inline))
#elif defined(__GNUC__)
#define UNROLLED _Pragma("GCC unroll 8")
#define INLINED inline __attribute__((always_inline))
#else
#define UNROLLED
#define INLINED inline
#endif

#endif
