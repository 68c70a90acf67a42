#include "wire/modbus/registers.h"

#include "brace/measured.h"
#include "brace/parameters.h"

bool registers_find(bool is_input, uint32_t start, uint32_t count, registers_block_t *block)
{
    static const struct {
        uint16_t first, count;
        uint8_t area;
    } areas[2][2] = {{{0, 2 * BRACE_PARAMETER_NUMBERS, REGISTERS_PARAMETERS},
                      {BRACE_REGISTER_COMMANDS, 2 * BRACE_COMMANDS_COUNT, REGISTERS_COMMANDS}},
                     {{BRACE_REGISTER_MEASURED, 2 * BRACE_MEASURED_COUNT, REGISTERS_MEASURED},
                      {BRACE_REGISTER_ANSWERED, 2 * BRACE_ANSWERED_COUNT, REGISTERS_ANSWERED}}};
    for (uint32_t i = 0; i < 2u; i++) {
        const uint32_t first = areas[is_input][i].first, room = areas[is_input][i].count;
        if (start >= first && start - first < room && count <= room - (start - first)) {
            *block = (registers_block_t){(registers_area_t)areas[is_input][i].area, start - first};
            return true;
        }
    }
    return false;
}
