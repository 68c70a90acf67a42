/* The search for the buckling factor in the plane, in fixed point: its units, its shifts, and the way from one multiple
 * of the load to the next. */
#include "proof.h"
#include "loaded_sizes.h"

#define fixed_direction any_direction
#include "loaded/fixed_softened.h"

#include "fixed/fixed_table.c"

static int64_t size_of(int32_t number)
{
    return number < 0 ? -(int64_t)number : number;
}

static int32_t any_within(int64_t most)
{
    const int32_t any = any_i32();
    ASSUME(any <= most && any >= -most);
    return any;
}

static int32_t any_not_below_0(int64_t most)
{
    const int32_t any = any_i32();
    ASSUME(any >= 0 && any <= most);
    return any;
}

/* --- units ------------------------------------------------------------------------------------------------------- */

/* What a link's proof promises (loaded_link). */
static fixed_rest_t any_rest(void)
{
    fixed_rest_t rest;
    rest.resists = (fixed_matrix_t){any_within(REST_MOST), any_within(REST_MOST), any_within(REST_MOST),
                                    any_within(REST_MOST), any_within(REST_MOST), any_within(REST_MOST)};
    rest.end_resists = any_within(SOFTENS_MOST);
    rest.root_softens = any_not_below_0(SOFTENS_MOST), rest.end_softens = any_not_below_0(SOFTENS_MOST);
    return rest;
}

static void is_scaled(const fixed_scaled_t *link)
{
    const fixed_matrix_t *m = &link->resists;
    PROVE(size_of(m->rr) <= SEARCH_MOMENT_MOST && size_of(m->ra) <= SEARCH_MOMENT_MOST &&
              size_of(m->rb) <= SEARCH_MOMENT_MOST && size_of(m->aa) <= SEARCH_MOMENT_MOST &&
              size_of(m->ab) <= SEARCH_MOMENT_MOST && size_of(m->bb) <= SEARCH_MOMENT_MOST,
          "what a link resists");
    PROVE(size_of(link->end_resists) <= SEARCH_MOMENT_MOST, "its end");
    PROVE(link->root_softens >= 0 && link->root_softens <= SEARCH_SOFTENS_MOST, "what its root softens");
    PROVE(link->end_softens >= 0 && link->end_softens <= SEARCH_SOFTENS_MOST, "and its end");
    PROVE(link->bend >= 0 && link->bend <= SEARCH_COMPLIANCE_MOST, "its compliance");
}

/* Compliances are not negative (loaded_whole). */
static fixed_stance_t any_stance(const fixed_rest_t *femur, const fixed_rest_t *tibia)
{
    return (fixed_stance_t){femur,
                            tibia,
                            any_not_below_0(INT32_MAX),
                            any_not_below_0(INT32_MAX),
                            any_not_below_0(INT32_MAX),
                            any_not_below_0(INT32_MAX)};
}

static void units(void)
{
    const fixed_rest_t femur = any_rest(), tibia = any_rest();
    const fixed_stance_t stance = any_stance(&femur, &tibia);
    const fixed_search_t search = fixed_search_of(&stance);
    is_scaled(&search.femur);
    is_scaled(&search.tibia);
    PROVE(search.hip >= 0 && search.hip <= SEARCH_COMPLIANCE_MOST, "the hip");
    PROVE(search.knee >= 0 && search.knee <= SEARCH_COMPLIANCE_MOST, "the knee");
    PROVE(search.units >= SEARCH_UNITS_LEAST && search.units <= SEARCH_UNITS_MOST, "units");
}

/* --- shifts ------------------------------------------------------------------------------------------------------ */

static bool is_below_q30(int32_t number)
{
    return number >= -(1 << 30) && number < 1 << 30;
}

static void rooms(void)
{
    const int32_t a = any_i32(), b = any_i32(), room = room_above(a, b);
    PROVE(room >= -1 && room <= 29, "room");
    PROVE(is_below_q30(shifted_up(a, room)) && is_below_q30(shifted_up(b, room)), "shifted up as far as there is room");
    PROVE(room < 0 || (shifted_up(a, room) >> room == a && shifted_up(b, room) >> room == b), "without loss");
}

static void wide(void)
{
    const int64_t sum = any_i64();
    const int32_t exponent = any_within(SEARCH_EXPONENT_MOST);
    ASSUME(sum < 1LL << 62 && sum > -(1LL << 62));
    const fixed_wide_t number = fixed_wide_of(sum, exponent);
    PROVE(is_below_q30(number.mantissa_q31), "its mantissa");
    PROVE((sum < 0) == (number.mantissa_q31 < 0), "its sign");
    PROVE(number.exponent <= exponent + 1 && number.exponent >= exponent - 29, "its exponent");
}

/* --- from one multiple to the next ------------------------------------------------------------------------------- */

static fixed_softened_t any_softened(const fixed_search_t *search, int32_t half_octaves)
{
    (void)search;
    PROVE(half_octaves >= 1 && half_octaves <= 7, "a multiple (loaded_softened)");
    const fixed_softened_t any = {{any_i32(), any_within(SEARCH_EXPONENT_MOST + 29)}, any_bool()};
    ASSUME(is_below_q30(any.determinant.mantissa_q31) && (!any.is_stable || any.determinant.mantissa_q31 >= 0));
    return any;
}

static int32_t any_root_q30(int32_t before, int32_t low, int32_t high, int32_t k_q30, int32_t l_q29)
{
    (void)k_q30, (void)l_q29;
    PROVE(is_below_q30(before), "a determinant before");
    PROVE(low >= 0 && low < 1 << 30 && high < 0 && high >= -(1 << 30), "determinants about the root");
    return any_not_below_0(PART_OF(30, 1.03)); /* loaded_softened */
}

#define SECOND(first, second, ...) second
#define PICK(...) SECOND(__VA_ARGS__)
#define fixed_root_q30(first, ...) PICK(ROOT_##first, any_root_q30, ~)(first, __VA_ARGS__)
#define ROOT_int32_t ~, text_root_q30,
#define fixed_softened any_softened
#include "loaded/fixed_buckling.h"

static void search(void)
{
    const fixed_rest_t femur = any_rest(), tibia = any_rest();
    const fixed_stance_t stance = any_stance(&femur, &tibia);
    const fixed_wide_t now = {any_not_below_0(INT32_MAX), any_within(64)};
    (void)fixed_buckling_factor(&stance, now);
}

int main(void)
{
    units();
    rooms();
    wide();
    search();
    return 0;
}
