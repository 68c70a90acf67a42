/* How far the load softens a limb in space: its buckling factor, and K without the load. Both together cost more
 * instructions than K under the load itself, and no other part of the tick needs them. So every eighth tick does one step:
 * K without the load each time, and a quarter of the search for the buckling factor. Where no other job works, what is
 * told of K is at most 8 ticks old, the factor at most 64. */
#ifndef BRACE_STIFFNESS_SOFTENING_H
#define BRACE_STIFFNESS_SOFTENING_H

#include <stdbool.h>
#include <stdint.h>

#include "stiffness/model.h"

typedef struct {
    model_work_t now;        /* where the limb rests in this tick; the tick writes it */
    space_path_rest_t at;    /* the equilibrium whose factor is searched */
    brace_buckling_search_t search;
    bool runs;
    uint8_t ticks_to_step;
    uint8_t ticks_told;      /* since the factor was found */
    float factor;            /* NaN: not known, as all below */
    brace_stiffness_t unloaded; /* in the limb's plane */
    float unloaded_across_n_per_mm;
} softening_t;

/* Nothing is known. */
void softening_start(softening_t *softening);

/* One step, if one is due and may be done now.
 *   unbent_rad: the posture of this tick
 *   is_counted: the limb is one in space, and rests at `now`
 *   may_work: no other job has worked out a K in this tick
 * returns whether it has worked: at most 2,400 instructions then */
bool softening_step(softening_t *softening, model_t *model, const brace_limb_t *limb,
                    const float unbent_rad[BRACE_LINK_COUNT], bool is_counted, bool may_work);

/* What the factor means for K: SOFTENED, NEAR_SINGULAR; 0 while it is not known. */
uint32_t softening_flags(const softening_t *softening);

#endif
