#include "modbus/read.h"

#include <string.h>

#include "modbus/bytes.h"
#include "modbus/registers.h"
#include "report/measured.h"

enum { READ_MOST = 125 };

/* Whole values from memory. */
static uint8_t *write_values(const void *values, uint32_t count, uint8_t *bytes)
{
    const uint8_t *from = values;
    for (uint32_t i = 0; i < count; i++) { /* at most READ_MOST / 2 */
        uint32_t word;
        memcpy(&word, from + 4u * i, sizeof word);
        put_32(bytes, word);
        bytes += 4;
    }
    return bytes;
}

/* Registers `start` to `start + count - 1` of an area; one value's may be asked for alone. */
static void write_out(const brace_app_t *app, const registers_block_t *block, uint32_t count, uint8_t *bytes)
{
    uint32_t place = block->start;
    const uint32_t end = place + count;
    if ((place & 1u) != 0u) {
        put_16(bytes, registers_value(app, block, place / 2u));
        bytes += 2;
        place++;
    }
    if (block->values != NULL) {
        bytes = write_values((const uint8_t *)block->values + 2u * place, (end - place) / 2u, bytes);
        place += (end - place) & ~1u;
    }
    for (; place + 1u < end; place += 2u) { /* at most the commands */
        put_32(bytes, registers_value(app, block, place / 2u));
        bytes += 4;
    }
    if (place < end) {
        put_16(bytes, registers_value(app, block, place / 2u) >> 16);
    }
}

modbus_exception_t modbus_read(const brace_app_t *app, uint8_t *pdu, uint32_t length, uint32_t now_us, uint32_t *answer)
{
    if (length != 5u) {
        return MODBUS_E_VALUE;
    }
    const uint32_t start = get_16(pdu + 1), count = get_16(pdu + 3);
    if (count < 1u || count > READ_MOST) {
        return MODBUS_E_VALUE;
    }
    registers_block_t block;
    if (!registers_block(app, pdu[0] == MODBUS_READ_INPUT, start, count, &block)) {
        return MODBUS_E_ADDRESS;
    }
    brace_measured_t measured;
    if (block.area == REGISTERS_MEASURED) {
        brace_measured_take(app, now_us, &measured);
        block.values = &measured;
    }
    pdu[1] = (uint8_t)(2u * count);
    write_out(app, &block, count, pdu + 2);
    *answer = 2u + 2u * count;
    return MODBUS_FINE;
}
