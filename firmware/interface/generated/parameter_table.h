/* Written by tools/interface from dictionary.toml; do not edit. */
#ifndef BRACE_PARAMETER_TABLE_H
#define BRACE_PARAMETER_TABLE_H

#include <stdint.h>

#include "brace/parameters.h"

enum { BRACE_F32_RANGES = 25, BRACE_U32_RANGES = 10, BRACE_U32_LISTS = 2, BRACE_U32_LIST_MAX = 9 };

extern const float brace_f32_range[BRACE_F32_RANGES][2];
extern const uint32_t brace_u32_range[BRACE_U32_RANGES][2];
extern const uint32_t brace_u32_choices[BRACE_U32_LISTS][BRACE_U32_LIST_MAX]; /* 0 fills up */
extern const uint8_t brace_parameter_rule[BRACE_PARAMETER_COUNT];
extern const brace_parameters_t brace_parameters_safe;

#endif
