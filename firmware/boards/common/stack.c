#include "stack.h"

extern uint32_t _stack_limit[], _stack_top[];

uint32_t stack_bytes(void)
{
    return (uint32_t)((uintptr_t)_stack_top - (uintptr_t)_stack_limit);
}

uint32_t stack_limit_address(void)
{
    return (uint32_t)(uintptr_t)_stack_limit;
}

uint32_t stack_unused_bytes(void *context)
{
    (void)context;
    const uint32_t words = stack_bytes() / (uint32_t)sizeof(uint32_t);
    uint32_t untouched = 0u;
    /* at most the stack, which the linker script bounds */
    while (untouched < words && _stack_limit[untouched] == (uint32_t)STACK_PAINT) {
        untouched++;
    }
    return untouched * (uint32_t)sizeof(uint32_t);
}
