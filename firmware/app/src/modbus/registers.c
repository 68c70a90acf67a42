#include "modbus/registers.h"

#include <string.h>

#include "modbus/command.h"

enum { REGISTER_ANSWERED = 2 * (BRACE_ENTRY_ANSWERED - BRACE_ENTRY_MEASURED) };

/* Where an area's values lie one after another; NULL: they are made when asked for. */
static const void *values_of(const brace_app_t *app, registers_area_t area)
{
    switch (area) {
    case REGISTERS_ANSWERED: return &app->modbus.answered;
    case REGISTERS_PARAMETERS: return app->staging.begun ? &app->staging.set : &app->parameters;
    default: return NULL;
    }
}

bool registers_block(const brace_app_t *app, bool input, uint32_t start, uint32_t count, registers_block_t *block)
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
            const registers_area_t area = (registers_area_t)areas[input][i].area;
            *block = (registers_block_t){area, start - first, values_of(app, area)};
            return true;
        }
    }
    return false;
}

uint32_t registers_value(const brace_app_t *app, const registers_block_t *block, uint32_t index)
{
    uint32_t word;
    if (block->values == NULL) {
        return command_read(app, index);
    }
    memcpy(&word, (const uint8_t *)block->values + 4u * index, sizeof word);
    return word;
}
