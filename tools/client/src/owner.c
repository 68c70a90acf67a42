#include "owner.h"

#include <stddef.h>

enum { LIFE = 1, COMMAND = 2 };

static brace_sign_t sign(const brace_client_owner_t *owner, uint32_t kind, const uint8_t *bytes, uint32_t count)
{
    siphash_t hash;
    siphash_start(&hash, owner->key);
    siphash_word(&hash, owner->challenge);
    siphash_word(&hash, (uint64_t)kind << 32 | owner->counter);
    return (brace_sign_t){.counter = owner->counter, .check = (uint32_t)siphash_end(&hash, bytes, count)};
}

brace_sign_t brace_owner_open(brace_client_owner_t *owner, uint64_t challenge)
{
    brace_client_owner_t first;
    if (challenge != owner->challenge) {
        owner->is_accepted = false;
        owner->challenge = challenge;
        owner->counter = 0u;
    }
    owner->is_open = true;
    first = *owner;
    first.counter = 0u;
    return sign(&first, LIFE, NULL, 0u);
}

brace_sign_t brace_owner_life(brace_client_owner_t *owner)
{
    if (!owner->is_open) {
        return (brace_sign_t){0};
    }
    owner->counter++;
    return sign(owner, LIFE, NULL, 0u);
}

uint32_t brace_owner_next_counter(brace_client_owner_t *owner)
{
    return ++owner->counter;
}

brace_sign_t brace_owner_seal(const brace_client_owner_t *owner, const uint8_t *bytes, uint32_t count)
{
    return sign(owner, COMMAND, bytes, count);
}
