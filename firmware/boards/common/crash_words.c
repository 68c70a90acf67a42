#include "crash_words.h"

typedef struct {
    uint32_t bit; /* of CFSR: Arm DDI 0403E, B3.2.15 */
    const char *words;
} reason_t;

static const reason_t reasons[] = {
    {1u << 25, "division by zero"},
    {1u << 24, "unaligned access"},
    {1u << 19, "coprocessor or FPU not there, or not switched on"},
    {1u << 18, "return from exception gone wrong"},
    {1u << 17, "jump to an address that is no Thumb code"},
    {1u << 16, "undefined instruction"},
    {1u << 9, "no memory or device at the address in bfar"},
    {1u << 10, "no memory or device at the address written to a little earlier"},
    {1u << 8, "jump to where no memory is"},
    {1u << 12, "stack could not be written on exception"},
    {1u << 11, "stack could not be read on return"},
    {1u << 1, "forbidden access to the address in mmfar"},
    {1u << 0, "jump to where no code may be"},
    {1u << 4, "stack forbidden on exception"},
};

const char *crash_exception(const brace_crash_record_t *record)
{
    switch (record->exception) {
    case 2: return "watchdog: the main loop stood still";
    case 3: return "hard fault";
    case 4: return "memory fault";
    case 5: return "bus fault";
    case 6: return "usage fault";
    default: return record->exception >= 16u ? "interrupt without a handler" : "exception without a handler";
    }
}

const char *crash_reason(const brace_crash_record_t *record, uint32_t stack_limit)
{
    if (record->sp < stack_limit + 32u) { /* the stack had no room even for a frame */
        return "the stack overflowed";
    }
    for (uint32_t i = 0u; i < sizeof reasons / sizeof reasons[0]; i++) {
        if ((record->cfsr & reasons[i].bit) != 0u) {
            return reasons[i].words;
        }
    }
    return "";
}
