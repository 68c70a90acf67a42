#include <math.h>

#include "brace/loaded_space_fixed.h"
#include "fixed_space/eliminate.h"
#include "loaded/space_buckling.h"

/* The search of loaded/space_buckling.h, its determinants by integers. */

#define TIMES_MOST 15.99f /* what a word holds of 16 */

#define CLOSE 0.0625f /* a determinant so small drives numbers out of their words: the limb buckles near that load */

typedef enum { FOUND, BUCKLED, UNKNOWN } found_t;

/* returns FOUND, or where a word does not hold all that is met: BUCKLED at this load or close to it, or UNKNOWN */
static found_t soften(const brace_loaded_space_fixed_t *fixed, const brace_space_fixed_rest_t *rest, float times,
                      softened_t *softened)
{
    fixed_overload_t overload = {.times_q27 = fixed_of(bits_of(times < TIMES_MOST ? times : TIMES_MOST), 27),
                                 .mantissa_q31 = 1 << 30,
                                 .exponent = 1};
    fixed_freedoms_t free;
    noted_t noted = 0u;
    fixed_eliminate_limb(fixed, rest, &overload, &free, &noted);
    const float determinant = float_from(overload.mantissa_q31, 31 - overload.exponent);
    if (!is_refused(noted)) {
        *softened = (softened_t){overload.is_negative ? -determinant : determinant, !overload.has_buckled};
        return FOUND;
    }
    *softened = (softened_t){0.0f, false};
    return overload.has_buckled || determinant < CLOSE ? BUCKLED : UNKNOWN;
}

void brace_loaded_space_fixed_buckling_begin(brace_buckling_search_t *search)
{
    search->step = 0;
}

bool brace_loaded_space_fixed_buckling_step(const brace_loaded_space_fixed_t *fixed,
                                            const brace_space_fixed_rest_t *rest, brace_buckling_search_t *search,
                                            float *factor)
{
    const bool is_first = search->step == 0;
    const int step = is_first ? 1 : search->step + 1;
    const float at = is_first ? 1.0f : space_search_at(search, search->step - 1);
    softened_t at_load;
    const found_t found = soften(fixed, rest, at, &at_load);
    if (is_first) {
        *search = buckling_search_from(at_load.determinant);
    } else if (found != UNKNOWN) {
        space_search_narrow(search, at, at_load);
    }
    const bool is_last = step > SPACE_SEARCH_STEPS; /* it only narrows what is known */
    const bool is_lost = found == UNKNOWN && !is_last;
    const bool goes_on = !is_last && !is_lost && !(is_first && found == BUCKLED);
    search->step = goes_on ? step : 0;
    if (goes_on) {
        return false;
    }
    *factor = is_lost ? NAN : is_first && found == BUCKLED ? 1.0f : space_search_end(search);
    return true;
}
