#include "second_clock.h"

#include "cortex_m.h"

void second_clock_start(void)
{
    SYSTICK_LOAD = (1u << SECOND_CLOCK_BITS) - 1u;
    SYSTICK_VALUE = 0u;
    SYSTICK_CONTROL = SYSTICK_ON_CORE_CLOCK;
}

uint32_t second_clock_count(void *context)
{
    (void)context;
    return SYSTICK_VALUE;
}
