/* K under a load in space, in fixed point, for every limb, posture and load: the firmware's own text, with ranges
 * instead of numbers (ranged.h), from its inputs to C and to the buckling factor's pivots. */
#include <cmath>
#include <cstdint>
#include <cstring>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "loaded_sizes.h"
#include "ranged.h"
#include "ranged_text.h"

/* --- the firmware's text with numbers, for samples ------------------------------------------------------------- */

namespace plain {
#include "base/trig.c"
#include "fixed/fixed_table.c"
#include "fixed_space/loaded_space_fixed.c"
#include "fixed_space/loaded_space_fixed_collapse.c"
#include "loaded/loaded_space_collapse.c"
} // namespace plain

#undef BRACE_BUCKLING_SEARCH_H
#undef BRACE_CORE_BUCKLING_H
#undef BRACE_CORE_FIXED_SINCOS_H
#undef BRACE_CORE_FIXED_SPACE_BENT_H
#undef BRACE_CORE_FIXED_SPACE_ELIMINATE_H
#undef BRACE_CORE_FIXED_SPACE_FRAME_H
#undef BRACE_CORE_FIXED_SPACE_HELD_H
#undef BRACE_CORE_FIXED_SPACE_INVERT_H
#undef BRACE_CORE_FIXED_SPACE_NUMBER_H
#undef BRACE_CORE_FIXED_SPACE_STRAIGHT_H
#undef BRACE_CORE_FIXED_SPACE_SUM_H
#undef BRACE_CORE_FIXED_TURN_H
#undef BRACE_CORE_FIXED_WORD_H
#undef BRACE_CORE_LOADED_FIXED_VEC_H
#undef BRACE_CORE_SPACE_BUCKLING_H
#undef BRACE_CORE_VEC_H
#undef BRACE_FIXED_TABLE_H
#undef BRACE_FIXED_VEC_H
#undef BRACE_LIMB_FIELDS_H
#undef BRACE_LIMB_H
#undef BRACE_CONTACT_H
#undef BRACE_LOADED_H
#undef BRACE_LOADED_SPACE_FIXED_H
#undef BRACE_LOADED_SPACE_FIXED_TYPES_H
#undef BRACE_LOADED_SPACE_H
#undef BRACE_LOADED_SPACE_TYPES_H
#undef BRACE_LOADED_TYPES_H
#undef BRACE_STATUS_H
#undef BRACE_STIFFNESS_H
#undef BRACE_VEC_H

/* --- and with ranges ------------------------------------------------------------------------------------------- */

#define __builtin_clz(number) ranged::leading_zeros_of(number)

namespace firmware {

using int32_t = ranged::i32;
using uint32_t = ranged::u32;
using int64_t = ranged::i64;
using uint64_t = ranged::u64;
using ranged::has_length;
using ranged::length_of;
using ranged::now;
using ranged::wide_t;

constexpr wide_t WORD_MOST = (wide_t{1} << 31) - 1;

static long exact_of(uint32_t word)
{
    return static_cast<long>(ranged::machine::wrapped(word.range().least, word.kind).least);
}

static int32_t given(wide_t least, wide_t most, const std::int32_t *exact)
{
    return ranged::any<int32_t>(now.is_exact ? *exact : least, now.is_exact ? *exact : most);
}

/* Directions (loaded_turns). */
#define BRACE_CORE_FIXED_SINCOS_H
#include "fixed/fixed_table.h"
#include "fixed/fixed_word.h"
brace_sincos_t direction_of(uint32_t angle_turn);

/* Sums of products: Cauchy's inequality. */
static int64_t sum2(int32_t a, int32_t b, int32_t c, int32_t d);
static int64_t sum3(int32_t a, int32_t b, int32_t c, int32_t d, int32_t e, int32_t f);

#define sum2(first, ...) PICK(SUM2_##first, sum2, ~)(first, __VA_ARGS__)
#define SUM2_int32_t ~, text_sum2,
#define sum3(first, ...) PICK(SUM3_##first, sum3, ~)(first, __VA_ARGS__)
#define SUM3_int32_t ~, text_sum3,
#define fixed_direction text_direction
#define inverse_q27 text_inverse
#include "loaded/fixed_vec.h"
#undef sum2
#undef sum3
#undef fixed_direction
#undef inverse_q27

static int64_t by_lengths(int64_t sum, long double most, std::size_t complaints)
{
    if (now.complaint_count != complaints) {
        return sum;
    }
    const wide_t whole = static_cast<wide_t>(std::min(most, 0x1p100L)) + 1;
    return ranged::within(sum, -whole, whole);
}

static int64_t sum2(int32_t a, int32_t b, int32_t c, int32_t d)
{
    const std::size_t before = now.complaint_count;
    const int64_t sum = text_sum2(a, b, c, d);
    return by_lengths(sum, length_of({a, c}) * length_of({b, d}), before);
}

static int64_t sum3(int32_t a, int32_t b, int32_t c, int32_t d, int32_t e, int32_t f)
{
    const std::size_t before = now.complaint_count;
    const int64_t sum = text_sum3(a, b, c, d, e, f);
    return by_lengths(sum, length_of({a, c, e}) * length_of({b, d, f}), before);
}

static fixed_vec_t fixed_direction(uint32_t angle_turn)
{
    const auto exact = plain::fixed_direction(static_cast<std::uint32_t>(exact_of(angle_turn)));
    const fixed_vec_t by = {given(-DIRECTION_PART_MOST, DIRECTION_PART_MOST, &exact.x),
                            given(-DIRECTION_PART_MOST, DIRECTION_PART_MOST, &exact.z)};
    has_length({by.x, by.z}, DIRECTION_MOST);
    return by;
}

/* One over a pivot (loaded_turns). */
static int32_t inverse_q27(int32_t pivot_q27)
{
    const wide_t one = wide_t{1} << 54, least = LEAST_PIVOT_Q27;
    const ranged::range_t pivot = pivot_q27.range();
    PROVE(pivot.least >= least, "a pivot that is inverted is at least the least one");
    const std::int32_t exact = now.is_exact ? plain::inverse_q27(static_cast<std::int32_t>(pivot.least)) : 0;
    if (pivot.least < least) {
        return given(-WORD_MOST - 1, WORD_MOST, &exact);
    }
    return given(one / std::max(pivot.most, least) - 4, (one + (one >> 29)) / std::max(pivot.least, least), &exact);
}

#define over_q61 text_over_q61
#include "fixed_space/number.h"
#undef over_q61

/* One over a leading word (loaded_turns). */
static uint32_t over_q61(uint32_t leading)
{
    const wide_t one = wide_t{1} << 61;
    const ranged::range_t range = now.settled(leading.id);
    PROVE(range.least >= wide_t{1} << 31, "a number that is inverted has its highest bit set");
    const std::uint32_t exact = now.is_exact ? plain::over_q61(static_cast<std::uint32_t>(range.least)) : 0;
    const bool is_sound = range.least >= wide_t{1} << 31;
    const wide_t lowest = is_sound ? (wide_t{1} << 29) - 8 : 0, highest = is_sound ? one >> 31 : 2 * WORD_MOST + 1;
    return ranged::any<uint32_t>(now.is_exact ? exact : lowest, now.is_exact ? exact : highest);
}

/* --- vectors keep their length --------------------------------------------------------------------------------- */

#define fixed3_plus text_plus
#define fixed3_halved text_halved
#define fixed3_doubled text_doubled
#define fixed3_scaled_q30 text_scaled_q30
#define fixed3_plus_q30 text_plus_q30
#define fixed3_cross text_cross
#define fixed_axes_times text_axes_times
#define fixed_back text_back
#define fixed_about_x text_about_x
#define fixed_about_y text_about_y
#define fixed_about_z text_about_z
#define fixed_axes_about_x text_axes_about_x
#define fixed_axes_about_y text_axes_about_y
#define fixed_axes_about_z text_axes_about_z
#define fixed_small_turn_of text_small_turn_of
#define fixed_sym3_about_x text_sym3_about_x
#define fixed_sym3_about_y text_sym3_about_y
#define fixed_sym3_about_z text_sym3_about_z
#include "fixed_space/frame.h"
#undef fixed3_plus
#undef fixed3_halved
#undef fixed3_doubled
#undef fixed3_scaled_q30
#undef fixed3_plus_q30
#undef fixed3_cross
#undef fixed_axes_times
#undef fixed_back
#undef fixed_about_x
#undef fixed_about_y
#undef fixed_about_z
#undef fixed_axes_about_x
#undef fixed_axes_about_y
#undef fixed_axes_about_z
#undef fixed_small_turn_of
#undef fixed_sym3_about_x
#undef fixed_sym3_about_y
#undef fixed_sym3_about_z

/* Truncation, in each component, of a high word alone that is shifted up by two bits: below 4 units. */
constexpr long double COARSE = 4.0L, ROOT_OF_2 = 1.41421357L, ROOT_OF_3 = 1.7320509L;
constexpr long double ONE_Q30 = 0x1p30L;
constexpr long double SPRING_TURN = 0.25L; /* what end springs turn by, at most: noted */

static long double length3(fixed3_t v)
{
    return length_of({v.x, v.y, v.z});
}

/* A fact about a vector, unless a number on the way has left its word: then the vector may be anything. */
static fixed3_t with_length(fixed3_t v, long double most, std::size_t complaints)
{
    if (now.complaint_count == complaints) {
        has_length({v.x, v.y, v.z}, most);
    }
    return v;
}

static fixed3_t fixed3_plus(fixed3_t a, fixed3_t b)
{
    const std::size_t before = now.complaint_count;
    return with_length(text_plus(a, b), length3(a) + length3(b), before);
}

static fixed3_t fixed3_halved(fixed3_t a, uint32_t bits)
{
    const std::size_t before = now.complaint_count;
    const long double least = static_cast<long double>(bits.range().least);
    return with_length(text_halved(a, bits), length3(a) / exp2l(least) + ROOT_OF_3, before);
}

static fixed3_t fixed3_doubled(fixed3_t a, uint32_t bits)
{
    const std::size_t before = now.complaint_count;
    return with_length(text_doubled(a, bits), length3(a) * exp2l(static_cast<long double>(bits.range().most)), before);
}

static fixed3_t fixed3_scaled_q30(fixed3_t a, int32_t by)
{
    const std::size_t before = now.complaint_count;
    const long double most = length3(a) * (ranged::size_of(by) / ONE_Q30) + ROOT_OF_3 * COARSE;
    return with_length(text_scaled_q30(a, by), most, before);
}

static fixed3_t fixed3_plus_q30(fixed3_t a, fixed3_t b, int32_t by)
{
    const std::size_t before = now.complaint_count;
    const long double more = length3(b) * (ranged::size_of(by) / ONE_Q30) + ROOT_OF_3 * COARSE;
    return with_length(text_plus_q30(a, b, by), length3(a) + more, before);
}

static fixed3_t fixed3_cross(fixed3_t a, fixed3_t b, int bits)
{
    const std::size_t before = now.complaint_count;
    const long double most = length3(a) * (length3(b) / exp2l(bits)) + ROOT_OF_3 * exp2l(32 - bits);
    return with_length(text_cross(a, b, bits), most, before);
}

static fixed_vec_t fixed_back(fixed_vec_t turn)
{
    return text_back(turn); /* a number's negative has its magnitude, so that the length is known */
}

/* A small turn (loaded_turns) of an angle within that proof's range. */
static fixed_vec_t fixed_small_turn_of(int32_t angle_q29)
{
    const std::size_t before = now.complaint_count;
    const fixed_vec_t turn = text_small_turn_of(angle_q29);
    PROVE(ranged::size_of(angle_q29) <= SMALL_ANGLE_MOST, "a small turn is small");
    if (now.complaint_count == before) {
        has_length({turn.x, turn.z}, SMALL_TURN_MOST);
        ranged::within(turn.x, 0, SMALL_TURN_MOST);
        ranged::within(turn.z, -SMALL_SINE_MOST, SMALL_SINE_MOST);
    }
    return turn;
}

/* How much longer a turn makes a vector, at least 1. */
static long double factor_of(fixed_vec_t by)
{
    return std::max(1.0L, length_of({by.x, by.z}) / ONE_Q30);
}

/* Two of a vector's parts are turned: their length, and the whole vector's, grow by the turn's own length, and by what
 * is cut off: two times less than 4 units. */
template <class TURN> fixed3_t turned(fixed3_t v, fixed_vec_t by, int32_t fixed3_t::*p, int32_t fixed3_t::*q, TURN turn)
{
    const std::size_t before = now.complaint_count;
    const long double factor = factor_of(by), cut = ROOT_OF_2 * COARSE;
    has_length({v.*p, v.*q}, length3(v));
    const long double pair = length_of({v.*p, v.*q}) * factor + cut, whole = length3(v) * factor + cut;
    const fixed3_t result = turn(v, by);
    if (now.complaint_count == before) {
        has_length({result.*p, result.*q}, pair);
        has_length({result.x, result.y, result.z}, whole);
    }
    return result;
}

static fixed3_t fixed_about_x(fixed3_t v, fixed_vec_t by)
{
    return turned(v, by, &fixed3_t::y, &fixed3_t::z, text_about_x);
}

static fixed3_t fixed_about_y(fixed3_t v, fixed_vec_t by)
{
    return turned(v, by, &fixed3_t::z, &fixed3_t::x, text_about_y);
}

static fixed3_t fixed_about_z(fixed3_t v, fixed_vec_t by)
{
    return turned(v, by, &fixed3_t::x, &fixed3_t::y, text_about_z);
}

/* Of three axes the same holds for their three parts along x, along y and along z. */
template <class TURN>
void axes_turned(fixed_axes_t *axes, fixed_vec_t by, fixed3_t fixed_axes_t::*p, fixed3_t fixed_axes_t::*q, TURN turn)
{
    const std::size_t before = now.complaint_count;
    const long double factor = factor_of(by), cut = ROOT_OF_2 * COARSE;
    int32_t fixed3_t::*const part[3] = {&fixed3_t::x, &fixed3_t::y, &fixed3_t::z};
    long double pair[3], whole[3];
    for (int i = 0; i < 3; i++) {
        has_length({axes->*p.*part[i], axes->*q.*part[i]},
                   length_of({axes->x.*part[i], axes->y.*part[i], axes->z.*part[i]}));
        pair[i] = length_of({axes->*p.*part[i], axes->*q.*part[i]}) * factor + cut;
        whole[i] = length_of({axes->x.*part[i], axes->y.*part[i], axes->z.*part[i]}) * factor + cut;
    }
    turn(axes, by);
    if (now.complaint_count == before) {
        for (int i = 0; i < 3; i++) {
            has_length({axes->*p.*part[i], axes->*q.*part[i]}, pair[i]);
            has_length({axes->x.*part[i], axes->y.*part[i], axes->z.*part[i]}, whole[i]);
        }
    }
}

static void fixed_axes_about_x(fixed_axes_t *axes, fixed_vec_t by)
{
    axes_turned(axes, by, &fixed_axes_t::y, &fixed_axes_t::z, text_axes_about_x);
}

static void fixed_axes_about_y(fixed_axes_t *axes, fixed_vec_t by)
{
    axes_turned(axes, by, &fixed_axes_t::z, &fixed_axes_t::x, text_axes_about_y);
}

static void fixed_axes_about_z(fixed_axes_t *axes, fixed_vec_t by)
{
    axes_turned(axes, by, &fixed_axes_t::x, &fixed_axes_t::y, text_axes_about_z);
}

/* A vector's length, where its parts are known by shares: for each size, the length of the parts' shares of it. */
static ranged::shares_t shares_of_length(fixed3_t v)
{
    ranged::shares_t length;
    for (const int32_t part : {v.x, v.y, v.z}) {
        length.is_known = length.is_known || now.has_shares(part.id);
        const ranged::shares_t shares = now.shares_of(part.id);
        for (std::size_t i = 0; i < shares.by.size(); i++) {
            length.by[i] = std::sqrt(length.by[i] * length.by[i] + shares.by[i] * shares.by[i]);
        }
        length.more = std::sqrt(length.more * length.more + shares.more * shares.more);
    }
    return length;
}

/* Each part is a sum of products of two threes of numbers: Cauchy's inequality. */
static fixed3_t fixed_axes_times(const fixed_axes_t *e, fixed3_t v)
{
    const std::size_t before = now.complaint_count;
    const fixed3_t result = text_axes_times(e, v);
    if (now.complaint_count == before) {
        int32_t fixed3_t::*const part[3] = {&fixed3_t::x, &fixed3_t::y, &fixed3_t::z};
        const ranged::shares_t shares = shares_of_length(v);
        for (auto p : part) {
            const long double row = length_of({e->x.*p, e->y.*p, e->z.*p}) / 0x1p32L;
            has_length({result.*p}, row * length3(v) + 1.0L);
            ranged::with_shares(result.*p, shares.times(row, 1.0L));
        }
    }
    return result;
}

/* A symmetric matrix is known by the root of its nine entries' squares, added up. A turn (c, s) changes two rows and
 * columns, by 1 - 2 s^2 and 2 s c for cosine and sine of twice its angle. With n = c^2 + s^2 their length is the root
 * of 1 + 4 s^2 (n - 1). Truncation takes at most 8 units of each, together 12 of 2^30; half a unit of the mean; and 4
 * units of each turned part. */
static long double length_of_sym3(const fixed_sym3_t &m)
{
    return length_of({m.xx, m.xy, m.xy, m.xz, m.xz, m.yy, m.yz, m.yz, m.zz});
}

template <class TURN>
void sym3_turned(fixed_sym3_t *m, fixed_vec_t by, int32_t fixed_sym3_t::*aa, int32_t fixed_sym3_t::*ab,
                 int32_t fixed_sym3_t::*bb, int32_t fixed_sym3_t::*ar, int32_t fixed_sym3_t::*br, TURN turn)
{
    const std::size_t before = now.complaint_count;
    const long double factor = factor_of(by), square = factor * factor;
    const long double twice = std::sqrt(1.0L + 4.0L * square * (square - 1.0L)) + 12.0L / ONE_Q30;
    const long double cut = 12.0L;
    const long double block = length_of({m->*aa, m->*ab, m->*ab, m->*bb}) * twice + cut;
    const long double pair = length_of({m->*ar, m->*br}) * factor + ROOT_OF_2 * COARSE;
    const long double whole = length_of_sym3(*m) * std::max(factor, twice) + 24.0L;
    turn(m, by);
    if (now.complaint_count == before) {
        has_length({m->*aa, m->*ab, m->*ab, m->*bb}, block);
        has_length({m->*ar, m->*br}, pair);
        has_length({m->xx, m->xy, m->xy, m->xz, m->xz, m->yy, m->yz, m->yz, m->zz}, whole);
    }
}

static void fixed_sym3_about_x(fixed_sym3_t *m, fixed_vec_t by)
{
    sym3_turned(m, by, &fixed_sym3_t::yy, &fixed_sym3_t::yz, &fixed_sym3_t::zz, &fixed_sym3_t::xy, &fixed_sym3_t::xz,
                text_sym3_about_x);
}

static void fixed_sym3_about_y(fixed_sym3_t *m, fixed_vec_t by)
{
    sym3_turned(m, by, &fixed_sym3_t::zz, &fixed_sym3_t::xz, &fixed_sym3_t::xx, &fixed_sym3_t::yz, &fixed_sym3_t::xy,
                text_sym3_about_y);
}

static void fixed_sym3_about_z(fixed_sym3_t *m, fixed_vec_t by)
{
    sym3_turned(m, by, &fixed_sym3_t::xx, &fixed_sym3_t::xy, &fixed_sym3_t::yy, &fixed_sym3_t::xz, &fixed_sym3_t::yz,
                text_sym3_about_z);
}

#define over_second_step(first, ...) PICK(OVER_##first, any_over_second_step, ~)(first, __VA_ARGS__)
#define OVER_int32_t ~, text_over_second_step,
#define overload_softened(first, ...) PICK(SOFTENED_##first, any_overload_softened, ~)(first, __VA_ARGS__)
#define SOFTENED_int32_t ~, text_overload_softened,

#define multiply_determinant(first, ...) PICK(DETERMINANT_##first, any_determinant, ~)(first, __VA_ARGS__)
#define DETERMINANT_fixed_overload_t ~, text_determinant,

#define is_settled(first, ...) PICK(SETTLED first, text_is_settled, ~)(first, __VA_ARGS__) /* its call has a cast */
#define SETTLED(...) ~, any_is_settled,

#define fixed_bend_link(first, ...) PICK(BEND_##first, any_bend_link, ~)(first, __VA_ARGS__)
#define BEND_const ~, text_bend_link,

template <class LINK, class REST, class BENT, class NOTED>
void any_bend_link(const LINK *link, const REST *rest, fixed3_t turn, int32_t twists_q27, BENT *bent, NOTED *noted);
static int32_t any_over_second_step(int32_t second_by_first, uint32_t first2);
static bool any_is_settled(uint32_t first2_q25, uint32_t second2_q25);
template <class OVERLOAD, class NOTED>
int32_t any_overload_softened(int32_t yields_q14, int32_t entry_q24, OVERLOAD *overload, NOTED *noted);
template <class OVERLOAD> void any_determinant(OVERLOAD *overload, uint32_t pivot_q20, bool is_negative);

#include "fixed_space/loaded_space_fixed.c"

/* The link's direction (x, z), turned by a quarter, and turned by a share s of the link's turn besides, is
 * (-z - s x, x - s z), which is the root of 1 + s^2 long. What shortens the link makes its first part smaller. */
template <class LINK, class REST, class BENT, class NOTED>
void any_bend_link(const LINK *link, const REST *rest, fixed3_t turn, int32_t twists_q27, BENT *bent, NOTED *noted)
{
    const std::size_t before = now.complaint_count;
    text_bend_link(link, rest, turn, twists_q27, bent, noted);
    if (now.complaint_count == before) {
        const long double share = ranged::size_of(link->end_share_q30) / ONE_Q30;
        const long double turned_y = share * (ranged::size_of(turn.y) / 0x1p29L) + 8.0L / ONE_Q30;
        const long double turned_z = share * (ranged::size_of(turn.z) / 0x1p29L) + 8.0L / ONE_Q30;
        const long double along = length_of({link->along_q30.x, link->along_q30.z});
        const long double shortens = ranged::size_of(link->shortens_q30) * SPRING_TURN + 8.0L;
        const long double flat = along * std::sqrt(1.0L + turned_z * turned_z) + 2.0L * shortens + ROOT_OF_2 * COARSE;
        has_length({bent->across_q30.x, bent->across_q30.y}, flat);
        has_length({bent->across_q30.x, bent->across_q30.y, bent->across_q30.z},
                   along * std::sqrt(1.0L + turned_y * turned_y + turned_z * turned_z) + 2.0L * shortens +
                       ROOT_OF_3 * COARSE);
    }
}

/* By how much the second step is prolonged (space_step). */
static int32_t any_over_second_step(int32_t second_by_first, uint32_t first2)
{
    const std::int32_t by = static_cast<std::int32_t>(second_by_first.range().least);
    const std::int32_t exact =
        now.is_exact ? (plain::over_second_step)(by, static_cast<std::uint32_t>(exact_of(first2))) : 0;
    PROVE(ranged::size_of(second_by_first) <= 0x1p30L, "steps' products are within their proof's range");
    if (ranged::size_of(second_by_first) > 0x1p30L) {
        return given(-WORD_MOST - 1, WORD_MOST, &exact);
    }
    return given(PART_OF(29, 0.5), PART_OF(29, 2.001), &exact);
}

static bool any_is_settled(uint32_t first2_q25, uint32_t second2_q25)
{
    const std::vector<bool> answers = ranged::each_way([&] { return text_is_settled(first2_q25, second2_q25); });
    return std::find(answers.begin(), answers.end(), true) != answers.end();
}

/* The firmware uses the determinant also of a run that is refused later. So the numbers made up to this pivot must be
 * right without any note that comes after it: from here on no note bounds them. */
template <class OVERLOAD> void any_determinant(OVERLOAD *overload, uint32_t pivot_q20, bool is_negative)
{
    text_determinant(overload, pivot_q20, is_negative);
    now.first_to_learn_of = now.numbers.size();
}

template <class OVERLOAD, class NOTED>
int32_t any_overload_softened(int32_t yields_q14, int32_t entry_q24, OVERLOAD *overload, NOTED *noted)
{
    struct result_t {
        int32_t word;
        OVERLOAD overload;
    };
    const auto results = ranged::each_way([&] {
        OVERLOAD changed = *overload;
        const int32_t word = text_overload_softened(yields_q14, entry_q24, &changed, noted);
        return result_t{word, changed};
    });
    std::vector<int32_t> words, mantissas, exponents;
    for (const result_t &result : results) {
        words.push_back(result.word);
        mantissas.push_back(result.overload.mantissa_q31);
        exponents.push_back(result.overload.exponent);
    }
    *overload = results.front().overload;
    overload->mantissa_q31 = ranged::any_of(mantissas);
    overload->exponent = ranged::any_of(exponents);
    return ranged::any_of(words);
}

/* --- the inputs ------------------------------------------------------------------------------------------------ */

/* A limb, a posture and a load, in words. */
struct sample_t {
    plain::brace_loaded_space_fixed_t limb;
    plain::fixed_inputs3_t in;
    plain::fixed_rest3_t rest;
    std::int32_t times_q27;
};

/* Where numbers stand: a sample's, or no sample. */
static const sample_t *sample;
static const std::int32_t zero = 0;
#define GIVEN(least, most, place) given(least, most, sample == nullptr ? &zero : &sample->place)

/* What the collapse's last look lets through (fixed_space/space_kept.h). */
#define ANY_LINK(link)                                                                                                 \
    fixed_link3_t                                                                                                      \
    {                                                                                                                  \
        .length_q28 = GIVEN(0, LENGTHS_MOST_Q28, limb.link.length_q28),                                                \
        .twelfth_q28 = GIVEN(0, LENGTHS_MOST_Q28 / 12 + 2, limb.link.twelfth_q28),                                     \
        .along_q30 = {GIVEN(-ALONG_MOST_Q30, ALONG_MOST_Q30, limb.link.along_q30.x),                                   \
                      GIVEN(-ALONG_MOST_Q30, ALONG_MOST_Q30, limb.link.along_q30.z)},                                  \
        .tilt_q28 = {GIVEN(-TILT_MOST, TILT_MOST, limb.link.tilt_q28.x),                                               \
                     GIVEN(-TILT_MOST, TILT_MOST, limb.link.tilt_q28.z)},                                              \
        .bow_q28 = {GIVEN(-BOW_MOST, BOW_MOST, limb.link.bow_q28.x), GIVEN(-BOW_MOST, BOW_MOST, limb.link.bow_q28.z)}, \
        .twist_q31 = GIVEN(0, TWIST_MOST_Q31, limb.link.twist_q31),                                                    \
        .sideways_q31 = GIVEN(0, WORD_MOST, limb.link.sideways_q31),                                                   \
        .bend_q31 = GIVEN(0, WORD_MOST, limb.link.bend_q31),                                                           \
        .across_arm_q31 = GIVEN(0, WORD_MOST, limb.link.across_arm_q31),                                               \
        .sideways_arm_q31 = GIVEN(0, WORD_MOST, limb.link.sideways_arm_q31),                                           \
        .across_spread_q31 = GIVEN(0, SPREAD_MOST_Q31, limb.link.across_spread_q31),                                   \
        .sideways_spread_q31 = GIVEN(0, SPREAD_MOST_Q31, limb.link.sideways_spread_q31),                               \
        .stretch_q31 = GIVEN(0, WORD_MOST, limb.link.stretch_q31),                                                     \
        .end_share_q30 = GIVEN(0, SHARE_MOST_Q30, limb.link.end_share_q30),                                            \
        .stretch_end_share_q30 = GIVEN(-(1 << 29), 1 << 29, limb.link.stretch_end_share_q30),                          \
        .own_share_q30 = GIVEN(0, 1 << 29, limb.link.own_share_q30),                                                   \
        .curl_q30 = GIVEN(0, 1 << 30, limb.link.curl_q30),                                                             \
        .shortens_q30 = GIVEN(0, SHORTENS_MOST_Q30, limb.link.shortens_q30),                                           \
        .weight_q31 = GIVEN(0, WORD_MOST, limb.link.weight_q31),                                                       \
        .arm_shift = ranged::any<uint32_t>(sample == nullptr ? 0 : sample->limb.link.arm_shift,                        \
                                           sample == nullptr ? ARM_SHIFT_MOST : sample->limb.link.arm_shift)           \
    }

constexpr wide_t TILT_MOST = wide_t{LENGTHS_MOST_Q28} * TILT_MOST_Q30 / (1 << 30) + 2;
constexpr wide_t BOW_MOST = wide_t{LENGTHS_MOST_Q28} * BOW_MOST_Q30 / (1 << 30) + 2;

/* What grows with the link's length, and how; the sum of all lengths is one unit. */
static void with_lengths(fixed_link3_t *link, std::size_t index)
{
    ranged::shares_t length = {.is_known = true};
    length.by[index] = LENGTHS_MOST_Q28;
    ranged::with_shares(link->length_q28, length);
    ranged::with_shares(link->twelfth_q28, length.times(1.0L / 12.0L, 2.0L));
    for (const int32_t part : {link->tilt_q28.x, link->tilt_q28.z}) {
        ranged::with_shares(part, length.times(TILT_MOST_Q30 / ONE_Q30, 2.0L));
    }
    for (const int32_t part : {link->bow_q28.x, link->bow_q28.z}) {
        ranged::with_shares(part, length.times(BOW_MOST_Q30 / ONE_Q30, 2.0L));
    }
    has_length({link->along_q30.x, link->along_q30.z}, static_cast<long double>(ALONG_MOST_Q30));
    has_length({link->tilt_q28.x, link->tilt_q28.z}, static_cast<long double>(TILT_MOST));
    has_length({link->bow_q28.x, link->bow_q28.z}, static_cast<long double>(BOW_MOST));
}

/* The unit of force is above the components' sum and one and a half times all weights. So the range of the force at the
 * tip is cut into parts, and for each the weights are at most what the least force of the part leaves them. The femur's
 * weight and that beyond it are all of it; so that weight is cut into shares. */
constexpr int SHARES[] = {9, 7, 5, 3, 2, 2, 2, 2}, PARTS = 8; /* the more weight, the more shares */
static int part, share;

static wide_t force_most() { return PART_OF(30, 1.0) * (part + 1) / PARTS; }
static wide_t weight_most() { return (PART_OF(30, 1.0) - PART_OF(30, 1.0) * part / PARTS) * 2 / 3 + 4096; }

static wide_t own_weight_most() { return weight_most() * (share + 1) / SHARES[part] + WEIGHTS_APART_Q31; }

static bool is_of_this_part(const sample_t &of)
{
    const auto &tip = of.in.tip_q30;
    const auto &weights = of.in.weights;
    const long double length = std::sqrt(1.0L * tip.x * tip.x + 1.0L * tip.y * tip.y + 1.0L * tip.z * tip.z);
    const wide_t own = weight_most() * share / SHARES[part], own_most = own_weight_most();
    return length <= static_cast<long double>(force_most()) && weights.beyond_coxa_q30 <= weight_most() &&
           weights.femur_q30 >= own && weights.femur_q30 <= own_most;
}

static uint32_t given_shift(const std::uint32_t *exact)
{
    return ranged::any<uint32_t>(now.is_exact ? *exact : 0, now.is_exact ? *exact : 31);
}

/* Where rest, K and a step of the search end, what was answered there, and whether it is refused: of a sample. */
struct stage_t {
    std::size_t end;
    bool is_refused;
    std::vector<long> words;
};
static std::vector<stage_t> stages;
static std::vector<long> told;

template <class OBJECT> void words_of(const OBJECT &object)
{
    const int32_t *const words = reinterpret_cast<const int32_t *>(&object);
    for (std::size_t i = 0; i < sizeof object / sizeof *words; i++) {
        told.push_back(static_cast<long>(words[i].range().least));
    }
}

static void end_stage(noted_t noted)
{
    stages.push_back({now.numbers.size(), (noted.range().least >> NOTED_BITS) != 0, told});
    told.clear();
}

static void run_once()
{
    brace_loaded_space_fixed_t limb = {};
    limb.coxa = ANY_LINK(coxa);
    limb.femur = ANY_LINK(femur);
    limb.tibia = ANY_LINK(tibia);
    with_lengths(&limb.coxa, 0);
    with_lengths(&limb.femur, 1);
    with_lengths(&limb.tibia, 2);
    limb.base_x_q31 = GIVEN(0, WORD_MOST, limb.base_x_q31);
    limb.base_z_q31 = GIVEN(0, WORD_MOST, limb.base_z_q31);

    const wide_t one = PART_OF(30, 1.0), down = one + (one >> 10), force = force_most(), weight = weight_most();
    const wide_t own = weight * share / SHARES[part], own_most = own_weight_most();
    const wide_t beyond = weight - own + WEIGHTS_APART_Q31;
    fixed_inputs3_t in = {
        .tip_q30 = {GIVEN(-force, force, in.tip_q30.x), GIVEN(-force, force, in.tip_q30.y),
                    GIVEN(-force, force, in.tip_q30.z)},
        .down_q30 = {GIVEN(-down, down, in.down_q30.x), GIVEN(-down, down, in.down_q30.y),
                     GIVEN(-down, down, in.down_q30.z)},
        .weights = {GIVEN(0, weight, in.weights.beyond_coxa_q30), GIVEN(0, beyond, in.weights.beyond_femur_q30),
                    GIVEN(own, own_most, in.weights.femur_q30),
                    GIVEN(0, beyond + WEIGHTS_APART_Q31, in.weights.tibia_q30)},
        .yields = {.base_q26 = GIVEN(0, WORD_MOST, in.yields.base_q26),
                   .yaw_q26 = GIVEN(0, WORD_MOST, in.yields.yaw_q26),
                   .hip_q26 = GIVEN(0, WORD_MOST, in.yields.hip_q26),
                   .knee_q26 = GIVEN(0, WORD_MOST, in.yields.knee_q26)}};
    has_length({in.tip_q30.x, in.tip_q30.y, in.tip_q30.z}, static_cast<long double>(force));
    fixed_rest3_t rest = {};
    static const std::uint32_t none = 0;
    const std::uint32_t whole = sample == nullptr ? ~0u : 0u;
    const std::uint32_t theta1 = sample == nullptr ? 0 : sample->rest.theta1_turn;
    const std::uint32_t theta2 = sample == nullptr ? 0 : sample->rest.theta2_turn;
    rest.theta1_turn = ranged::any<uint32_t>(theta1, theta1 + whole);
    rest.theta2_turn = ranged::any<uint32_t>(theta2, theta2 + whole);
    rest.turn_shift = given_shift(sample == nullptr ? &none : &sample->rest.turn_shift);
    rest.spring_shift = given_shift(sample == nullptr ? &none : &sample->rest.spring_shift);
    in.yields.turn_shift = rest.turn_shift;
    rest.base_q26 = in.yields.base_q26;
    rest.yaw_q26 = GIVEN(0, WORD_MOST, rest.yaw_q26);
    rest.hip_q26 = GIVEN(0, WORD_MOST, rest.hip_q26);
    rest.knee_q26 = GIVEN(0, WORD_MOST, rest.knee_q26);

    stages = {};
    noted_t noted = 0u;
    rest.whole_q30 = fixed3_plus_q30(in.tip_q30, in.down_q30, in.weights.beyond_coxa_q30);
    (void)find_rest(&limb, &in, &rest, &noted);
    words_of(rest.pose);
    end_stage(noted);

    noted = 0u;
    fixed_freedoms_t free;
    fixed_frames_t frames;
    fixed_sum_t sum;
    fixed_eliminate_limb(&limb, &rest, nullptr, &free, &noted);
    fixed_frames_of(&rest.turns, &frames);
    fixed_sum_limb(&limb, &rest, &free, &frames, &sum, &noted);
    words_of(moved(&limb, &rest, sum.tip_q28));
    for (const int64_t &entry : {sum.c.xx, sum.c.yy, sum.c.zz}) {
        PROVE(ranged::size_of(entry) <= SPACE_C_MOST, "C is one that is inverted");
    }
    end_stage(noted);

    noted = 0u;
    now.first_to_learn_of = now.numbers.size();
    fixed_overload_t overload = {.times_q27 = GIVEN(0, WORD_MOST, times_q27), .mantissa_q31 = 1 << 30, .exponent = 1,
                                 .is_negative = false, .has_buckled = false, .is_refused = false};
    fixed_eliminate_limb(&limb, &rest, &overload, &free, &noted);
    words_of(overload.mantissa_q31);
    end_stage(noted);
}

} // namespace firmware

/* --- samples --------------------------------------------------------------------------------------------------- */

namespace samples {

static std::uint32_t state = 20261126u;

static float any(float least, float most)
{
    state = state * 1664525u + 1013904223u;
    return least + (most - least) * (static_cast<float>(state >> 8) / 16777216.0f);
}

static float any_size(float least_log10, float most_log10)
{
    return std::pow(10.0f, any(least_log10, most_log10));
}

/* A turn too small to matter, or up to what a word holds. */
static float any_turn(float most_log10)
{
    return any_size(any(0.0f, 1.0f) < 0.3f ? -6.0f : -1.5f, any(0.0f, 1.0f) < 0.5f ? -1.0f : most_log10);
}

static plain::brace_limb_t any_limb(float force_n, float *reach_mm)
{
    plain::brace_limb_t limb = {};
    limb.coxa_mm = any(0.0f, 1.0f) < 0.2f ? any_size(-3.0f, 1.0f) : any(1.0f, 120.0f);
    limb.femur_mm = any(1.0f, 250.0f);
    limb.tibia_mm = any(1.0f, 250.0f);
    *reach_mm = limb.coxa_mm + limb.femur_mm + limb.tibia_mm;
    const float moment = *reach_mm * force_n;
    const float lengths[] = {limb.coxa_mm, limb.femur_mm, limb.tibia_mm};
    for (int i = 0; i < 3; i++) {
        const float bends = lengths[i] * lengths[i] / (1.5f * moment);
        limb.link[i] = {.axial_mm_per_n = any_size(-6.0f, -0.5f) * *reach_mm / force_n,
                        .bending_mm_per_n = any_turn(0.7f) * bends,
                        .tilt_rad = any(0.0f, 1.0f) < 0.5f ? 0.0f : any(-1.57f, 1.57f),
                        .lateral_mm_per_n = any_turn(0.7f) * bends,
                        .torsion_rad_per_n_mm = any_turn(1.0f) / moment,
                        .moment_transfer_ratio = any(0.0f, 1.0f) < 0.4f ? 1.0f : any(0.0f, 1.0f)};
        limb.joint[i].compliance_rad_per_n_mm = any_turn(0.7f) / moment;
    }
    limb.base = {any_size(-6.0f, -1.0f) * *reach_mm / force_n, any_size(-6.0f, -1.0f) * *reach_mm / force_n,
                 any_turn(0.0f) / moment};
    return limb;
}

/* A limb, a posture and a load as far as the inputs' checks let them through. returns whether they do */
static bool any_sample(firmware::sample_t *sample)
{
    const float force_n = any_size(-1.0f, 3.0f);
    float reach_mm;
    const plain::brace_limb_t limb = any_limb(force_n, &reach_mm);
    const float heavy = any(0.0f, 1.0f) < 0.5f ? 0.0f : any(0.0f, 0.5f) * force_n;
    const plain::brace_gravity_t weights = {.femur_n = any(0.0f, heavy), .tibia_n = any(0.0f, heavy),
                                            .knee_n = any(0.0f, heavy)};
    const float size = any(0.0f, 1.0f) < 0.3f ? 1.0f : any_size(-3.0f, 0.0f);
    const plain::brace_space_load_t load = {
        .tip_n = {any(-1.0f, 1.0f) * size * force_n, any(-1.0f, 1.0f) * size * force_n,
                  any(-1.0f, 1.0f) * size * force_n},
        .down = {any(-1.0f, 1.0f), any(-1.0f, 1.0f), any(-1.0f, 1.0f)},
        .yaw = {limb.joint[0].compliance_rad_per_n_mm, limb.joint[0].compliance_rad_per_n_mm},
        .hip = {limb.joint[1].compliance_rad_per_n_mm, limb.joint[1].compliance_rad_per_n_mm},
        .knee = {limb.joint[2].compliance_rad_per_n_mm, limb.joint[2].compliance_rad_per_n_mm}};
    plain::brace_loaded_space_t loaded;
    *sample = {};
    plain::brace_loaded_space_collapse(&limb, &weights, &loaded);
    plain::brace_loaded_space_fixed_collapse(&loaded, &sample->limb);
    sample->times_q27 = static_cast<std::int32_t>(any_size(0.0f, 1.2f) * 0x1p27f);
    return plain::inputs_of(&sample->limb, any(-3.0f, 3.0f), any(-3.0f, 3.0f), &load, &sample->in, &sample->rest) ==
           plain::BRACE_OK;
}

/* What the firmware answers. */
static std::vector<std::vector<long>> told_plainly(const firmware::sample_t &sample)
{
    std::vector<std::vector<long>> told(3);
    const auto tell = [](std::vector<long> *words, const auto &object) {
        const std::int32_t *const first = reinterpret_cast<const std::int32_t *>(&object);
        words->insert(words->end(), first, first + sizeof object / sizeof *first);
    };
    plain::fixed_rest3_t rest = sample.rest;
    plain::noted_t noted = 0u;
    rest.whole_q30 =
        plain::fixed3_plus_q30(sample.in.tip_q30, sample.in.down_q30, sample.in.weights.beyond_coxa_q30);
    (void)plain::find_rest(&sample.limb, &sample.in, &rest, &noted);
    tell(&told[0], rest.pose);
    noted = 0u;
    plain::fixed_freedoms_t free;
    plain::fixed_frames_t frames;
    plain::fixed_sum_t sum;
    plain::fixed_eliminate_limb(&sample.limb, &rest, nullptr, &free, &noted);
    plain::fixed_frames_of(&rest.turns, &frames);
    plain::fixed_sum_limb(&sample.limb, &rest, &free, &frames, &sum, &noted);
    tell(&told[1], plain::moved(&sample.limb, &rest, sum.tip_q28));
    noted = 0u;
    plain::fixed_overload_t overload = {.times_q27 = sample.times_q27, .mantissa_q31 = 1 << 30, .exponent = 1};
    plain::fixed_eliminate_limb(&sample.limb, &rest, &overload, &free, &noted);
    tell(&told[2], overload.mantissa_q31);
    return told;
}

struct counts_t {
    std::size_t samples, told[3];
};

/* Runs a sample on single numbers. returns what is wrong with it, if anything */
static const char *trouble_of(const firmware::sample_t &sample, const std::map<ranged::key_t, ranged::range_t> &proven,
                              counts_t *counts)
{
    firmware::sample = &sample;
    ranged::run_exactly(firmware::run_once);
    firmware::sample = nullptr;
    const std::vector<std::vector<long>> plainly = told_plainly(sample);
    counts->samples++;
    std::size_t first = 0;
    for (std::size_t i = 0; i < firmware::stages.size(); i++) {
        const firmware::stage_t &stage = firmware::stages[i];
        if (stage.is_refused) {
            if (i == 0) {
                return nullptr;
            }
        } else {
            counts->told[i]++;
            if (ranged::outside(proven, first, stage.end) != 0) {
                return "a number outside its range";
            }
            if (stage.words != plainly[i]) {
                return "not what the firmware answers";
            }
        }
        first = stage.end;
    }
    return nullptr;
}

} // namespace samples

int main(int, char **arguments)
{
    using ranged::now;
    constexpr std::size_t SAMPLES = 300;
    now.noted_limit = 1 << NOTED_BITS;
    std::vector<firmware::sample_t> left_over;
    while (left_over.size() < SAMPLES) {
        firmware::sample_t sample;
        if (samples::any_sample(&sample)) {
            left_over.push_back(sample);
        }
    }
    samples::counts_t counts = {};
    for (firmware::part = 0; firmware::part < firmware::PARTS; firmware::part++) {
        for (firmware::share = 0; firmware::share < firmware::SHARES[firmware::part]; firmware::share++) {
            const std::size_t left = ranged::prove(firmware::run_once);
            if (left != 0) {
                std::printf("part %d, share %d: %zu places\n", firmware::part, firmware::share, left);
                for (std::size_t i = 0; i < std::min<std::size_t>(left, 8); i++) {
                    ranged::tell(arguments[0], now.complaints[i].first, now.complaints[i].second);
                }
                return 1;
            }
            const auto proven = ranged::ranges();
            std::vector<firmware::sample_t> others;
            for (const firmware::sample_t &sample : left_over) {
                if (!firmware::is_of_this_part(sample)) {
                    others.push_back(sample);
                } else if (const char *const trouble = samples::trouble_of(sample, proven, &counts)) {
                    std::printf("sample %zu: %s\n", counts.samples, trouble);
                    return 1;
                }
            }
            left_over = others;
        }
    }
    if (!left_over.empty() || counts.told[0] < SAMPLES / 4) {
        std::printf("%zu samples are of no part, %zu were told\n", left_over.size(), counts.told[0]);
        return 1;
    }
    if (std::getenv("BRACE_PROOF_COUNTS") != nullptr) {
        std::printf("%zu samples: rest of %zu, K of %zu, a step of the search of %zu\n", counts.samples, counts.told[0],
                    counts.told[1], counts.told[2]);
    }
    return 0;
}
