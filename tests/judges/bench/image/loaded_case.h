/* The loads of the bench's K under a load: weights of the limb's parts, and a force on the tip that differs from
 * posture to posture, up to 12 N. tests/judges/bench/loaded.py and loaded_space.py have the same numbers. */
#ifndef BENCH_LOADED_CASE_H
#define BENCH_LOADED_CASE_H

#include "brace/limb.h"

#define BENCH_FEMUR_N 2.0f
#define BENCH_KNEE_N 1.0f
#define BENCH_TIBIA_N 1.5f

static inline void load_of(int index, float force_n[2])
{
    force_n[0] = 2.0f * ((float)(index % 7) - 3.0f);
    force_n[1] = 2.0f * ((float)(index % 11) - 5.0f);
}

/* In space: the force across the limb's plane. */
static inline float sideways_of(int index)
{
    return 2.0f * ((float)(index % 5) - 2.0f);
}

#endif
