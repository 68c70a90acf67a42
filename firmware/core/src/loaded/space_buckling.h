/* The buckling factor in space: the load at which the first pivot reaches zero, as a multiple of the present one.
 *
 * The search is that of loaded/buckling.h in its first two steps. Where a limb softens in the plane and across it
 * alike, two roots of the determinant lie close together: it falls to zero and rises again, and a search by its sign
 * overlooks both. So the last two steps look near the first root of a parabola, the first of them a little before it,
 * the other a little behind it, and the end is such a root: the parabola
 * through two loads around the root and the nearest third. Where it has no root, its lowest point counts. Where no load
 * is known that the limb does not bear, the third is no load at all.
 */
#ifndef BRACE_CORE_SPACE_BUCKLING_H
#define BRACE_CORE_SPACE_BUCKLING_H

#include "loaded/buckling.h"

#define ROOT_OF_2 1.41421356f
#define SPACE_SEARCH_STEPS 4
#define SHORT_OF_ROOT 0.97f /* where the limb still bears the load: it is looked at on both sides of the root */
#define BEHIND_ROOT 1.01f

/* Not above low, or no number, where the parabola does not fall beyond low. */
INLINE float first_root(const brace_buckling_search_t *search)
{
    const bool is_known = search->at_high != 0.0f;
    const float third = is_known ? search->high : 0.0f, at_third = is_known ? search->at_high : 1.0f;
    const float low = search->low, at_low = search->at_low, back = search->before - low, span = third - low;
    const float chord = (at_third - at_low) / span;
    const float bend = ((search->at_before - at_low) / back - chord) / (back - span);
    const float slope = brace_fma(-bend, span, chord), squared = brace_fma(slope, slope, -4.0f * bend * at_low);
    return low + 2.0f * at_low / (sqrtf(squared > 0.0f ? squared : 0.0f) - slope);
}

/* The multiple of the load that step 0, 1, 2 or 3 looks at. */
INLINE float space_search_at(const brace_buckling_search_t *search, int step)
{
    const float low = search->low;
    if (step < 2) {
        return step == 0 ? 4.0f : low + low;
    }
    const float middle = ROOT_OF_2 * low, most = search->high < HIGHEST_FACTOR ? search->high : middle;
    const float near_root = (step == 2 ? SHORT_OF_ROOT : BEHIND_ROOT) * first_root(search);
    return near_root > low && near_root < most ? near_root : middle;
}

/* found.determinant: 0 where it is not known; then it narrows nothing that is known. */
INLINE void space_search_narrow(brace_buckling_search_t *search, float at, softened_t found)
{
    if (found.is_stable) {
        search->before = search->low, search->at_before = search->at_low;
        search->low = at, search->at_low = found.determinant;
    } else if (search->at_high == 0.0f) {
        search->high = at, search->at_high = found.determinant;
    } else if (found.determinant != 0.0f) {
        search->before = search->high, search->at_before = search->at_high;
        search->high = at, search->at_high = found.determinant;
    }
}

INLINE float space_search_end(const brace_buckling_search_t *search)
{
    const float low = search->low, high = search->high, root = first_root(search);
    if (root >= low && root < high) {
        return root;
    }
    return !(high < HIGHEST_FACTOR) ? INFINITY : search->at_high != 0.0f ? 0.5f * (low + high) : high;
}

#endif
