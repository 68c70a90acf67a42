#include "session/siphash.h"

static inline uint64_t turned(uint64_t value, uint32_t bits)
{
    return value << bits | value >> (64u - bits);
}

static inline void turn(siphash_t *h)
{
    h->v0 += h->v1;
    h->v1 = turned(h->v1, 13) ^ h->v0;
    h->v0 = turned(h->v0, 32);
    h->v2 += h->v3;
    h->v3 = turned(h->v3, 16) ^ h->v2;
    h->v0 += h->v3;
    h->v3 = turned(h->v3, 21) ^ h->v0;
    h->v2 += h->v1;
    h->v1 = turned(h->v1, 17) ^ h->v2;
    h->v2 = turned(h->v2, 32);
}

/* The first `count` of eight bytes as a number, least significant first. */
static uint64_t number_of(const uint8_t *bytes, uint32_t count)
{
    uint64_t number = 0;
    for (uint32_t i = 0; i < count; i++) { /* at most 8 */
        number |= (uint64_t)bytes[i] << (8u * i);
    }
    return number;
}

void siphash_start(siphash_t *hash, const uint8_t key[SIPHASH_KEY_BYTES])
{
    const uint64_t k0 = number_of(key, 8), k1 = number_of(key + 8, 8);
    *hash = (siphash_t){.v0 = k0 ^ 0x736f6d6570736575u, /* "somepseudorandomlygeneratedbytes": the paper, 2.1 */
                        .v1 = k1 ^ 0x646f72616e646f6du,
                        .v2 = k0 ^ 0x6c7967656e657261u,
                        .v3 = k1 ^ 0x7465646279746573u};
}

static void add(siphash_t *hash, uint64_t word)
{
    hash->v3 ^= word;
    turn(hash);
    turn(hash);
    hash->v0 ^= word;
}

void siphash_word(siphash_t *hash, uint64_t word)
{
    add(hash, word);
    hash->length += 8u;
}

uint64_t siphash_end(siphash_t *hash, const uint8_t *bytes, uint32_t count)
{
    uint32_t at = 0;
    for (; at + 8u <= count; at += 8u) { /* at most 32 times */
        siphash_word(hash, number_of(bytes + at, 8));
    }
    const uint32_t rest = count - at;
    add(hash, (hash->length + rest) << 56 | number_of(bytes + at, rest));
    hash->v2 ^= 0xffu;
    for (uint32_t i = 0; i < 4u; i++) {
        turn(hash);
    }
    return hash->v0 ^ hash->v1 ^ hash->v2 ^ hash->v3;
}
