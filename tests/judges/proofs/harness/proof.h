/* What every proof uses. To CBMC an object that nobody has written holds any value of its type: that is how inputs are
 * "any". PROVE is what is to hold for all of them; ASSUME says for which. */
#ifndef BRACE_PROOF_H
#define BRACE_PROOF_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define ANY_OF(type, name) \
    static inline type name(void) \
    { \
        type any; \
        return any; \
    }
ANY_OF(uint8_t, any_u8)
static inline bool any_bool(void)
{
    return (any_u8() & 1u) != 0u;
}
ANY_OF(uint16_t, any_u16)
ANY_OF(uint32_t, any_u32)
ANY_OF(uint64_t, any_u64)
ANY_OF(int32_t, any_i32)
ANY_OF(int64_t, any_i64)
ANY_OF(float, any_float)

#define ASSUME(condition) __CPROVER_assume(condition)
#define PROVE(condition, claim) __CPROVER_assert(condition, claim)

/* Any content for a whole object. */
#define ANY(object) __CPROVER_havoc_object(&(object))

/* Are two objects the same, in words of 32 bits? (memcmp goes byte by byte: four times the formula) */
static inline bool same(const void *a, const void *b, uint32_t bytes)
{
    const uint32_t *of_a = a, *of_b = b;
    uint32_t differing = 0;
    for (uint32_t i = 0; i < bytes / 4u; i++) {
        differing |= of_a[i] ^ of_b[i];
    }
    return differing == 0u;
}

#endif
