/* What both kinds of bus use: the clock, and a reason in words. */
#include "bus_common.h"

#include <stdarg.h>
#include <stdio.h>
#include <time.h>

uint64_t brace_bus_now_us(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)now.tv_sec * 1000000u + (uint64_t)now.tv_nsec / 1000u;
}

int brace_bus_left_ms(uint64_t deadline_us)
{
    const uint64_t now_us = brace_bus_now_us();
    return now_us >= deadline_us ? 0 : (int)((deadline_us - now_us + 999u) / 1000u);
}

void brace_bus_say(char *why, unsigned why_room, const char *format, ...)
{
    if (why != NULL && why_room > 0u) {
        va_list arguments;
        va_start(arguments, format);
        vsnprintf(why, why_room, format, arguments);
        va_end(arguments);
    }
}
