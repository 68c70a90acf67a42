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

/* Angles, levers, force, K now and engaged, their flags. */
void control_stiffness(brace_app_t *app, brace_snapshot_t *snapshot);

/* Mode, faults and validity of this tick; from here on it is the newest. */
void control_seal(brace_app_t *app, brace_snapshot_t *snapshot);

#endif
