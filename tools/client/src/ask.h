/* What all questions of client.h share. */
#ifndef BRACE_CLIENT_ASK_H
#define BRACE_CLIENT_ASK_H

#include <string.h>

#include "client_state.h"

/* Neither NaN, which would be sent as 'not known', nor infinite. */
static inline bool is_number(float value)
{
    return value - value == 0.0f;
}

static inline uint32_t bits_of(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/* Asks a question that only CAN's frames carry; refuses it over Modbus. limited: how many values did not fit. */
brace_client_status_t brace_client_ask(brace_client_t *client, brace_question_t *question, uint32_t code,
                                       uint32_t limited, int timeout_ms);

#endif
