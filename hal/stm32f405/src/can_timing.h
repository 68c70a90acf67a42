/* Bit timing of bxCAN. */
#ifndef STM32F405_CAN_TIMING_H
#define STM32F405_CAN_TIMING_H

#include <stdbool.h>
#include <stdint.h>

/* One bit in quanta of prescaler / clock: 1 + before + after. The sample is taken between before and after. */
typedef struct {
    uint32_t prescaler;      /* [1, 1024] */
    uint32_t before, after; /* quanta before the sample point (synchronising one excluded) and after [1, 16], [1, 8] */
    uint32_t jump; /* most quanta by which a bit may be moved to stay in step [1, 4] */
} can_timing_t;

/* Finds exact bit rates only. Among all ways to make one with 8 to 25 quanta it takes the sample point nearest to 87.5
 * % of the bit (as CiA 301 recommends), and of equals the way with more quanta. false: the clock cannot make this rate.
 * At 42 MHz: 125 and 250 kbit/s sample at 87.5 %, 500 kbit/s and 1 Mbit/s at 85.7 %. */
bool can_timing_find(uint32_t clock_hz, uint32_t bit_rate, can_timing_t *timing);

#endif
