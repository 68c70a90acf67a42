/* SipHash-2-4: a keyed check of short messages (J.-P. Aumasson, D. J. Bernstein: SipHash: a fast short-input PRF,
 * INDOCRYPT 2012). Whoever does not know the key can neither make nor guess the check of a message.
 *
 * A message is given in words of eight bytes, least significant first, and a last piece of 0 to 7 bytes. Pure
 * functions. On a Cortex-M4F: 130 instructions for a word, 300 for the end. */
#ifndef BRACE_SESSION_SIPHASH_H
#define BRACE_SESSION_SIPHASH_H

#include <stdint.h>

enum { SIPHASH_KEY_BYTES = 16 };

typedef struct {
    uint64_t v0, v1, v2, v3;
    uint64_t length; /* bytes so far */
} siphash_t;

void siphash_start(siphash_t *hash, const uint8_t key[SIPHASH_KEY_BYTES]);

void siphash_word(siphash_t *hash, uint64_t word);

/* Bytes at the end of a message; `count` is at most 260. returns the check of the whole */
uint64_t siphash_end(siphash_t *hash, const uint8_t *bytes, uint32_t count);

#endif
