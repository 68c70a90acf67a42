/* For a function that runs a few times a tick, each time with other constants: the compiler fits each call in. */
#ifndef BRACE_CORE_INLINE_H
#define BRACE_CORE_INLINE_H

#define INLINE static inline __attribute__((always_inline))

#endif
