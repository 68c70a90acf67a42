/* Loops whose bound can be seen: none of them is found. */
#include <stdint.h>

enum { MOST = 16 };

/* count: how many [0, 64] */
void loops_good(uint32_t count, uint8_t *bytes, uint32_t wanted, uint8_t few);

extern volatile uint32_t ready;

static uint32_t sum(const uint8_t *bytes, uint32_t n)
{
    uint32_t total = 0;
    for (uint32_t i = 0; i < n; i++) { /* its callers' arguments are bounded */
        for (uint32_t j = 0; j < i; j++) {
            total += bytes[j];
        }
    }
    return total;
}

static int too_far(uint32_t end)
{
    return end > 256u;
}

void loops_good(uint32_t count, uint8_t *bytes, uint32_t wanted, uint8_t few)
{
    for (uint32_t i = 0; i < count; i++) {
        bytes[i] = 0;
    }
    for (int i = 0; i < few; i++) {
        bytes[i] = 1;
    }
    const uint32_t least = wanted < MOST ? wanted : MOST;
    for (uint32_t i = 0; i < least; i++) {
        bytes[i] = (uint8_t)sum(bytes, MOST);
    }
    uint32_t polls = 1000u;
    while ((ready & 1u) == 0u && polls > 0u) {
        polls--;
    }
    for (uint32_t i = 0; i < 1000u && ready == 0u; i++) {
    }
    uint32_t value = wanted;
    do {
        value /= 10u;
    } while (value != 0u);
    for (int pass = 0;; pass++) {
        if (pass == MOST) {
            break;
        }
    }
    for (uint8_t *at = bytes, *end = bytes + count; at < end; at++) {
        *at = 2;
    }
    if (too_far(wanted)) {
        return;
    }
    for (uint32_t i = 0; i < wanted; i++) {
        bytes[i] = 3;
    }
    for (uint32_t i = 0; i < ready; i++) { /* at most 4: the device has no more */
    }
}
