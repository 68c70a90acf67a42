#include <math.h>

#include "brace/loaded_space_fixed.h"
#include "fixed_space/eliminate.h"
#include "loaded/buckling.h"

/* The search of loaded/buckling.h, its determinants by integers. */

#define TIMES_MOST 15.99f /* what a word holds of 16 */

/* returns whether a word held all */
static bool soften(const brace_loaded_space_fixed_t *fixed, const brace_space_fixed_rest_t *rest, float times,
                   softened_t *softened)
{
    fixed_overload_t overload = {.times_q27 = fixed_of(bits_of(times < TIMES_MOST ? times : TIMES_MOST), 27),
                                 .mantissa_q31 = 1 << 30,
                                 .exponent = 1};
    fixed_freedoms_t free;
    noted_t noted = 0u;
    fixed_eliminate_limb(fixed, rest, &overload, &free, &noted);
    const float determinant = float_from(overload.mantissa_q31, 31 - overload.exponent);
    *softened = (softened_t){overload.is_negative ? -determinant : determinant, !overload.has_buckled};
    return !is_refused(noted);
}

bool brace_loaded_space_fixed_buckling_step(const brace_loaded_space_fixed_t *fixed,
                                            const brace_space_fixed_rest_t *rest, brace_buckling_search_t *search,
                                            float *factor)
{
    const bool is_first = search->step == 0;
    const int step = is_first ? 1 : search->step + 1;
    const float at = is_first ? 1.0f : buckling_search_at(search, search->step - 1);
    softened_t found;
    const bool is_told = soften(fixed, rest, at, &found);
    if (is_first) {
        *search = buckling_search_from(found.determinant);
    } else {
        buckling_search_narrow(search, at, found);
    }
    search->step = is_told && step <= SEARCH_STEPS ? step : 0;
    if (search->step != 0) {
        return false;
    }
    *factor = is_told ? buckling_search_end(search) : NAN;
    return true;
}
