/* Pseudo-random numbers for tests: the same on every machine. */
#ifndef BRACE_TEST_NOISE_H
#define BRACE_TEST_NOISE_H

#include <stdint.h>

static uint32_t noise_state = 1;

/* Uniform in [0, 1). */
static inline double noise_uniform(void)
{
    noise_state ^= noise_state << 13;
    noise_state ^= noise_state >> 17;
    noise_state ^= noise_state << 5;
    return (double)(noise_state >> 8) / 16777216.0;
}

/* Mean 0, variance 1: a sum of twelve uniforms. */
static inline double noise_normal(void)
{
    double sum = -6.0;
    for (int i = 0; i < 12; i++) {
        sum += noise_uniform();
    }
    return sum;
}

#endif
