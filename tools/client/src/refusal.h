/* Refusals in words. */
#ifndef BRACE_CLIENT_REFUSAL_H
#define BRACE_CLIENT_REFUSAL_H

#include <stdbool.h>
#include <stdint.h>

/* Why there is no K under a force, in words. */
#define BRACE_CLIENT_NO_COXA "the limb has no coxa joint; ask for K in its plane"
#define BRACE_CLIENT_FOLDS \
    "no stable equilibrium is near: the force folds the limb there; ask for a smaller force or another place"

/* A refusal in words. The meaning of a status depends on the request. */
const char *brace_client_reason(uint32_t code, int32_t status, uint32_t detail);

/* A controller counts the force that was sent last, whoever sent it, and once. */
bool brace_client_is_about_force(uint32_t code);

#endif
