/* CAN as text, a step at a time: whatever state the invariant allows and whatever comes, a step ends in one again. */
#include "copies.h"
#include "port.h"

#include "wire/slcan/slcan.c" /* for its inner functions: slcan_receive is a few rounds of them */

/* What is left of a buffer goes to its beginning. Where it reads and writes is proven; what it writes is not followed,
 * since the buffer holds any bytes before already. */
void *memmove(void *to, const void *from, size_t count)
{
    const uint8_t *out = to, *in = from;
    const bool is_in = out == in_from && in >= in_from && in <= in_end && count <= (size_t)(in_end - in);
    const bool is_out = out == out_from && in >= out_from && in <= out_end && count <= (size_t)(out_end - in);
    PROVE(is_in || is_out, "what moves is within one buffer, to its beginning");
    return to;
}

/* Any place of the byte, or none. */
void *memchr(const void *from, int byte, size_t count)
{
    const uint8_t *bytes = from;
    const uint32_t at = any_u32();
    PROVE(bytes == in_from && count <= (size_t)(in_end - in_from), "the end is looked for in what has come");
    ASSUME(at <= count);
    if (at == count) {
        return NULL;
    }
    ASSUME(bytes[at] == (uint8_t)byte);
    return (void *)&bytes[at];
}

static bool sound(const slcan_t *slcan)
{
    return slcan->in_count <= SLCAN_IN_BYTES && slcan->out_first + slcan->out_count <= SLCAN_OUT_BYTES;
}

static void takes_a_line(slcan_t *slcan)
{
    brace_can_frame_t frame;
    bool is_frame = false;
    const uint32_t before = slcan->in_count;
    const bool taken = take_line(slcan, &frame, &is_frame);
    PROVE(!taken || slcan->in_count < before, "a line that is taken is gone");
    PROVE(taken || slcan->in_count < SLCAN_IN_BYTES, "without a line there is room for the rest of it");
    if (is_frame) {
        PROVE(taken && frame.id <= 0x7ffu && frame.length <= 8u && !frame.fd, "what is taken for a frame is one");
        PROVE(slcan->is_open && !slcan->is_listen_only, "frames are taken only while the channel is open to them");
    }
}

static void sends(slcan_t *slcan)
{
    brace_can_frame_t frame, before;
    const uint32_t count = slcan->out_count;
    before = frame;
    const bool has_room = slcan_send(slcan, &frame);
    PROVE(!has_room || slcan->out_count > count, "a frame that found room is in the buffer");
    PROVE(has_room || slcan->out_count == count, "without room nothing changes");
    PROVE(has_room || frame.length > 8u || count + 6u + 2u * frame.length > SLCAN_OUT_BYTES,
          "a frame finds room where there is any");
    PROVE(same(&frame, &before, sizeof frame), "a frame that is sent is not changed");
}

int main(void)
{
    slcan_t slcan; /* of any content */
    in_from = slcan.in;
    in_end = slcan.in + sizeof slcan.in;
    out_from = slcan.out;
    out_end = slcan.out + sizeof slcan.out;
    const uint32_t at = any_u32();
    ASSUME(sound(&slcan) && at < SLCAN_IN_BYTES);
    const uint8_t byte = slcan.in[at]; /* any one of them, so all */
    switch (any_u8() & 3u) {
    case 0: read_port(&slcan, &any_hal); break;
    case 1: takes_a_line(&slcan); break;
    case 2: sends(&slcan); break;
    default: slcan_flush(&slcan, &any_hal); break;
    }
    PROVE(slcan.in[at] == byte, "only the port and memmove write to what has come"); /* here both leave it as it is */
    PROVE(sound(&slcan), "a step from a sound state ends in one");
    return 0;
}
