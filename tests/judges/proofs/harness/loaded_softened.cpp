/* The search for the buckling factor in the plane, in fixed point: the firmware's own text, with ranges instead of
 * numbers (ranged.h). The limb under a multiple of its load, for each unit and each multiple that the search tries; and
 * the parabola's root, for each size of a fall. */
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
#include "fixed/fixed_table.c"
#include "loaded/fixed_buckling.h"
} // namespace plain

#undef BRACE_CORE_FIXED_BUCKLING_H
#undef BRACE_CORE_FIXED_SINCOS_H
#undef BRACE_CORE_FIXED_SOFTENED_H
#undef BRACE_CORE_FIXED_TURN_H
#undef BRACE_CORE_FIXED_WORD_H
#undef BRACE_CORE_LOADED_FIXED_LINK_H
#undef BRACE_CORE_LOADED_FIXED_SOLVE_H
#undef BRACE_CORE_LOADED_FIXED_VEC_H
#undef BRACE_FIXED_TABLE_H
#undef BRACE_FIXED_VEC_H

/* --- and with ranges ------------------------------------------------------------------------------------------- */

#define __builtin_clz(number) ranged::leading_zeros_of(number)

namespace firmware {

using int32_t = ranged::i32;
using uint32_t = ranged::u32;
using int64_t = ranged::i64;
using uint64_t = ranged::u64;
using ranged::now;
using ranged::wide_t;

constexpr wide_t WORD_MOST = (wide_t{1} << 31) - 1;

static int32_t given(wide_t least, wide_t most, std::int32_t exact)
{
    return ranged::any<int32_t>(now.is_exact ? exact : least, now.is_exact ? exact : most);
}

static std::int32_t exact_of(const int32_t &word)
{
    return static_cast<std::int32_t>(word.range().least);
}

/* Angles are not asked for. */
#define BRACE_CORE_FIXED_SINCOS_H
#include "fixed/fixed_table.h"
#include "fixed/fixed_word.h"
brace_sincos_t direction_of(uint32_t angle_turn);

/* One over a pivot (loaded_turns). */
#define LEAST_PIVOT ((1 << 27) / 16 + 1)
static int32_t any_inverse(int32_t pivot_q27)
{
    const wide_t one = wide_t{1} << 54, least = LEAST_PIVOT;
    const ranged::range_t pivot = pivot_q27.range();
    PROVE(pivot.least >= least, "a pivot that is inverted is at least the least one");
    const std::int32_t exact = now.is_exact ? plain::inverse_q27(exact_of(pivot_q27)) : 0;
    return given(one / std::max(pivot.most, least) - 4, (one + (one >> 29)) / std::max(pivot.least, least), exact);
}

#define inverse_q27(first) PICK(INVERSE_##first, any_inverse, ~)(first)
#define INVERSE_int32_t ~, text_inverse,

/* Shifts up as far as there is room (loaded_search). */
#define room_above(first, ...) PICK(ROOM_##first, any_room, ~)(first, __VA_ARGS__)
#define ROOM_int32_t ~, text_room,
#define shifted_up(first, ...) PICK(UP_##first, any_shifted_up, ~)(first, __VA_ARGS__)
#define UP_int32_t ~, text_shifted_up,
#define fixed_wide_of(first, ...) PICK(WIDE_##first, any_wide_of, ~)(first, __VA_ARGS__)
#define WIDE_int64_t ~, text_wide_of,

static int32_t any_room(int32_t a, int32_t b);
static int32_t any_shifted_up(int32_t number, int32_t up);
#include "loaded/fixed_solve.h"
static fixed_wide_t any_wide_of(int64_t sum, int32_t exponent);
#include "loaded/fixed_buckling.h"
#undef inverse_q27
#undef room_above
#undef shifted_up
#undef fixed_wide_of

static std::size_t room_of[2], room;

static int32_t any_room(int32_t a, int32_t b)
{
    const int32_t bits = given(-1, 29, now.is_exact ? plain::room_above(exact_of(a), exact_of(b)) : 0);
    room_of[0] = a.id, room_of[1] = b.id, room = bits.id;
    return bits;
}

static int32_t any_shifted_up(int32_t number, int32_t up)
{
    PROVE(up.id == room && (number.id == room_of[0] || number.id == room_of[1]), "as far as its own room");
    const std::int32_t exact = now.is_exact ? plain::shifted_up(exact_of(number), exact_of(up)) : 0;
    return given(-(wide_t{1} << 30), (wide_t{1} << 30) - 1, exact);
}

static fixed_wide_t any_wide_of(int64_t sum, int32_t exponent)
{
    PROVE(ranged::size_of(sum) < 0x1p62L, "the sum fits");
    PROVE(ranged::size_of(exponent) <= SEARCH_EXPONENT_MOST, "its exponent");
    plain::fixed_wide_t exact = {0, 0};
    if (now.is_exact) {
        exact = plain::fixed_wide_of(static_cast<std::int64_t>(sum.range().least), exact_of(exponent));
    }
    return fixed_wide_t{given(-(wide_t{1} << 30), (wide_t{1} << 30) - 1, exact.mantissa_q31),
                        given(-WORD_MOST, WORD_MOST, exact.exponent)};
}

/* --- the limb under a multiple of its load ---------------------------------------------------------------------- */

/* Where numbers stand: a sample's, or no sample. units, half_octaves: one after the other. */
static const plain::fixed_search_t *sample;
static int units, half_octaves;
static std::vector<long> told;

#define MOMENT(place) given(-SEARCH_MOMENT_MOST, SEARCH_MOMENT_MOST, sample == nullptr ? 0 : sample->place)
#define SOFTENS(place) given(0, SEARCH_SOFTENS_MOST, sample == nullptr ? 0 : sample->place)
#define COMPLIANCE(place) given(0, SEARCH_COMPLIANCE_MOST, sample == nullptr ? 0 : sample->place)
#define LINK(link) \
    fixed_scaled_t \
    { \
        {MOMENT(link.resists.rr), MOMENT(link.resists.ra), MOMENT(link.resists.rb), \
         MOMENT(link.resists.aa), MOMENT(link.resists.ab), MOMENT(link.resists.bb)}, \
            MOMENT(link.end_resists), SOFTENS(link.root_softens), SOFTENS(link.end_softens), COMPLIANCE(link.bend) \
    }

static void softened(void)
{
    told.clear();
    const fixed_search_t search = {LINK(femur), LINK(tibia), COMPLIANCE(hip), COMPLIANCE(knee), units};
    const auto ways = ranged::each_way([&] { return fixed_softened(&search, half_octaves); });
    const fixed_wide_t determinant = ways.front().determinant;
    told = {exact_of(determinant.mantissa_q31), exact_of(determinant.exponent), ways.front().is_stable ? 1 : 0};
}

/* --- the parabola's root ---------------------------------------------------------------------------------------- */

/* Numbers that belong together differ by what a part of their range leaves open. */
constexpr long double APART = 1.03L;
constexpr wide_t BEFORE_MOST_Q27 = static_cast<wide_t>(8.0L * APART * 0x1p27L);
constexpr wide_t CHORD_MOST_Q30 = static_cast<wide_t>(APART * 0x1p30L);

/* A fall below 2^31 (loaded_search) with so many leading zeros, its leading bits cut into parts. */
constexpr int LEADING_PARTS = 256;
static int zeros, leading_part;

static void fallen(void)
{
    const wide_t top = wide_t{1} << 31;
    const wide_t least = top + top / LEADING_PARTS * leading_part, most = least + top / LEADING_PARTS - 1;
    const wide_t span_least = least >> zeros, span_most = most >> zeros;
    /* only the difference of low and high counts */
    const int32_t low = ranged::any<int32_t>(span_least - 1, span_most - 1), high = -1;
    const fixed_fall_t fall = fixed_fall_of(low, high);
    const int32_t from = ranged::any<int32_t>(0, std::min(span_most - 1, (wide_t{1} << 30) - 1));
    const int32_t chord_q30 = fixed_chord_q30(from, fall);
    PROVE(chord_q30.range().least >= 0 && chord_q30.range().most <= CHORD_MOST_Q30, "the chord's root");
    const int32_t across = ranged::any<int32_t>(-WORD_MOST, WORD_MOST);
    for (const int32_t &rho : ranged::each_way([&] { return fixed_before_q27(across, fall); })) {
        PROVE(ranged::size_of(rho) <= static_cast<long double>(BEFORE_MOST_Q27), "how far before");
    }
}

/* The chord's root, cut into parts. */
constexpr int CHORD_PARTS = 64;
static int chord_part, below;

static void past_chord(void)
{
    const wide_t width = (CHORD_MOST_Q30 + CHORD_PARTS) / CHORD_PARTS, least = width * chord_part;
    const int32_t chord_q30 = ranged::any<int32_t>(least, std::min(least + width, CHORD_MOST_Q30));
    const int32_t rho_q27 = ranged::any<int32_t>(-BEFORE_MOST_Q27, BEFORE_MOST_Q27);
    const auto ways = ranged::each_way([&] {
        return fixed_past_chord_q30(chord_q30, rho_q27, plain::parabola_k_q30[below], plain::parabola_l_q29[below]);
    });
    for (const int32_t &root_q30 : ways) {
        PROVE(root_q30.range().least >= 0 && root_q30.range().most <= CHORD_MOST_Q30, "the root");
    }
}

} // namespace firmware

/* --- samples --------------------------------------------------------------------------------------------------- */

namespace samples {

static std::uint32_t state = 20261127u;

static std::int32_t any(long double least, long double most)
{
    state = state * 1664525u + 1013904223u;
    return static_cast<std::int32_t>(least + (most - least) * (static_cast<long double>(state >> 8) / 16777216.0L));
}

static plain::fixed_scaled_t any_link(void)
{
    const auto moment = [] { return any(-SEARCH_MOMENT_MOST, SEARCH_MOMENT_MOST); };
    const auto softens = [] { return any(0, SEARCH_SOFTENS_MOST); };
    return {{moment(), moment(), moment(), moment(), moment(), moment()},
            moment(),
            softens(),
            softens(),
            any(0, SEARCH_COMPLIANCE_MOST)};
}

/* returns whether numbers keep to their ranges, and are the firmware's */
static bool is_as_proven(const std::map<ranged::key_t, ranged::range_t> &proven)
{
    const plain::fixed_search_t search = {any_link(), any_link(), any(0, SEARCH_COMPLIANCE_MOST),
                                          any(0, SEARCH_COMPLIANCE_MOST), firmware::units};
    const plain::fixed_softened_t plainly = plain::fixed_softened(&search, firmware::half_octaves);
    firmware::sample = &search;
    ranged::run_exactly(firmware::softened);
    firmware::sample = nullptr;
    return firmware::told == std::vector<long>{plainly.determinant.mantissa_q31, plainly.determinant.exponent,
                                               plainly.is_stable ? 1 : 0} &&
           ranged::outside(proven, 0, ranged::now.numbers.size()) == 0;
}

/* The root between any determinants is that of its parts. */
static bool is_root_of_parts(void)
{
    const std::int32_t right = any(0, 29);
    const std::int32_t before = any(-0x1p30L, 0x1p30L), low = any(0, 0x1p30L) >> right, below = any(0, 4);
    const std::int32_t high = -1 - (any(0, 0x1p30L) >> right);
    const std::int32_t k_q30 = plain::parabola_k_q30[below], l_q29 = plain::parabola_l_q29[below];
    const plain::fixed_fall_t fall = plain::fixed_fall_of(low, high);
    const std::int32_t chord_q30 = plain::fixed_chord_q30(low, fall);
    const std::int32_t rho_q27 = plain::fixed_before_q27(before - low, fall);
    return chord_q30 >= 0 && chord_q30 <= firmware::CHORD_MOST_Q30 && std::abs(rho_q27) <= firmware::BEFORE_MOST_Q27 &&
           plain::fixed_root_q30(before, low, high, k_q30, l_q29) ==
               plain::fixed_past_chord_q30(chord_q30, rho_q27, k_q30, l_q29);
}

} // namespace samples

static bool is_proven(const char *program, void (*run)(void), const char *what, int at, int and_at)
{
    const std::size_t left = ranged::prove(run);
    if (left != 0) {
        std::printf("%s at %d, %d: %zu places\n", what, at, and_at, left);
        for (std::size_t i = 0; i < std::min<std::size_t>(left, 8); i++) {
            ranged::print_complaint(program, ranged::now.complaints[i].first, ranged::now.complaints[i].second);
        }
    }
    return left == 0;
}

int main(int, char **arguments)
{
    using namespace firmware;
    for (units = SEARCH_UNITS_LEAST; units <= SEARCH_UNITS_MOST; units++) {
        for (half_octaves = 1; half_octaves <= 7; half_octaves++) {
            if (!is_proven(arguments[0], softened, "units, half octaves", units, half_octaves)) {
                return 1;
            }
            const auto proven = ranged::ranges();
            for (int i = 0; i < 20; i++) {
                if (!samples::is_as_proven(proven)) {
                    std::printf("units %d, half octaves %d, sample %d\n", units, half_octaves, i);
                    return 1;
                }
            }
        }
    }
    for (zeros = 1; zeros <= 31; zeros++) {
        for (leading_part = 0; leading_part < LEADING_PARTS; leading_part++) {
            if (!is_proven(arguments[0], fallen, "zeros, part", zeros, leading_part)) {
                return 1;
            }
        }
    }
    for (below = 0; below < 4; below++) {
        for (chord_part = 0; chord_part < CHORD_PARTS; chord_part++) {
            if (!is_proven(arguments[0], past_chord, "below, part", below, chord_part)) {
                return 1;
            }
        }
    }
    for (int i = 0; i < 100000; i++) {
        if (!samples::is_root_of_parts()) {
            std::printf("root, sample %d\n", i);
            return 1;
        }
    }
    return 0;
}
