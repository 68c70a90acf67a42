/* Angles as integers: for every one of them. */
#include "base/turn.h"
#include "proof.h"

#include "base/turn.c"

int main(void)
{
    const uint32_t turn = any_u32();
    const brace_sincos_t at = brace_turn_sincos(turn);
    PROVE((turn & 0x07ffffffu) != 0u || (turn >> 27) % 8u != 0u || at.sin == 0 || at.cos == 0, "the axes are exact");
    (void)brace_turn_from_q28(any_i32());
    return 0;
}
