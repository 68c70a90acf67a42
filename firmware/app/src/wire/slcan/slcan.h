/* CAN frames as LAWICEL text over the serial port BRACE_SERIAL_SLCAN: what slcand and python-can speak to an adapter.
 *
 * Commands: S0-S8 and sxxyy (taken; there is no bit rate here), O, L, C, t, T, r, R, V, v, N, F, Z0. CR is yes, BEL is
 * no. Remote and extended frames are taken and lead nowhere. A line that is too long is refused as a whole.
 *
 * Lines to be sent are gathered in a buffer that holds all that a tick has to say, and leave as fast as the line takes
 * them. One caller, the tick; no pointer may be null. Costs are instructions on a Cortex-M4F. */
#ifndef BRACE_WIRE_SLCAN_SLCAN_H
#define BRACE_WIRE_SLCAN_SLCAN_H

#include <stdbool.h>
#include <stdint.h>

#include "brace_hal.h"

enum {
    SLCAN_BAUD = 921600,
    SLCAN_IN_BYTES = 32, /* the longest line there is has 27 characters, then CR; and some hosts send a LF before it */
    SLCAN_OUT_BYTES = 256 /* an answer of five frames, six others and the replies to commands: 22 bytes a frame */
};

typedef struct {
    bool is_fitted; /* the board has the port */
    bool is_open; /* the channel, as the other end wants it */
    bool was_closed; /* by the other end, since the caller last looked: it may be open again, for another host */
    bool is_listen_only; /* opened with L: the other end hears, and its frames are refused */
    uint32_t urgent_id; /* frames of this identifier are taken also while the channel is closed or listens only */
    bool skips; /* the line that is coming is too long; its rest is passed over */
    uint8_t in_count; /* [0, 32] */
    uint16_t out_first, out_count; /* the bytes of out that wait to be written */
    uint8_t in[SLCAN_IN_BYTES]; /* what has come, from the beginning of a line on */
    uint8_t out[SLCAN_OUT_BYTES]; /* what has not left yet */
} slcan_t;

/* Opens the serial port. Before the first tick. */
void slcan_start(slcan_t *slcan, const brace_hal_t *hal, uint32_t urgent_id);

/* Reads what has come and obeys it, until a line is a frame for the node or nothing more has come.
 * returns whether there is a frame
 * 350 instructions for a line. */
bool slcan_receive(slcan_t *slcan, const brace_hal_t *hal, brace_can_frame_t *frame);

/* Puts a frame into the buffer, as a line. The channel is open.
 * returns whether there was room; a frame of CAN FD has no text and never finds any
 * At most 300 instructions. */
bool slcan_send(slcan_t *slcan, const brace_can_frame_t *frame);

/* Gives the line what it takes of the buffer. About 30 instructions; 200 more where the line takes a part only. */
void slcan_flush(slcan_t *slcan, const brace_hal_t *hal);

#endif
