/* The joints' samples: which are sound, how old, and is the encoder alive. */
#ifndef BRACE_APP_JOINTS_H
#define BRACE_APP_JOINTS_H

#include "brace/app.h"

/* What the means need of the tick's period. */
void joints_configure(brace_app_t *app);

/* Reads femur and tibia. Samples that are refused, not finite or absurd (a torque of more than twice the motor's
 * greatest, say) are counted and the last sound one stays, until it is older than controller.age_limit_us. At most 280
 * instructions. */
void joints_read(brace_app_t *app, uint32_t now_us);

/* Ticks the state machine of every joint with play, so that play[] is of this sample; a joint without play is
 * engaged. */
void joints_play(brace_app_t *app, uint32_t now_us, brace_snapshot_t *snapshot);

/* True joint angles from motor angles, play and zero offset; is the posture inside both drives' travel? */
bool joints_angles(const brace_app_t *app, brace_snapshot_t *snapshot);

/* Load that a joint transmits [N mm], motor's sense, as joints_play told it. index: 0 femur, 1 tibia */
static inline float joints_load(const brace_snapshot_t *snapshot, int index)
{
    return snapshot->play[BRACE_FEMUR + index].load_n_mm;
}

#endif
