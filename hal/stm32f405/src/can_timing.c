#include "can_timing.h"

enum {
    QUANTA_MIN = 8,
    QUANTA_MAX = 25,
    BEFORE_MAX = 16,
    AFTER_MAX = 8,
    PRESCALER_MAX = 1024,
    RATE_MAX = 1000000,
    JUMP_MAX = 4
};

static uint32_t distance(uint32_t a, uint32_t b)
{
    return a > b ? a - b : b - a;
}

bool can_timing_find(uint32_t clock_hz, uint32_t bit_rate, can_timing_t *timing)
{
    bool found = false;
    uint32_t best_miss = 0; /* error of the sample point in units of 1 / (8 quanta), compared by cross products */
    uint32_t best_quanta = 1;
    for (uint32_t quanta = QUANTA_MAX; quanta >= QUANTA_MIN; quanta--) {
        const uint32_t rate = bit_rate * quanta;
        if (bit_rate == 0u || bit_rate > RATE_MAX || clock_hz % rate != 0u || clock_hz / rate > PRESCALER_MAX) {
            continue;
        }
        uint32_t after = (quanta + 4u) / 8u; /* an eighth of the bit, rounded */
        if (quanta - 1u - after > BEFORE_MAX) {
            after = quanta - 1u - BEFORE_MAX;
        }
        if (after > AFTER_MAX) {
            continue;
        }
        const uint32_t miss = distance(8u * after, quanta);
        if (!found || miss * best_quanta < best_miss * quanta) {
            found = true;
            best_miss = miss;
            best_quanta = quanta;
            timing->prescaler = clock_hz / rate;
            timing->before = quanta - 1u - after;
            timing->after = after;
            timing->jump = after < JUMP_MAX ? after : JUMP_MAX;
        }
    }
    return found;
}
