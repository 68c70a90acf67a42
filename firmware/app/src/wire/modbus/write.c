#include "wire/modbus/write.h"

#include <stddef.h>

#include "wire/modbus/ask.h"
#include "wire/modbus/bytes.h"
#include "wire/modbus/command.h"
#include "wire/modbus/refusal.h"
#include "wire/modbus/registers.h"

enum { WRITE_MOST = 123 /* registers */, DATA_AT = 6, ANSWER_BYTES = 5 };

static modbus_exception_t write_parameters(modbus_server_t *server, const wire_tick_t *tick, uint32_t first,
                                           uint32_t count, const uint32_t *words)
{
    request_t request = modbus_request(server, tick);
    modbus_exception_t why = modbus_refusal_of(answer_admit(&request, BRACE_COMMAND_WRITES));
    why = why == MODBUS_FINE ? modbus_refusal_to_write(tick->app) : why;
    return why == MODBUS_FINE ? modbus_refusal_of(brace_app_parameters_stage(tick->app, first, count, words)) : why;
}

/* May a value come in two halves? A seal is over one request, so on a guarded board it may not. */
static modbus_exception_t may_write_halves(modbus_server_t *server, const wire_tick_t *tick, bool is_parameter)
{
    if (brace_app_setting(tick->app) != BRACE_SETTING_BENCH) {
        request_t request = modbus_request(server, tick);
        request.seal = NULL;
        return modbus_refusal_of(answer_admit(&request, BRACE_COMMAND_WRITES));
    }
    if (is_parameter && brace_app_mode(tick->app) != BRACE_MODE_CONFIGURATION) {
        return MODBUS_E_FUNCTION;
    }
    return is_parameter && brace_app_is_storing(tick->app) ? MODBUS_E_BUSY : MODBUS_FINE;
}

modbus_exception_t modbus_write_one(modbus_server_t *server, modbus_half_t *half, const wire_tick_t *tick, uint8_t *pdu,
                                    uint32_t length, uint32_t *answer)
{
    registers_block_t block;
    const modbus_half_t high = *half;
    half->is_known = false;
    if (length != 5u) {
        return MODBUS_E_VALUE;
    }
    const uint32_t start = get_16(pdu + 1), value = get_16(pdu + 3);
    if (!registers_find(false, start, 1, &block)) {
        return MODBUS_E_ADDRESS;
    }
    const bool is_parameter = block.area == REGISTERS_PARAMETERS;
    const modbus_exception_t why = may_write_halves(server, tick, is_parameter);
    if (why != MODBUS_FINE) {
        return why;
    }
    *answer = ANSWER_BYTES;
    if (start % 2u == 0u) { /* only kept, and with the low half judged */
        half->is_known = true;
        half->register_address = (uint16_t)start;
        half->value = (uint16_t)value;
        return MODBUS_FINE;
    }
    if (!high.is_known || start != high.register_address + 1u) {
        return MODBUS_E_VALUE;
    }
    const uint32_t whole = (uint32_t)high.value << 16 | value, index = block.first / 2u;
    return is_parameter ? write_parameters(server, tick, index, 1, &whole)
                        : modbus_command_run(server, tick, index, whole);
}

static modbus_exception_t write_values(modbus_server_t *server, const wire_tick_t *tick, const registers_block_t *block,
                                       uint32_t count, const uint8_t *data)
{
    uint32_t words[WRITE_MOST / 2];
    for (uint32_t i = 0; i < count; i++) { /* at most WRITE_MOST / 2 */
        words[i] = get_32(data + 4u * i);
    }
    const uint32_t first = block->first / 2u;
    if (block->area == REGISTERS_PARAMETERS) {
        return write_parameters(server, tick, first, count, words);
    }
    if (modbus_command_shows(first, count)) {
        return modbus_command_show(server, tick, first, words);
    }
    return count == 1u ? modbus_command_run(server, tick, first, words[0])
                       : modbus_ask(server, tick, first, count, words);
}

modbus_exception_t modbus_write_block(modbus_server_t *server, const wire_tick_t *tick, uint8_t *pdu, uint32_t length,
                                      uint32_t *answer)
{
    registers_block_t block;
    if (length < DATA_AT) {
        return MODBUS_E_VALUE;
    }
    const uint32_t start = get_16(pdu + 1), count = get_16(pdu + 3);
    if (count < 1u || count > WRITE_MOST || pdu[5] != 2u * count || length != DATA_AT + 2u * count) {
        return MODBUS_E_VALUE;
    }
    if (!registers_find(false, start, count, &block) || start % 2u != 0u) {
        return MODBUS_E_ADDRESS;
    }
    if (count % 2u != 0u) {
        return MODBUS_E_VALUE;
    }
    const modbus_exception_t why = write_values(server, tick, &block, count / 2u, pdu + DATA_AT);
    if (why == MODBUS_FINE) {
        *answer = ANSWER_BYTES;
    }
    return why;
}
