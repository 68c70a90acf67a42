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

/* The straight links' levers, from where a test begins. Where a load is counted, steps are due. */
void levers_begin(brace_loading_t *test, const loading_inputs_t *inputs);

/* Does the next step need a tick of its own? One that works out a displacement does; in space, where requests wait for
 * it, also those between, so that they stay apart. */
bool levers_are_due(const brace_loading_t *test, const loading_inputs_t *inputs);

/* Takes the load's mean over fifty steps; one noisy sample would turn the levers. Then works out one displacement under
 * it in every tenth step: five of them, at the posture and a little to each side of it by either joint. Their central
 * differences are added to the straight links' levers; where a displacement cannot be told, the straight links' levers
 * stay.
 *   has_worked (out): true when a displacement has been worked out; else untouched
 * returns whether the levers are there. At most 2,900 instructions. */
bool levers_step(brace_loading_t *test, const loading_inputs_t *inputs, bool *has_worked);

/* Joint offsets that move the tip's free shape by 1 mm along the axis, by these levers.
 * returns whether the levers allow it; per_mm untouched if not */
bool levers_offsets_per_mm(const brace_loading_t *test, const brace_limb_t *limb, brace_axis_t axis, float per_mm[2]);

#endif
