#include "modbus/pdu.h"

#include "modbus/bytes.h"
#include "modbus/identity.h"
#include "modbus/read.h"
#include "modbus/write.h"

uint32_t modbus_refuse(brace_app_t *app, uint8_t *pdu, modbus_exception_t why)
{
    brace_app_modbus_t *modbus = &app->modbus;
    app->counters.modbus_refused += app->counters.modbus_refused < UINT32_MAX;
    modbus->refused++;
    modbus->busy = (uint16_t)(modbus->busy + (why == MODBUS_E_BUSY));
    pdu[0] |= (uint8_t)MODBUS_REFUSED;
    pdu[1] = (uint8_t)why;
    return 2;
}

/* Counters of the serial line, 16 bits each, by their sub-function from 0x0b on. */
static uint16_t counter(const brace_app_modbus_t *modbus, uint32_t code)
{
    switch (code) {
    case 0x0b: return modbus->messages;
    case 0x0c: return modbus->broken;
    case 0x0d: return modbus->refused;
    case 0x0e: return modbus->served;
    case 0x0f: return modbus->unanswered;
    case 0x11: return modbus->busy;
    default: return 0; /* 0x10 refusals of a kind that is not used here, 0x12 overruns: the line's, not seen here */
    }
}

static modbus_exception_t diagnose(brace_app_modbus_t *modbus, uint8_t *pdu, uint32_t length, uint32_t *answer)
{
    if (length < 5u || (length & 1u) == 0u) {
        return MODBUS_E_VALUE;
    }
    const uint32_t code = get_16(pdu + 1);
    *answer = length;
    if (code == 0u) { /* what came goes back */
        return MODBUS_FINE;
    }
    if (code < 0x0au || code > 0x12u) {
        return MODBUS_E_FUNCTION;
    }
    if (length != 5u || get_16(pdu + 3) != 0u) {
        return MODBUS_E_VALUE;
    }
    if (code == 0x0au) {
        modbus->messages = modbus->broken = modbus->refused = modbus->served = modbus->unanswered = modbus->busy = 0;
    } else {
        put_16(pdu + 3, counter(modbus, code));
    }
    return MODBUS_FINE;
}

uint32_t modbus_pdu_work(brace_app_t *app, brace_app_modbus_work_t *work, uint8_t *pdu, uint32_t length,
                         uint32_t now_us)
{
    uint32_t answer = 0;
    modbus_exception_t why = MODBUS_E_FUNCTION;
    if (pdu[0] != MODBUS_WRITE_ONE) {
        work->half_known = false;
    }
    switch (pdu[0]) {
    case MODBUS_READ_HOLDING:
    case MODBUS_READ_INPUT: why = modbus_read(app, pdu, length, now_us, &answer); break;
    case MODBUS_WRITE_ONE: why = modbus_write_one(app, work, pdu, length, &answer); break;
    case MODBUS_WRITE_BLOCK: why = modbus_write_block(app, work, pdu, length, &answer); break;
    case MODBUS_DIAGNOSE: why = diagnose(&app->modbus, pdu, length, &answer); break;
    case MODBUS_SERVER_ID: why = modbus_server_id(pdu, length, &answer); break;
    case MODBUS_DEVICE_ID: why = modbus_device_id(pdu, length, &answer); break;
    default: break;
    }
    return why == MODBUS_FINE ? answer : modbus_refuse(app, pdu, why);
}

uint32_t modbus_request_length(const uint8_t *pdu, uint32_t length)
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
