/* Turns, angles and quotients of K under load in fixed point: every angle, every pivot. */
#include "loaded/fixed_solve.h"
#include "counted.h"
#include "loaded_sizes.h"

#include "fixed/fixed_table.c"

static uint64_t square_of(fixed_vec_t v)
{
    return (uint64_t)((int64_t)v.x * v.x) + (uint64_t)((int64_t)v.z * v.z);
}

static void directions_turn(uint32_t angle_turn)
{
    const fixed_vec_t by = fixed_direction(angle_turn);
    PROVE(square_of(by) <= DIRECTION_MOST * DIRECTION_MOST, "a direction lengthens nothing");
}

static void small_turns(int32_t angle_q29)
{
    const fixed_vec_t turn = fixed_small_turn(angle_q29);
    const uint64_t square = square_of(turn);
    PROVE(turn.x >= 0 && turn.z <= SMALL_SINE_MOST && turn.z >= -SMALL_SINE_MOST, "a small turn's parts");
    const uint64_t most =
        angle_q29 >= -SMALL_ANGLE_MOST && angle_q29 <= SMALL_ANGLE_MOST ? SMALL_TURN_MOST : LARGER_TURN_MOST;
    PROVE(square <= most * most, "a small turn lengthens by a thousandth at most, a larger one by four");
    PROVE(square >= SMALL_TURN_LEAST * SMALL_TURN_LEAST, "and shortens by as much");
}

static void pivots_invert(int32_t pivot_q27)
{
    const int32_t inverse = inverse_q27(pivot_q27);
    const int64_t product = (int64_t)inverse * pivot_q27, one = 1LL << 54;
    PROVE(inverse > 0 && product <= one + (one >> 29) && product >= one - 4 * (int64_t)pivot_q27, "one over a pivot");
}

static void go_through(uint32_t step)
{
    for (uint64_t i = 0; i < 1ull << 32; i += step) {
        const int32_t number = (int32_t)(uint32_t)i;
        directions_turn((uint32_t)i);
        if (number >= -LARGER_ANGLE_MOST && number <= LARGER_ANGLE_MOST) {
            small_turns(number);
        }
        if (number >= LEAST_PIVOT_Q27) {
            pivots_invert(number);
        }
    }
}

int main(void)
{
    go_through(4099u); /* finds most mistakes within a second */
    go_through(1u);
    return 0;
}
