#include "modbus/registers.h"

#include <string.h>

#include "configure/staging.h"
#include "modbus/command.h"

enum { REGISTER_ANSWERED = 2 * (BRACE_ENTRY_ANSWERED - BRACE_ENTRY_MEASURED) };

bool registers_block(bool input, uint32_t start, uint32_t count, registers_block_t *block)
{
    static const struct {
        uint16_t first, count;
        uint8_t area;
    } areas[2][2] = {{{0, 2 * BRACE_PARAMETER_COUNT, REGISTERS_PARAMETERS},
                      {BRACE_REGISTER_COMMANDS, 2 * BRACE_COMMANDS_COUNT, REGISTERS_COMMANDS}},
                     {{0, 2 * BRACE_MEASURED_COUNT, REGISTERS_MEASURED},
                      {REGISTER_ANSWERED, 2 * BRACE_ANSWERED_COUNT, REGISTERS_ANSWERED}}};
    for (uint32_t i = 0; i < 2u; i++) {
        const uint32_t first = areas[input][i].first, room = areas[input][i].count;
        if (start >= first && start - first < room && count <= room - (start - first)) {
            *block = (registers_block_t){(registers_area_t)areas[input][i].area, start - first, NULL};
            return true;
        }
    }
    return false;
}

static uint32_t word_at(const void *values, uint32_t index)
{
    uint32_t word;
    memcpy(&word, (const uint8_t *)values + 4u * index, sizeof word);
    return word;
}

uint32_t registers_value(const brace_app_t *app, const registers_block_t *block, uint32_t index)
{
    switch (block->area) {
    case REGISTERS_MEASURED: return word_at(block->values, index);
    case REGISTERS_ANSWERED: return word_at(&app->modbus.answered, index);
    case REGISTERS_PARAMETERS: return staging_read(app, index);
    default: return command_read(app, index);
    }
}
