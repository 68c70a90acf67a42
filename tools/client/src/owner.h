/* What a controller wants of whoever moves its limb: a number that it has sent lately with each sign of life and, on a
 * guarded board, a check with each sign of life and each command (docs/security.md). Knows no wire. */
#ifndef BRACE_OWNER_H
#define BRACE_OWNER_H

#include <stdbool.h>
#include <stdint.h>

#include "session/siphash.h"

typedef struct {
    bool has_key;
    uint8_t key[SIPHASH_KEY_BYTES];
    bool is_bench;    /* the controller has said that it wants no checks */
    bool is_open;     /* a session has been opened, as far as this side knows, */
    bool is_accepted; /* and the controller has taken a command in it */
    uint64_t challenge;
    uint32_t counter; /* of the last command */
    bool has_number;  /* the controller has sent a number, */
    uint32_t number;  /* and this is the last one */
    bool has_begin;   /* a motion waits for a sign of life with the number `begin` */
    uint32_t begin;
} brace_client_owner_t;

typedef struct {
    uint32_t number, check;
} brace_client_life_t;

typedef struct {
    uint32_t counter, check;
} brace_client_seal_t;

/* A session with this challenge is opened by the next sign of life. With the challenge of before the counter goes on:
 * the controller takes none twice. */
void brace_owner_open(brace_client_owner_t *owner, uint64_t challenge);

/* The controller has sent a number, or has answered a command with the one that begins the motion. */
void brace_owner_hears(brace_client_owner_t *owner, uint32_t number);
void brace_owner_may_begin(brace_client_owner_t *owner, uint32_t begin);

/* The next sign of life. Without a number there is none. */
brace_client_life_t brace_owner_life(const brace_client_owner_t *owner);

/* The next command's counter, then the seal of its bytes, which may have to contain that counter. */
uint32_t brace_owner_next_counter(brace_client_owner_t *owner);
brace_client_seal_t brace_owner_seal(const brace_client_owner_t *owner, const uint8_t *bytes, uint32_t count);

#endif
