/* Little-endian words in bytes, and the members of the dictionary's structs as words. */
#ifndef BRACE_WORDS_H
#define BRACE_WORDS_H

#include <stdint.h>
#include <string.h>

#include "brace/parameters.h"

static inline uint32_t brace_get_u32(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

static inline uint32_t brace_get_u16(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8;
}

static inline void brace_put_u32(uint8_t *bytes, uint32_t value)
{
    bytes[0] = (uint8_t)value;
    bytes[1] = (uint8_t)(value >> 8);
    bytes[2] = (uint8_t)(value >> 16);
    bytes[3] = (uint8_t)(value >> 24);
}

/* A value of a generated struct by its place: every member is 32 bits wide and lies at four times its place
 * (brace/measured.h and parameter_table.c assert this). */
static inline uint32_t brace_word_at(const void *values, uint32_t place)
{
    uint32_t word;
    memcpy(&word, (const uint8_t *)values + 4u * place, sizeof word);
    return word;
}

static inline uint32_t brace_member_get(const brace_parameters_t *parameters, uint32_t index)
{
    return brace_word_at(parameters, index);
}

static inline void brace_member_put(brace_parameters_t *parameters, uint32_t index, uint32_t word)
{
    memcpy((uint8_t *)parameters + 4u * index, &word, sizeof word);
}

#endif
