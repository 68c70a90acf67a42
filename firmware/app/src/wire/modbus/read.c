#include "wire/modbus/read.h"

#include "brace/words.h"
#include "wire/modbus/bytes.h"
#include "wire/modbus/command.h"
#include "wire/modbus/registers.h"

enum { READ_MOST = 125 /* registers */ };

/* Where an area's values lie.
 *   commands: room for those that are made when they are asked for */
static const uint8_t *values_of(const modbus_server_t *server, const wire_tick_t *tick, registers_area_t area,
                                brace_commands_t *commands)
{
    switch (area) {
    case REGISTERS_MEASURED: return (const uint8_t *)tick->measured;
    case REGISTERS_ANSWERED: return (const uint8_t *)&server->answered;
    case REGISTERS_PARAMETERS: return (const uint8_t *)brace_app_parameters_staged(tick->app);
    default: modbus_command_report(server, tick->app, commands); return (const uint8_t *)commands;
    }
}

/* A parameter by the place of its registers. The place of a parameter that is gone reads all ones: not known. */
static uint32_t parameter_at(const uint8_t *parameters, uint32_t place)
{
    const uint32_t index = brace_parameter_index(place);
    return index < (uint32_t)BRACE_PARAMETER_COUNT ? brace_word_at(parameters, index) : UINT32_MAX;
}

static uint32_t value_at(const uint8_t *values, registers_area_t area, uint32_t place)
{
    return area == REGISTERS_PARAMETERS ? parameter_at(values, place) : brace_word_at(values, place);
}

/* Whole values, from one place on. Only parameters are looked up one by one, which costs twice as much.
 *   count: at most READ_MOST / 2 */
static void put_values(const uint8_t *values, registers_area_t area, uint32_t place, uint32_t count, uint8_t *bytes)
{
    if (area == REGISTERS_PARAMETERS) {
        for (uint32_t i = 0; i < count; i++) {
            put_32(bytes + 4u * i, parameter_at(values, place + i));
        }
    } else {
        for (uint32_t i = 0; i < count; i++) {
            put_32(bytes + 4u * i, brace_word_at(values, place + i));
        }
    }
}

/* Registers from the block's first on. One register of a value may be asked for alone; more begin with a value. */
static void put_registers(const uint8_t *values, const registers_block_t *block, uint32_t count, uint8_t *bytes)
{
    const uint32_t place = block->first / 2u, whole = count / 2u;
    if (block->first % 2u != 0u) {
        put_16(bytes, value_at(values, block->area, place));
        return;
    }
    put_values(values, block->area, place, whole, bytes);
    if (count % 2u != 0u) {
        put_16(bytes + 4u * whole, value_at(values, block->area, place + whole) >> 16);
    }
}

/* A master that counts registers from 1 asks for the second half of a value and the first of the next. Every area
 * begins at an even address. */
static bool splits_a_value(const registers_block_t *block, uint32_t count)
{
    return count > 1u && block->first % 2u != 0u;
}

modbus_exception_t modbus_read(const modbus_server_t *server, const wire_tick_t *tick, uint8_t *pdu, uint32_t length,
                               uint32_t *answer)
{
    registers_block_t block;
    brace_commands_t commands;
    if (length != 5u) {
        return MODBUS_E_VALUE;
    }
    const uint32_t start = get_16(pdu + 1), count = get_16(pdu + 3);
    if (count < 1u || count > READ_MOST) {
        return MODBUS_E_VALUE;
    }
    if (!registers_find(pdu[0] == MODBUS_READ_INPUT, start, count, &block) || splits_a_value(&block, count)) {
        return MODBUS_E_ADDRESS;
    }
    pdu[1] = (uint8_t)(2u * count);
    put_registers(values_of(server, tick, block.area, &commands), &block, count, pdu + 2);
    *answer = 2u + 2u * count;
    return MODBUS_FINE;
}
