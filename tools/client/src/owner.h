/* What a guarded controller wants of whoever commands it: a counter and a check with each sign of life and each command
 * (docs/security.md). Knows no wire. */
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
    uint32_t counter; /* of the last sign of life or command */
} brace_client_owner_t;

/* A sign of life, or the seal of a command. */
typedef struct {
    uint32_t counter, check;
} brace_sign_t;

/* The sign of life that opens a session. With the challenge of before the counter goes on: the controller takes none
 * twice. */
brace_sign_t brace_owner_open(brace_client_owner_t *owner, uint64_t challenge);

/* The next sign of life; zeros where no session is open: nobody looks at them on a bench. */
brace_sign_t brace_owner_life(brace_client_owner_t *owner);

/* The next command's counter, then the seal of its bytes, which may have to contain that counter. */
uint32_t brace_owner_next_counter(brace_client_owner_t *owner);
brace_sign_t brace_owner_seal(const brace_client_owner_t *owner, const uint8_t *bytes, uint32_t count);

#endif
