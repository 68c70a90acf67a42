/* Which registers there are: two for each value. docs/modbus.md lists them; their addresses are generated from the
 * dictionary (brace/measured.h, brace/parameter_list.h). */
#ifndef BRACE_WIRE_MODBUS_REGISTERS_H
#define BRACE_WIRE_MODBUS_REGISTERS_H

#include <stdbool.h>
#include <stdint.h>

/* Values whose registers follow one another. They lie in memory in the same order, but for parameters, which have
 * numbers on the wire (brace_parameter_index). */
typedef enum {
    REGISTERS_MEASURED = 0, /* brace_measured_t; input registers */
    REGISTERS_ANSWERED,     /* brace_answered_t; input registers */
    REGISTERS_PARAMETERS,   /* brace_parameters_t; holding registers */
    REGISTERS_COMMANDS      /* brace_commands_t; holding registers */
} registers_area_t;

typedef struct {
    registers_area_t area;
    uint32_t first; /* register within the area */
} registers_block_t;

/* Finds the area that holds all of these registers.
 *   is_input: of the input registers, else of the holding registers
 *   count: at least 1
 * returns whether there is one; block untouched if not */
bool registers_find(bool is_input, uint32_t start, uint32_t count, registers_block_t *block);

#endif
