/* Bits of a CAN frame as one number, first byte lowest; values to and from a run of them. */
#ifndef BRACE_CAN_BITS_H
#define BRACE_CAN_BITS_H

#include <stdint.h>

void brace_bits_store(uint64_t bits, uint8_t data[8]);
uint64_t brace_bits_load(const uint8_t data[8]);

/* A value in steps; NaN is the code of 'not known', a value beyond the range is limited and counted. */
uint64_t brace_bits_signed(float value, float per_step, uint32_t start, uint32_t count, uint32_t *limited);
uint64_t brace_bits_unsigned(float value, float per_step, uint32_t start, uint32_t count, uint32_t *limited);
uint64_t brace_bits_number(uint32_t value, uint32_t start, uint32_t count, uint32_t *limited);
uint64_t brace_bits_whole(int32_t value, uint32_t start, uint32_t count, uint32_t *limited);
uint64_t brace_bits_float(float value, uint32_t start);

float brace_value_signed(uint64_t bits, uint32_t start, uint32_t count, float step);
float brace_value_unsigned(uint64_t bits, uint32_t start, uint32_t count, float step);
uint32_t brace_value_number(uint64_t bits, uint32_t start, uint32_t count);
int32_t brace_value_whole(uint64_t bits, uint32_t start, uint32_t count);
float brace_value_float(uint64_t bits, uint32_t start);

#endif
