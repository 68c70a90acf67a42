/* The fake's own header: the door's entries, and the queues behind them. */
#ifndef BRACE_FAKE_DOOR_H
#define BRACE_FAKE_DOOR_H

#include <stddef.h>

#include "brace_hal_fake.h"

/* Counts a call. Returns the answer that the test wants instead of OK, if it wants the call to fail. */
int32_t fake_called(brace_fake_t *fake, brace_fake_entry_t entry);

void fake_door_fill(brace_fake_t *fake);

bool fake_frames_put(brace_fake_frames_t *frames, const brace_can_frame_t *frame);
bool fake_frames_take(brace_fake_frames_t *frames, brace_can_frame_t *frame);
uint32_t fake_bytes_put(brace_fake_bytes_t *bytes, const uint8_t *from, uint32_t count);
uint32_t fake_bytes_take(brace_fake_bytes_t *bytes, uint8_t *to, uint32_t room);

#endif
