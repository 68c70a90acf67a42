/* What the fuzzers share: a controller on the fake board, chance, K by physics.md in double precision. */
#ifndef FUZZ_H
#define FUZZ_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app_bench.h"

void setUp(void) {}
void tearDown(void) {}

static uint64_t chance;
static unsigned long long seed;
static unsigned long fed; /* requests so far, for the report */

static inline uint32_t dice(uint32_t sides) /* xorshift64* */
{
    chance ^= chance >> 12;
    chance ^= chance << 25;
    chance ^= chance >> 27;
    return (uint32_t)((chance * 2685821657736338717ull) >> 33) % sides;
}

static inline void fuzz_seed(const char *text)
{
    seed = text != NULL ? strtoull(text, NULL, 10) : 1u;
    chance = seed * 0x9e3779b97f4a7c15ull | 1u;
}

static inline void fail(const char *what, const uint8_t *bytes, uint32_t count)
{
    printf("seed %llu, request %lu: %s:", seed, fed, what);
    for (uint32_t i = 0; i < count; i++) {
        printf(" %02x", bytes[i]);
    }
    printf("\n");
    exit(1);
}

static inline void mutate(uint8_t *bytes, uint32_t count)
{
    const uint32_t times = 1u + dice(3);
    for (uint32_t i = 0; i < times && count > 0u; i++) {
        uint8_t *byte = &bytes[dice(count)];
        static const uint8_t edge[] = {0x00, 0xff, 0x7f, 0x80, 0x01, 0xfe};
        *byte = dice(2) != 0u ? (uint8_t)(*byte ^ (1u << dice(8))) : dice(2) != 0u ? edge[dice(6)] : (uint8_t)dice(256);
    }
}

/* k_xx, k_xz, k_zz of the bench's limb, links and joints as springs in a row [N/mm]. false: stretched, no K. */
static inline bool paper_stiffness(const brace_parameters_t *p, double theta1, double theta2, double k[3])
{
    const double l1 = p->limb.femur_mm, l2 = p->limb.tibia_mm;
    const double b1 = p->limb.link[BRACE_FEMUR].bending_mm_per_n, b2 = p->limb.link[BRACE_TIBIA].bending_mm_per_n;
    const double u1[2] = {cos(theta1), sin(theta1)}, u2[2] = {cos(theta1 - theta2), sin(theta1 - theta2)};
    const double knee[2] = {l1 * u1[0], l1 * u1[1]}, shank[2] = {l2 * u2[0], l2 * u2[1]};
    const double p1[2] = {-knee[1] - shank[1], knee[0] + shank[0]}, p2[2] = {-shank[1], shank[0]};
    const double a1 = b1 / (l1 * l1), a2 = b2 / (l2 * l2);
    double c[3];
    for (int i = 0; i < 3; i++) {
        const int r = i == 2, s = i > 0;
        c[i] = ((double)p->limb.joint[BRACE_FEMUR].compliance_rad_per_n_mm + a1) * p1[r] * p1[s] -
               a1 * (p1[r] * p2[s] + p2[r] * p1[s]) +
               ((double)p->limb.joint[BRACE_TIBIA].compliance_rad_per_n_mm + a1 + a2) * p2[r] * p2[s] +
               (double)p->limb.link[BRACE_FEMUR].axial_mm_per_n * u1[r] * u1[s] +
               (double)p->limb.link[BRACE_TIBIA].axial_mm_per_n * u2[r] * u2[s];
    }
    const double det = c[0] * c[2] - c[1] * c[1];
    k[0] = c[2] / det, k[1] = -c[1] / det, k[2] = c[0] / det;
    return det > 1e-9;
}

#endif
