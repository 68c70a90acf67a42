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

#define PROVE(condition, claim)                                                                                        \
    do {                                                                                                               \
        enum { PROVED };                                                                                               \
        if (!(condition)) {                                                                                            \
            ranged::now.complain(claim);                                                                               \
        }                                                                                                              \
    } while (0)

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

/* A function that its own file calls: its definition, whose first parameter begins with a type, becomes text_..., and a
 * call of it becomes a stand-in's. */
#define SECOND(first, second, ...) second
#define PICK(...) SECOND(__VA_ARGS__)

namespace firmware {

using int32_t = ranged::i32;
using uint32_t = ranged::u32;
using int64_t = ranged::i64;
using uint64_t = ranged::u64;
using ranged::has_length;
using ranged::length_of;
using ranged::now;
using ranged::wide_t;

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

static int64_t by_lengths(int64_t sum, long double most)
{
    const wide_t whole = static_cast<wide_t>(std::min(most, 0x1p100L)) + 1;
    return ranged::within(sum, -whole, whole);
}

static int64_t sum2(int32_t a, int32_t b, int32_t c, int32_t d)
{
    return by_lengths(text_sum2(a, b, c, d), length_of({a, c}) * length_of({b, d}));
}

static int64_t sum3(int32_t a, int32_t b, int32_t c, int32_t d, int32_t e, int32_t f)
{
    return by_lengths(text_sum3(a, b, c, d, e, f), length_of({a, c, e}) * length_of({b, d, f}));
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
    return ranged::any<uint32_t>(now.is_exact ? exact : (wide_t{1} << 29) - 8, now.is_exact ? exact : one >> 31);
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

static long double length3(fixed3_t v)
{
    return length_of({v.x, v.y, v.z});
}

/* A fact about a vector, unless a number on the way has left its word: then the vector may be anything. */
static fixed3_t with_length(fixed3_t v, long double most, std::size_t complaints)
{
    if (now.complaints.size() == complaints) {
        has_length({v.x, v.y, v.z}, most);
    }
    return v;
}

static fixed3_t fixed3_plus(fixed3_t a, fixed3_t b)
{
    const std::size_t before = now.complaints.size();
    return with_length(text_plus(a, b), length3(a) + length3(b), before);
}

static fixed3_t fixed3_halved(fixed3_t a, uint32_t bits)
{
    const std::size_t before = now.complaints.size();
    const long double least = static_cast<long double>(bits.range().least);
    return with_length(text_halved(a, bits), length3(a) / exp2l(least) + ROOT_OF_3, before);
}

static fixed3_t fixed3_doubled(fixed3_t a, uint32_t bits)
{
    const std::size_t before = now.complaints.size();
    return with_length(text_doubled(a, bits), length3(a) * exp2l(static_cast<long double>(bits.range().most)), before);
}

static fixed3_t fixed3_scaled_q30(fixed3_t a, int32_t by)
{
    const std::size_t before = now.complaints.size();
    const long double most = length3(a) * (ranged::size_of(by) / ONE_Q30) + ROOT_OF_3 * COARSE;
    return with_length(text_scaled_q30(a, by), most, before);
}

static fixed3_t fixed3_plus_q30(fixed3_t a, fixed3_t b, int32_t by)
{
    const std::size_t before = now.complaints.size();
    const long double more = length3(b) * (ranged::size_of(by) / ONE_Q30) + ROOT_OF_3 * COARSE;
    return with_length(text_plus_q30(a, b, by), length3(a) + more, before);
}

static fixed3_t fixed3_cross(fixed3_t a, fixed3_t b, int bits)
{
    const std::size_t before = now.complaints.size();
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
    const std::size_t before = now.complaints.size();
    const fixed_vec_t turn = text_small_turn_of(angle_q29);
    PROVE(ranged::size_of(angle_q29) <= SMALL_ANGLE_MOST, "a small turn is small");
    if (now.complaints.size() == before) {
        has_length({turn.x, turn.z}, SMALL_TURN_MOST);
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
    const std::size_t before = now.complaints.size();
    const long double factor = factor_of(by), cut = ROOT_OF_2 * COARSE;
    has_length({v.*p, v.*q}, length3(v));
    const long double pair = length_of({v.*p, v.*q}) * factor + cut, whole = length3(v) * factor + cut;
    const fixed3_t result = turn(v, by);
    if (now.complaints.size() == before) {
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
    const std::size_t before = now.complaints.size();
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
    if (now.complaints.size() == before) {
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

/* Each part is a sum of products of two threes of numbers: Cauchy's inequality. */
static fixed3_t fixed_axes_times(const fixed_axes_t *e, fixed3_t v)
{
    const std::size_t before = now.complaints.size();
    const fixed3_t result = text_axes_times(e, v);
    if (now.complaints.size() == before) {
        int32_t fixed3_t::*const part[3] = {&fixed3_t::x, &fixed3_t::y, &fixed3_t::z};
        for (auto p : part) {
            has_length({result.*p}, length_of({e->x.*p, e->y.*p, e->z.*p}) * (length3(v) / 0x1p32L) + 1.0L);
        }
    }
    return result;
}

/* A symmetric matrix, by the root of the sum of its nine entries' squares. Two of its rows and columns are turned. With
 * s, c of the turn and n its squared length, cosine and sine of twice the angle are 1 - 2 s^2 and 2 s c here, whose
 * length is the root of 1 + 4 s^2 (n - 1); eight units are cut off each, which counts as 12 in 2^30 of what is turned.
 * What else is cut off: half a unit of the mean, 4 units of each of the turned parts. */
static long double length_of_sym3(const fixed_sym3_t &m)
{
    return length_of({m.xx, m.xy, m.xy, m.xz, m.xz, m.yy, m.yz, m.yz, m.zz});
}

template <class TURN>
void sym3_turned(fixed_sym3_t *m, fixed_vec_t by, int32_t fixed_sym3_t::*aa, int32_t fixed_sym3_t::*ab,
                 int32_t fixed_sym3_t::*bb, int32_t fixed_sym3_t::*ar, int32_t fixed_sym3_t::*br, TURN turn)
{
    const std::size_t before = now.complaints.size();
    const long double factor = factor_of(by), square = factor * factor;
    const long double twice = std::sqrt(1.0L + 4.0L * square * (square - 1.0L)) + 12.0L / ONE_Q30;
    const long double cut = 12.0L;
    const long double block = length_of({m->*aa, m->*ab, m->*ab, m->*bb}) * twice + cut;
    const long double pair = length_of({m->*ar, m->*br}) * factor + ROOT_OF_2 * COARSE;
    const long double whole = length_of_sym3(*m) * std::max(factor, twice) + 24.0L;
    turn(m, by);
    if (now.complaints.size() == before) {
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

static int32_t any_over_second_step(int32_t second_by_first, uint32_t first2);
struct overload;
#define fixed_overload_t fixed_overload_t
template <class OVERLOAD, class NOTED>
int32_t any_overload_softened(int32_t yields_q14, int32_t entry_q24, OVERLOAD *overload, NOTED *noted);

#include "fixed_space/loaded_space_fixed.c"

/* By how much the second step is prolonged (space_step). */
static int32_t any_over_second_step(int32_t second_by_first, uint32_t first2)
{
    const std::int32_t by = static_cast<std::int32_t>(second_by_first.range().least);
    const std::int32_t exact =
        now.is_exact ? (plain::over_second_step)(by, static_cast<std::uint32_t>(exact_of(first2))) : 0;
    PROVE(ranged::size_of(second_by_first) <= 0x1p30L, "steps' products are within their proof's range");
    return given(PART_OF(29, 0.5), PART_OF(29, 2.001), &exact);
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

constexpr wide_t WORD_MOST = (wide_t{1} << 31) - 1;

/* What the collapse's last look lets through. */
#define ANY_LINK(link)                                                                                                 \
    fixed_link3_t                                                                                                      \
    {                                                                                                                  \
        .length_q28 = GIVEN(0, PART_OF(28, 1.0) + 2, limb.link.length_q28),                                            \
        .twelfth_q28 = GIVEN(0, PART_OF(28, 1.0 / 12.0) + 2, limb.link.twelfth_q28),                                   \
        .along_q30 = {GIVEN(-DIRECTION_MOST, DIRECTION_MOST, limb.link.along_q30.x),                                   \
                      GIVEN(-DIRECTION_MOST, DIRECTION_MOST, limb.link.along_q30.z)},                                  \
        .tilt_q28 = {GIVEN(-TILT_MOST, TILT_MOST, limb.link.tilt_q28.x),                                               \
                     GIVEN(-TILT_MOST, TILT_MOST, limb.link.tilt_q28.z)},                                              \
        .bow_q28 = {GIVEN(-BOW_MOST, BOW_MOST, limb.link.bow_q28.x), GIVEN(-BOW_MOST, BOW_MOST, limb.link.bow_q28.z)}, \
        .twist_q31 = GIVEN(0, WORD_MOST, limb.link.twist_q31),                                                         \
        .sideways_q31 = GIVEN(0, WORD_MOST, limb.link.sideways_q31),                                                   \
        .bend_q31 = GIVEN(0, WORD_MOST, limb.link.bend_q31),                                                           \
        .across_arm_q31 = GIVEN(0, WORD_MOST, limb.link.across_arm_q31),                                               \
        .sideways_arm_q31 = GIVEN(0, WORD_MOST, limb.link.sideways_arm_q31),                                           \
        .across_spread_q31 = GIVEN(0, WORD_MOST, limb.link.across_spread_q31),                                         \
        .sideways_spread_q31 = GIVEN(0, WORD_MOST, limb.link.sideways_spread_q31),                                     \
        .stretch_q31 = GIVEN(0, WORD_MOST, limb.link.stretch_q31),                                                     \
        .end_share_q30 = GIVEN(0, 1 << 29, limb.link.end_share_q30),                                                   \
        .stretch_end_share_q30 = GIVEN(-(1 << 29), 1 << 29, limb.link.stretch_end_share_q30),                          \
        .own_share_q30 = GIVEN(0, 1 << 29, limb.link.own_share_q30),                                                   \
        .curl_q30 = GIVEN(0, 1 << 30, limb.link.curl_q30),                                                             \
        .shortens_q30 = GIVEN(0, 1 << 30, limb.link.shortens_q30),                                                     \
        .weight_q31 = GIVEN(0, WORD_MOST, limb.link.weight_q31),                                                       \
        .arm_shift = ranged::any<uint32_t>(sample == nullptr ? 0 : sample->limb.link.arm_shift,                        \
                                           sample == nullptr ? 20 : sample->limb.link.arm_shift)                       \
    }

#define TILT_MOST (PART_OF(28, 0.7072) + 2)
#define BOW_MOST (PART_OF(28, 0.2185) + 2)

static void with_lengths(fixed_link3_t *link)
{
    has_length({link->along_q30.x, link->along_q30.z}, static_cast<long double>(DIRECTION_MOST));
    has_length({link->tilt_q28.x, link->tilt_q28.z}, static_cast<long double>(TILT_MOST));
    has_length({link->bow_q28.x, link->bow_q28.z}, static_cast<long double>(BOW_MOST));
}

/* The unit of force is above the components' sum and one and a half times all weights. So the range of the force at the
 * tip is cut into parts, and for each the weights are at most what the least force of the part leaves them. */
enum { PARTS = 8 };
static int part;

static uint32_t given_shift(const std::uint32_t *exact)
{
    return ranged::any<uint32_t>(now.is_exact ? *exact : 0, now.is_exact ? *exact : 31);
}

static void run_once()
{
    brace_loaded_space_fixed_t limb = {};
    limb.coxa = ANY_LINK(coxa);
    limb.femur = ANY_LINK(femur);
    limb.tibia = ANY_LINK(tibia);
    with_lengths(&limb.coxa);
    with_lengths(&limb.femur);
    with_lengths(&limb.tibia);
    limb.base_x_q31 = GIVEN(0, WORD_MOST, limb.base_x_q31);
    limb.base_z_q31 = GIVEN(0, WORD_MOST, limb.base_z_q31);

    const wide_t one = PART_OF(30, 1.0), down = one + (one >> 10);
    const wide_t force = one * (part + 1) / PARTS, weight = (one - one * part / PARTS) * 2 / 3 + 64;
    fixed_inputs3_t in = {
        .tip_q30 = {GIVEN(-force, force, in.tip_q30.x), GIVEN(-force, force, in.tip_q30.y),
                    GIVEN(-force, force, in.tip_q30.z)},
        .down_q30 = {GIVEN(-down, down, in.down_q30.x), GIVEN(-down, down, in.down_q30.y),
                     GIVEN(-down, down, in.down_q30.z)},
        .weights = {GIVEN(0, weight, in.weights.beyond_coxa_q30), GIVEN(0, weight, in.weights.beyond_femur_q30),
                    GIVEN(0, weight, in.weights.femur_q30), GIVEN(0, weight, in.weights.tibia_q30)},
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

    noted_t noted = 0u;
    rest.whole_q30 = fixed3_plus_q30(in.tip_q30, in.down_q30, in.weights.beyond_coxa_q30);
    (void)find_rest(&limb, &in, &rest, &noted);

    noted = 0u;
    fixed_freedoms_t free;
    fixed_frames_t frames;
    fixed_sum_t sum;
    fixed_eliminate_limb(&limb, &rest, nullptr, &free, &noted);
    fixed_frames_of(&rest.turns, &frames);
    fixed_sum_limb(&limb, &rest, &free, &frames, &sum, &noted);
    (void)moved(&limb, &rest, sum.tip_q28);

    noted = 0u;
    fixed_overload_t overload = {.times_q27 = GIVEN(0, WORD_MOST, times_q27), .mantissa_q31 = 1 << 30, .exponent = 1,
                                 .is_negative = false, .has_buckled = false, .is_refused = false};
    fixed_eliminate_limb(&limb, &rest, &overload, &free, &noted);
}

} // namespace firmware

int main(int, char **arguments)
{
    using ranged::now;
    now.noted_limit = 1 << NOTED_BITS;
    for (firmware::part = 0; firmware::part < firmware::PARTS; firmware::part++) {
        const std::size_t left = ranged::prove(firmware::run_once);
        std::printf("part %d: %zu numbers, %zu complaints\n", firmware::part, now.numbers.size(), left);
        for (std::size_t i = 0; i < std::min<std::size_t>(left, 8); i++) {
            ranged::tell(arguments[0], now.complaints[i].first, now.complaints[i].second);
        }
        if (left != 0) {
            return 1;
        }
    }
    return 0;
}
