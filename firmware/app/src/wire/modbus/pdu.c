#include "wire/modbus/pdu.h"

#include <stddef.h>

#include "wire/modbus/ask.h"
#include "wire/modbus/bytes.h"
#include "wire/modbus/identity.h"
#include "wire/modbus/read.h"
#include "wire/modbus/registers.h"
#include "wire/modbus/write.h"

/* Sub-functions of function 08. */
enum {
    DIAGNOSE_ECHO = 0,
    DIAGNOSE_CLEAR = 0x0a,
    DIAGNOSE_MESSAGES = 0x0b,
    DIAGNOSE_BROKEN = 0x0c,
    DIAGNOSE_REFUSED = 0x0d,
    DIAGNOSE_SERVED = 0x0e,
    DIAGNOSE_UNANSWERED = 0x0f,
    DIAGNOSE_BUSY = 0x11,
    DIAGNOSE_LAST = 0x12
};

uint32_t modbus_pdu_refuse(modbus_server_t *server, const wire_tick_t *tick, uint8_t *pdu, modbus_exception_t why)
{
    brace_count(&tick->counters->modbus_refused);
    server->refused++;
    server->busy = (uint16_t)(server->busy + (why == MODBUS_E_BUSY));
    pdu[0] |= (uint8_t)MODBUS_REFUSED;
    pdu[1] = (uint8_t)why;
    return 2;
}

static uint16_t counter(const modbus_server_t *server, uint32_t code)
{
    switch (code) {
    case DIAGNOSE_MESSAGES: return server->messages;
    case DIAGNOSE_BROKEN: return server->broken;
    case DIAGNOSE_REFUSED: return server->refused;
    case DIAGNOSE_SERVED: return server->served;
    case DIAGNOSE_UNANSWERED: return server->unanswered;
    case DIAGNOSE_BUSY: return server->busy;
    default: return 0; /* 0x10: this server never refuses that way; 0x12: it does not see the line's overruns */
    }
}

static modbus_exception_t diagnose(modbus_server_t *server, uint8_t *pdu, uint32_t length, uint32_t *answer)
{
    if (length < 5u || length % 2u == 0u) {
        return MODBUS_E_VALUE;
    }
    const uint32_t code = get_16(pdu + 1);
    *answer = length;
    if (code == DIAGNOSE_ECHO) {
        return MODBUS_FINE;
    }
    if (code < DIAGNOSE_CLEAR || code > DIAGNOSE_LAST) {
        return MODBUS_E_FUNCTION;
    }
    if (length != 5u || get_16(pdu + 3) != 0u) {
        return MODBUS_E_VALUE;
    }
    if (code == DIAGNOSE_CLEAR) {
        server->messages = server->broken = server->refused = server->served = server->unanswered = server->busy = 0;
    } else {
        put_16(pdu + 3, counter(server, code));
    }
    return MODBUS_FINE;
}

answer_rank_t modbus_pdu_rank(const uint8_t *pdu, uint32_t length)
{
    const bool writes = pdu[0] == MODBUS_WRITE_ONE || pdu[0] == MODBUS_WRITE_BLOCK;
    registers_block_t block;
    if (!writes || length < 5u) {
        return ANSWER_QUESTION;
    }
    if (!registers_find(false, get_16(pdu + 1), 1, &block) || block.area != REGISTERS_COMMANDS) {
        return ANSWER_OF_SESSION;
    }
    const uint32_t command = block.first / 2u;
    if (command == offsetof(brace_commands_t, stop) / 4u) {
        return ANSWER_STOPS;
    }
    return modbus_ask_is_of(command) ? ANSWER_QUESTION : ANSWER_OF_SESSION;
}

uint32_t modbus_pdu_answer(modbus_server_t *server, modbus_half_t *half, const wire_tick_t *tick, uint8_t *pdu,
                           uint32_t length)
{
    uint32_t answer = 0;
    modbus_exception_t why = MODBUS_E_FUNCTION;
    server->who = (brace_who_t){server->asker, half->peer};
    server->seal = &half->seal;
    server->pdu = pdu;
    server->length = length;
    if (pdu[0] != MODBUS_WRITE_ONE) {
        half->is_known = false; /* the low half has to come right behind the high one */
    }
    switch (pdu[0]) {
    case MODBUS_READ_HOLDING:
    case MODBUS_READ_INPUT: why = modbus_read(server, tick, pdu, length, &answer); break;
    case MODBUS_WRITE_ONE: why = modbus_write_one(server, half, tick, pdu, length, &answer); break;
    case MODBUS_WRITE_BLOCK: why = modbus_write_block(server, tick, pdu, length, &answer); break;
    case MODBUS_DIAGNOSE: why = diagnose(server, pdu, length, &answer); break;
    case MODBUS_SERVER_ID: why = modbus_server_id(pdu, length, &answer); break;
    case MODBUS_DEVICE_ID: why = modbus_device_id(pdu, length, &answer); break;
    default: break;
    }
    if (why == MODBUS_AGAIN) {
        return 0;
    }
    return why == MODBUS_FINE ? answer : modbus_pdu_refuse(server, tick, pdu, why);
}

uint32_t modbus_pdu_least_length(const uint8_t *pdu, uint32_t length)
{
    switch (pdu[0]) {
    case MODBUS_READ_HOLDING:
    case MODBUS_READ_INPUT:
    case MODBUS_WRITE_ONE:
    case MODBUS_DIAGNOSE: return 5;
    case MODBUS_WRITE_BLOCK: return length >= 6u ? 6u + pdu[5] : 6u;
    case MODBUS_DEVICE_ID: return 4;
    default: return 1;
    }
}
