/* The control path of a tick: samples in, K with its flags out, sealed into the snapshot. */
#ifndef BRACE_APP_CONTROL_H
#define BRACE_APP_CONTROL_H

#include "brace/app.h"

/* A snapshot that knows nothing. */
void control_blank(const brace_app_t *app, brace_snapshot_t *snapshot);

/* Joints, sensor, the joints' state machines. */
void control_sense(brace_app_t *app, uint32_t now_us, brace_snapshot_t *snapshot);

/* Each joint's temperature, the other's where it has no sensor; NaN: neither. What is told is the warmer one. */
void control_temperatures(const brace_app_t *app, float temp_degc[BRACE_APP_JOINTS]);

/* The next piece of K of the samples in snapshot[next]: angles and springs, model, posture and force, K now and
 * engaged. The first belongs into the tick of the samples. At most 430 instructions. true: it was the last */
enum { CONTROL_PIECES = 4 };
bool control_piece(brace_app_t *app);

/* Mode, faults and parameters of the tick whose samples are in the snapshot. */
void control_stamp(const brace_app_t *app, brace_snapshot_t *snapshot);

/* snapshot[next], stamped, is the newest from here on. */
void control_publish(brace_app_t *app);

/* The snapshot that is neither the newest nor the next. */
static inline uint8_t control_spare(const brace_app_t *app)
{
    return (uint8_t)(3u - app->newest - app->next);
}

#endif
