#include "modbus/write.h"

#include "configure/staging.h"
#include "modbus/bytes.h"
#include "modbus/command.h"
#include "modbus/registers.h"

enum { WRITE_MOST = 123 /* registers */, PIECE = 8 /* values */, DATA = 6 };

static modbus_exception_t refusal_of(brace_status_t status)
{
    switch (status) {
    case BRACE_OK: return MODBUS_FINE;
    case BRACE_E_MODE: return MODBUS_E_FUNCTION;
    case BRACE_E_UNSUPPORTED: return MODBUS_E_BUSY;
    default: return MODBUS_E_VALUE;
    }
}

modbus_exception_t modbus_write_one(brace_app_t *app, brace_app_modbus_work_t *work, uint8_t *pdu, uint32_t length,
                                    uint32_t *answer)
{
    registers_block_t block;
    if (length != 5u) {
        return MODBUS_E_VALUE;
    }
    const uint32_t start = get_16(pdu + 1), value = get_16(pdu + 3);
    if (!registers_block(app, false, start, 1, &block)) {
        return MODBUS_E_ADDRESS;
    }
    if (block.area == REGISTERS_PARAMETERS && staging_open(app) != BRACE_OK) {
        work->half_known = false;
        return refusal_of(staging_open(app));
    }
    *answer = 5;
    const bool follows = work->half_known && start == work->half_place + 1u;
    work->half_known = (start & 1u) == 0u;
    if (work->half_known) {
        work->half_place = (uint16_t)start;
        work->half = (uint16_t)value;
        return MODBUS_FINE;
    }
    if (!follows) {
        return MODBUS_E_VALUE;
    }
    const uint32_t whole = (uint32_t)work->half << 16 | value, index = block.start / 2u;
    return block.area == REGISTERS_PARAMETERS ? refusal_of(staging_write(app, index, whole))
                                              : command_run(app, index, whole);
}

static modbus_exception_t begin(brace_app_t *app, brace_app_modbus_work_t *work, const uint8_t *pdu, uint32_t length)
{
    registers_block_t block;
    if (length < DATA) {
        return MODBUS_E_VALUE;
    }
    const uint32_t start = get_16(pdu + 1), count = get_16(pdu + 3);
    if (count < 1u || count > WRITE_MOST || pdu[5] != 2u * count || length != DATA + 2u * count) {
        return MODBUS_E_VALUE;
    }
    if (!registers_block(app, false, start, count, &block) || (start & 1u) != 0u) {
        return MODBUS_E_ADDRESS;
    }
    if ((count & 1u) != 0u) {
        return MODBUS_E_VALUE;
    }
    work->area = (uint8_t)block.area;
    work->start = (uint16_t)(block.start / 2u);
    work->count = (uint16_t)(count / 2u);
    work->done = 0;
    work->checked = false;
    return block.area == REGISTERS_PARAMETERS ? refusal_of(staging_open(app)) : MODBUS_FINE;
}

/* All values are judged before the first is written. */
static modbus_exception_t parameters(brace_app_t *app, brace_app_modbus_work_t *work, const uint8_t *data)
{
    const uint32_t end = work->done + PIECE < work->count ? work->done + PIECE : work->count;
    for (uint32_t i = work->done; i < end; i++) { /* at most PIECE */
        const uint32_t index = work->start + i, value = get_32(data + 4u * i);
        const brace_status_t status =
            work->checked ? staging_write(app, index, value) : brace_parameter_in_range(index, value);
        if (status != BRACE_OK) {
            return refusal_of(status);
        }
    }
    work->done = (uint16_t)end;
    if (end == work->count && !work->checked) {
        work->checked = true;
        work->done = 0;
    }
    return MODBUS_FINE;
}

/* One command, or what belongs to one question. */
static modbus_exception_t commands(brace_app_t *app, brace_app_modbus_work_t *work, const uint8_t *data)
{
    work->checked = true;
    work->done = work->count;
    return work->count == 1u ? command_run(app, work->start, get_32(data))
                             : command_ask(app, work->start, work->count, data);
}

modbus_exception_t modbus_write_block(brace_app_t *app, brace_app_modbus_work_t *work, uint8_t *pdu, uint32_t length,
                                      uint32_t *answer)
{
    if (!work->begun) {
        work->begun = true;
        return begin(app, work, pdu, length);
    }
    const modbus_exception_t why = work->area == REGISTERS_PARAMETERS ? parameters(app, work, pdu + DATA)
                                                                      : commands(app, work, pdu + DATA);
    *answer = work->checked && work->done == work->count ? 5u : 0u;
    return why;
}
