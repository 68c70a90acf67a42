/* How far the load softens a limb in space: its buckling factor, and K without the load. Both together cost more
 * instructions than K under the load itself, and no other part of the tick needs them. So every second tick does one
 * step, in turn: K without the load, and three of sixteen steps towards the buckling factor. The steps wait while
 * requests come, while somebody waits for a K, or while another job works; a step that has waited too long goes first.
 * Without such waiting, K without load is at most 8 ticks old, the factor at most 86. */
#ifndef BRACE_STIFFNESS_SOFTENING_H
#define BRACE_STIFFNESS_SOFTENING_H

#include <stdbool.h>
#include <stdint.h>

#include "stiffness/model.h"

typedef struct {
    model_place_t now;         /* where the limb rests in this tick; the tick writes it */
    brace_space_shape_t shape; /* of the equilibrium whose factor is searched */
    brace_space_search_t search;
    bool runs;
    uint8_t step_of_round;
    bool is_needed;
    uint8_t ticks_since_step;
    uint8_t factor_age_ticks;      /* ticks since it was found */
    float factor;            /* NaN: not known, as all below */
    brace_stiffness_t unloaded; /* in the limb's plane */
    float unloaded_across_n_per_mm;
} softening_t;

/* Nothing is known. */
void softening_start(softening_t *softening);

/* A tick passes. is_counted: the limb is one in space, and rests at `now` */
void softening_age(softening_t *softening, bool is_counted);

/* Is a step to be done where a tick is quiet? */
bool softening_is_due(const softening_t *softening);

/* Has a step waited so long for a quiet tick that other jobs have to wait for it? */
bool softening_is_overdue(const softening_t *softening);

/* One step. At most 1,200 instructions.
 *   unbent_rad: the posture of this tick */
void softening_work(softening_t *softening, model_t *model, const brace_limb_t *limb,
                    const float unbent_rad[BRACE_LINK_COUNT]);

/* What the factor means for K: SOFTENED, NEAR_SINGULAR; 0 while it is not known. */
uint32_t softening_flags(const softening_t *softening);

#endif
