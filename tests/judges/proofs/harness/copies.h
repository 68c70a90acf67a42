/* Copies whose content plays no part in a proof: where they read and write is proven, what they write is not followed.
 * Their targets hold any value before already. */
#ifndef BRACE_PROOF_COPIES_H
#define BRACE_PROOF_COPIES_H

#include "proof.h"

/* CBMC's own checks know where a struct ends, not where its members do. What is copied into a watched struct has to lie
 * within one of the members that are given. */
enum { WATCHED_MEMBERS = 2 };
static const void *watched_struct;
static const uint8_t *member_from[WATCHED_MEMBERS], *member_end[WATCHED_MEMBERS];

static bool lies_within_a_member(const void *to, size_t count)
{
    const uint8_t *const from = to;
    bool within = false;
    for (uint32_t i = 0; i < WATCHED_MEMBERS; i++) {
        within = within || (from >= member_from[i] && from <= member_end[i] && count <= (size_t)(member_end[i] - from));
    }
    return within;
}

void *memcpy(void *restrict to, const void *restrict from, size_t count)
{
    PROVE(__CPROVER_r_ok(from, count), "what is copied is there");
    PROVE(__CPROVER_w_ok(to, count), "there is room for what is copied");
    PROVE(watched_struct == NULL || !__CPROVER_same_object(to, watched_struct) || lies_within_a_member(to, count),
          "and it lies within its member");
    return to;
}

#endif
