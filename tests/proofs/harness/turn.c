/* Angles as integers: for every one of them. */
#include "base/turn.h"
#include "proof.h"

#include "base/turn.c"

/* What lies off an entry is less than a tenth of the sine's one, and nearly all of the cosine's. */
static int is_off_entry(brace_off_entry_t off)
{
    return off.sin > -0x10000000 && off.sin < 0x10000000 && off.minus_cos < -0x7e000000;
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
    const int32_t *entry = brace_opposite_entry(any_u32());
    const brace_sum_sincos_t sum = brace_opposite(entry[0], entry[BRACE_SINE_QUARTER], off);
    PROVE(BRACE_HIGH(sum.sin) >= -0x60000000 && BRACE_HIGH(sum.cos) < 0x60000000, "the sums stay far from their ends");
    for (uint32_t quarter = 0; quarter < 4u; quarter++) {
        const brace_sum_sincos_t at = brace_turn_sincos(quarter << 30);
        const int32_t sin = BRACE_HIGH(at.sin), cos = BRACE_HIGH(at.cos);
        PROVE((quarter & 1u) == 0u ? sin == 0 && is_one(cos) : cos == 0 && is_one(sin), "the axes are exact");
    }
    (void)brace_turn_from_q28(any_i32());
    return 0;
}
