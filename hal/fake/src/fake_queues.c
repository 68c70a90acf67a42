#include "fake_door.h"

bool fake_frames_put(brace_fake_frames_t *frames, const brace_can_frame_t *frame)
{
    if (frames->count >= BRACE_FAKE_FRAMES) {
        frames->lost++;
        return false;
    }
    frames->frame[(frames->first + frames->count) % BRACE_FAKE_FRAMES] = *frame;
    frames->count++;
    return true;
}

bool fake_frames_take(brace_fake_frames_t *frames, brace_can_frame_t *frame)
{
    if (frames->count == 0) {
        return false;
    }
    *frame = frames->frame[frames->first];
    frames->first = (frames->first + 1u) % BRACE_FAKE_FRAMES;
    frames->count--;
    return true;
}

uint32_t fake_bytes_put(brace_fake_bytes_t *bytes, const uint8_t *from, uint32_t count)
{
    uint32_t done = 0;
    while (done < count && bytes->count < BRACE_FAKE_SERIAL_BYTES) {
        bytes->byte[(bytes->first + bytes->count) % BRACE_FAKE_SERIAL_BYTES] = from[done++];
        bytes->count++;
    }
    return done;
}

uint32_t fake_bytes_take(brace_fake_bytes_t *bytes, uint8_t *to, uint32_t room)
{
    uint32_t done = 0;
    while (done < room && bytes->count > 0) { /* at most BRACE_FAKE_SERIAL_BYTES */
        to[done++] = bytes->byte[bytes->first];
        bytes->first = (bytes->first + 1u) % BRACE_FAKE_SERIAL_BYTES;
        bytes->count--;
    }
    return done;
}

bool brace_fake_frame_arrives(brace_fake_t *fake, const brace_can_frame_t *frame)
{
    const brace_can_setup_t *setup = &fake->can_setup;
    if (setup->urgent_id != 0u && frame->id == setup->urgent_id) {
        fake->can_urgent = *frame;
        fake->can_has_urgent = true;
        return true;
    }
    if (fake->can_filters && ((frame->id ^ setup->filter_id) & setup->filter_mask) != 0u) {
        return true;
    }
    const bool room = fake_frames_put(&fake->can_received, frame);
    fake->can_health.frames_lost += !room;
    return room;
}

bool brace_fake_frame_take(brace_fake_t *fake, brace_can_frame_t *frame)
{
    return fake_frames_take(&fake->can_sent, frame);
}

uint32_t brace_fake_bytes_arrive(brace_fake_t *fake, brace_serial_port_t port, const uint8_t *bytes, uint32_t count)
{
    return fake_bytes_put(&fake->serial_received[port], bytes, count);
}

uint32_t brace_fake_bytes_take(brace_fake_t *fake, brace_serial_port_t port, uint8_t *bytes, uint32_t room)
{
    return fake_bytes_take(&fake->serial_sent[port], bytes, room);
}
