/* For a function that runs a few times a tick, each time with other constants: a controller's compiler fits each call
 * in. A host has time for the calls, and its compiler would take five times as long. */
#ifndef BRACE_CORE_INLINE_H
#define BRACE_CORE_INLINE_H

#if defined(__x86_64__) || defined(__i386__) || defined(__aarch64__)
#define INLINE static inline
#else
#define INLINE static inline __attribute__((always_inline))
#endif

#endif
