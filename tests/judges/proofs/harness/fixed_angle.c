/* Angles of the fixed-point path: every one of them. */
#include "fixed/planar_fixed.c"
#include "proof.h"

#include "fixed/fixed_table.c"

enum { ENTRY_TURN_BITS = 26 };

static bool are_equal(brace_sincos_t a, brace_sincos_t b)
{
    return a.sin_q31 == b.sin_q31 && a.cos_q31 == b.cos_q31;
}

/* An angle is that of an entry and what is left from it. */
static void is_split(uint32_t angle_turn)
{
    const int32_t d = off_nearest(angle_turn); /* 2^31 stands for half an entry */
    const uint32_t entry_turn = angle_turn - (uint32_t)(d >> 6);
    PROVE(entry_turn % (1u << ENTRY_TURN_BITS) == 0u, "what is left leads to an entry");
    PROVE(are_equal(nearest(angle_turn), brace_fixed_sincos[entry_turn >> ENTRY_TURN_BITS]),
          "to the one that is taken");
}

static void are_exact_on_the_axes(void)
{
    const brace_sincos_t axis[4] = {
        {0, BRACE_FIXED_ONE}, {BRACE_FIXED_ONE, 0}, {0, -BRACE_FIXED_ONE}, {-BRACE_FIXED_ONE, 0}};
    for (uint32_t quarter = 0; quarter < 4u; quarter++) {
        PROVE(are_equal(sincos_of(quarter << 30), axis[quarter]), "the axes are exact");
    }
}

int main(void)
{
    is_split(any_u32());
    are_exact_on_the_axes();
    (void)sincos_of(any_u32());    /* CBMC's own checks: no sum overflows, no entry beyond the table is read */
    (void)direction_of(any_u32());
    (void)brace_turn_from_q28(any_i32());
    return 0;
}
