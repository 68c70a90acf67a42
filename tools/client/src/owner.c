#include "owner.h"

#include <stddef.h>

enum { LIFE = 1, COMMAND = 2 };

static uint32_t check_of(const brace_client_owner_t *owner, uint32_t number, uint32_t kind, const uint8_t *bytes,
                         uint32_t count)
{
    siphash_t hash;
    siphash_start(&hash, owner->key);
    siphash_word(&hash, owner->challenge);
    siphash_word(&hash, (uint64_t)kind << 32 | number);
    return (uint32_t)siphash_end(&hash, bytes, count);
}

void brace_owner_open(brace_client_owner_t *owner, uint64_t challenge)
{
    if (challenge != owner->challenge) {
        owner->is_accepted = false;
        owner->challenge = challenge;
        owner->counter = 0u;
    }
    owner->is_open = true;
}

void brace_owner_hears(brace_client_owner_t *owner, uint32_t number)
{
    owner->number = number;
    owner->has_number = true;
}

void brace_owner_may_begin(brace_client_owner_t *owner, uint32_t begin)
{
    owner->begin = begin;
    owner->has_begin = true;
}

brace_client_life_t brace_owner_life(const brace_client_owner_t *owner)
{
    const uint32_t number = owner->has_begin ? owner->begin : owner->number;
    return (brace_client_life_t){number, owner->is_open ? check_of(owner, number, LIFE, NULL, 0u) : number};
}

uint32_t brace_owner_next_counter(brace_client_owner_t *owner)
{
    return ++owner->counter;
}

brace_client_seal_t brace_owner_seal(const brace_client_owner_t *owner, const uint8_t *bytes, uint32_t count)
{
    return (brace_client_seal_t){owner->counter, check_of(owner, owner->counter, COMMAND, bytes, count)};
}
