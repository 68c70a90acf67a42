#include "modbus/read.h"

#include "modbus/bytes.h"
#include "modbus/registers.h"
#include "report/measured.h"

enum { READ_MOST = 125 };

/* Registers `start` to `start + count - 1` of an area; one value's may be asked for alone. */
static void write_out(const brace_app_t *app, const registers_block_t *block, uint32_t count, uint8_t *bytes)
{
    uint32_t place = block->start;
    const uint32_t end = place + count;
    while (place < end) { /* at most READ_MOST */
        const uint32_t value = registers_value(app, block, place / 2u);
        const bool high = (place & 1u) == 0u;
        if (high && place + 1u < end) {
            put_32(bytes, value);
            bytes += 4;
            place += 2u;
        } else {
            put_16(bytes, high ? value >> 16 : value);
            bytes += 2;
            place += 1u;
        }
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
    if (!registers_block(pdu[0] == MODBUS_READ_INPUT, start, count, &block)) {
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
