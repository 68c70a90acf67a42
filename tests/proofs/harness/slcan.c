/* CAN as text, a line at a time: whatever state the invariant allows and whatever comes, a line ends in one again. */
#include "app.h"

#include "can/slcan.c" /* for its inner functions: slcan_port_receive is a few rounds of them */

/* Of at most a line, and downwards only: that is what it is used for. */
void *memmove(void *to, const void *from, size_t count)
{
    uint8_t *out = to;
    const uint8_t *in = from;
    PROVE(out < in && count < BRACE_APP_LINE_BYTES, "what moves is less than a line, downwards");
    for (uint32_t i = 0; i < BRACE_APP_LINE_BYTES && i < count; i++) {
        out[i] = in[i];
    }
    return to;
}

static bool sound(const brace_app_slcan_t *slcan)
{
    return slcan->line_count <= BRACE_APP_LINE_BYTES && slcan->in_first + slcan->in_count <= BRACE_APP_IN_BYTES &&
           slcan->out_first + slcan->out_count <= BRACE_APP_LINE_BYTES;
}

int main(void)
{
    brace_app_t app; /* of any content */
    brace_app_slcan_t *slcan = &app.bus.slcan;
    brace_can_frame_t frame, before;
    app.hal = &any_hal;
    in_from = slcan->in;
    in_end = slcan->in + sizeof slcan->in;
    out_from = slcan->out;
    out_end = slcan->out + sizeof slcan->out;
    const uint32_t at = any_u32(), line_at = any_u32();
    ASSUME(at < BRACE_APP_IN_BYTES && line_at < BRACE_APP_LINE_BYTES);
    /* any byte of what lies next to each buffer */
    const uint8_t behind = slcan->in[at], line_before = slcan->line[line_at];
    before = frame;
    ASSUME(sound(slcan));
    if (any_bool()) {
        if (gather(slcan) && take_line(&app, &frame)) {
            PROVE(frame.id <= 0x7ffu && frame.length <= 8u && !frame.fd, "what is taken for a frame is one");
            PROVE(slcan->open && !slcan->listen_only, "frames are taken only while the channel is open to them");
        }
    } else {
        const bool taken = slcan_port_send(&app, &frame);
        PROVE(slcan->line[line_at] == line_before, "what is sent leaves what comes alone");
        PROVE(taken || slcan->out_count > 0u, "a frame waits only behind another");
        PROVE(same(&frame, &before, sizeof frame), "a frame that is sent is not changed");
    }
    PROVE(slcan->in[at] == behind, "nothing is written behind the line");
    PROVE(sound(slcan), "a line from a sound state ends in one");
    return 0;
}
