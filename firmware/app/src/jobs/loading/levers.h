/* Levers of the loading test: how far the tip's free shape moves for a turn of each motor, while the tip's force stays.
 *
 * Without load they are those of straight links. Under a load F the bent limb turns with the motor and F does not. So
 * the springs' moments change, and the tip moves besides. At 20 N this is up to a third of the lever. The ground holds
 * the tip, so F changes by -K times what the levers say; with the levers of straight links the test would measure
 * another K. */
#ifndef BRACE_JOBS_LOADING_LEVERS_H
#define BRACE_JOBS_LOADING_LEVERS_H

#include "brace/loading.h"
#include "jobs/loading/inputs.h"

/* Takes the straight links' levers, from where a test begins. Where a load is counted, levers_listen and levers_work
 * have to follow. */
void levers_begin(brace_loading_t *test, const loading_inputs_t *inputs);

/* Takes the load's mean over fifty ticks; one noisy sample would turn the levers. returns whether it still does */
bool levers_listen(brace_loading_t *test, const loading_inputs_t *inputs);

/* One step of the rest, once the load's mean is there: works out five displacements under the load, at the posture and
 * a little to each side of it by either joint. Their central differences are added to the straight links' levers; where
 * a displacement cannot be told, the straight links' levers stay.
 * returns whether the levers are there. At most 1,900 instructions. */
bool levers_work(brace_loading_t *test, const loading_inputs_t *inputs);

/* Joint offsets that move the tip's free shape by 1 mm along the axis, by these levers.
 * returns whether the levers allow it; per_mm untouched if not */
bool levers_offsets_per_mm(const brace_loading_t *test, const brace_limb_t *limb, brace_axis_t axis, float per_mm[2]);

#endif
