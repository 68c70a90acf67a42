/* One step's reading of a loading test: averaged over the second half of its dwell, into row and slope. */
#ifndef BRACE_JOBS_LOADING_READING_H
#define BRACE_JOBS_LOADING_READING_H

#include "brace/loading.h"
#include "brace/recorder.h"
#include "jobs/loading/inputs.h"

/* A new average begins. */
void reading_begin(brace_loading_t *test);

/* Adds this tick's samples to the average. */
void reading_add(brace_loading_t *test, const loading_inputs_t *inputs);

/* Works the average out: the reading goes into the slope and as a row into the recorder.
 * returns false when nothing was averaged or the reading cannot be used */
bool reading_take(brace_loading_t *test, const loading_inputs_t *inputs, brace_recorder_t *recorder);

/* Adds the reading in test->dx_mm, dz_mm to the slope. A slope knows the displacement along one axis; the model takes
 * off the little that there is across it. */
bool reading_add_to_slope(brace_loading_t *test, float fx_n, float fz_n);

/* K with which the slopes are compared: under the preload, where the K of now counts one. One step of it.
 * returns whether it is there */
bool reading_model_now(brace_loading_t *test, const loading_inputs_t *inputs);

/* The same as the drift check wants it: at the reference temperature, whatever the joints' springs are now. After
 * reading_model_now. */
bool reading_model_at_reference(brace_loading_t *test, const loading_inputs_t *inputs);

/* The same reading for the drift check, where there is one. */
void reading_for_drift(brace_loading_t *test, const loading_inputs_t *inputs, loading_reading_t *reading);

#endif
