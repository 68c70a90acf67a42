/* How much of the stack nothing has ever used. */
#ifndef BRACE_BOARDS_STACK_H
#define BRACE_BOARDS_STACK_H

#include <stdint.h>

/* The pattern with which start-up fills the stack. */
enum { STACK_PAINT = 0x5354414B };

/* As brace_hal.h's entry. The context is not used. */
uint32_t stack_unused_bytes(void *context);

uint32_t stack_bytes(void);

/* The lowest address of the stack. */
uint32_t stack_limit_address(void);

#endif
