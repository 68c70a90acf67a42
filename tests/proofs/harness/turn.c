/* Angles as integers: for every one of them. */
#include "base/turn.h"
#include "proof.h"

#include "base/turn.c"

/* What lies off an entry is less than half the sine's one. */
static int is_off_entry(brace_off_entry_t off)
{
    return off.sin > -0x40000000 && off.sin < 0x40000000;
}

static int is_one(int32_t q30)
{
    return q30 == -0x40000000 || q30 == 0x3fffffff; /* as a float either is 2^30 */
}

int main(void)
{
    PROVE(is_off_entry(brace_off_entry(any_i32())), "what lies off an entry is small");
    const brace_off_entry_t off = {any_i32(), any_i32()};
    ASSUME(is_off_entry(off));
    for (int entry = 0; entry < BRACE_SINE_TABLE_SIZE; entry++) {
        (void)brace_opposite(brace_sine_table[entry], brace_sine_table[entry + BRACE_SINE_QUARTER], off);
    }
    const int32_t *entry = brace_opposite_entry(any_u32());
    (void)(entry[0] + (int64_t)entry[BRACE_SINE_QUARTER]);
    for (uint32_t quarter = 0; quarter < 4u; quarter++) {
        const brace_sum_sincos_t at = brace_turn_sincos(quarter << 30);
        const int32_t sin = BRACE_HIGH(at.sin), cos = BRACE_HIGH(at.cos);
        PROVE((quarter & 1u) == 0u ? sin == 0 && is_one(cos) : cos == 0 && is_one(sin), "the axes are exact");
    }
    (void)brace_turn_from_q28(any_i32());
    return 0;
}
