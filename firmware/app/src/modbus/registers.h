/* Which registers there are. Two each value. */
#ifndef BRACE_APP_MODBUS_REGISTERS_H
#define BRACE_APP_MODBUS_REGISTERS_H

#include "brace/app.h"

typedef enum { REGISTERS_MEASURED = 0, REGISTERS_ANSWERED, REGISTERS_PARAMETERS, REGISTERS_COMMANDS } registers_area_t;

typedef struct {
    registers_area_t area;
    uint32_t start;     /* its first register, within the area */
    const void *values; /* of the area, where it lies in memory as it is told; the measured ones are put there by the
                           caller */
} registers_block_t;

/* Registers of the input table or the holding one, if one area holds them all.
 * returns whether there are such registers */
bool registers_block(const brace_app_t *app, bool input, uint32_t start, uint32_t count, registers_block_t *block);

/* A value of its area, by its place there. */
uint32_t registers_value(const brace_app_t *app, const registers_block_t *block, uint32_t index);

#endif
