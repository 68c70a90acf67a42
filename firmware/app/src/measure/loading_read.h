/* One step's reading: averaged over the second half of its dwell, into slope, recorder and drift detector. */
#ifndef BRACE_APP_LOADING_READ_H
#define BRACE_APP_LOADING_READ_H

#include "brace/app.h"

void loading_read_begin(brace_loading_t *test);
void loading_read_sample(brace_app_t *app, const brace_snapshot_t *snapshot);

/* The reading is worked out and recorded; false when nothing was averaged or it cannot be used. */
bool loading_read(brace_app_t *app);

/* Adds the reading in dx_mm, dz_mm to the slope. A slope knows displacement along one axis; the little
 * there is across it is taken off by the model. */
bool loading_add_to_slope(brace_loading_t *test, float fx_n, float fz_n);

/* The reading goes to the drift detector, if a sensor measured the force and no gap was open. */
void loading_drift(brace_app_t *app);

/* Slopes; false: there are none, it was flat. */
bool loading_judge(brace_app_t *app);

/* The model's slopes, and how sure it is of them; then how far those measured are from them. */
void loading_compare(brace_app_t *app);
void loading_tell(brace_app_t *app);

#endif
