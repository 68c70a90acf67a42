/* What all beyond a place holds against its turning, in fixed point; and short names. */
#ifndef BRACE_CORE_FIXED_SPACE_HELD_H
#define BRACE_CORE_FIXED_SPACE_HELD_H

#include "brace/loaded_space_fixed_types.h"
#include "fixed_space/frame.h"

typedef brace_space_fixed_link_t fixed_link3_t;
typedef brace_space_fixed_bent_t fixed_bent3_t;
typedef brace_space_fixed_turns_t fixed_turns3_t;
typedef brace_space_fixed_rest_t fixed_rest3_t;

/* What all beyond a place resists when it is turned about the axes there, and its moment. */
typedef struct {
    fixed_sym3_t resists_q24;
    fixed3_t moment_q27;
} fixed_held_t;

INLINE void note_row(fixed3_t row_q24, ranges_t ranges, noted_t *noted)
{
    note(noted, row_q24.x, ranges.row_most_bits);
    note(noted, row_q24.y, ranges.row_most_bits);
    note(noted, row_q24.z, ranges.row_most_bits);
}

/* How all beyond a coordinate follows what it resists: its entries times its compliance, less. */
INLINE int32_t follow(int32_t entry_q24, int32_t yields, ranges_t ranges, noted_t *noted)
{
    return minus(yielded_to(yields, entry_q24, ranges, noted));
}

INLINE fixed3_t follow_row(fixed3_t row_q24, int32_t yields, ranges_t ranges, noted_t *noted)
{
    return fixed3(follow(row_q24.x, yields, ranges, noted), follow(row_q24.y, yields, ranges, noted),
                  follow(row_q24.z, yields, ranges, noted));
}

INLINE void fixed_held_about_x(fixed_held_t *held, fixed_vec_t turn)
{
    fixed_sym3_about_x(&held->resists_q24, turn);
    held->moment_q27 = fixed_about_x(held->moment_q27, turn);
}

INLINE void fixed_held_about_y(fixed_held_t *held, fixed_vec_t turn)
{
    fixed_sym3_about_y(&held->resists_q24, turn);
    held->moment_q27 = fixed_about_y(held->moment_q27, turn);
}

INLINE void fixed_held_about_z(fixed_held_t *held, fixed_vec_t turn)
{
    fixed_sym3_about_z(&held->resists_q24, turn);
    held->moment_q27 = fixed_about_z(held->moment_q27, turn);
}

#endif
