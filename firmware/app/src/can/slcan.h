/* CAN frames as LAWICEL text over the serial port BRACE_SERIAL_SLCAN: what slcand and python-can speak to an
 * adapter. Commands S0-S8 and sxxyy (taken; there is no bit rate here), O, L, C, t, T, r, R, V, v, N, F, Z0;
 * CR is yes, BEL is no. Remote and extended frames are taken and lead nowhere; a line that is too long is
 * refused as a whole. */
#ifndef BRACE_APP_SLCAN_H
#define BRACE_APP_SLCAN_H

#include "brace/app.h"

enum { SLCAN_BAUD = 921600 };

void slcan_port_start(brace_app_t *app);

/* Takes bytes until a frame is whole, at most BRACE_APP_IN_BYTES and four lines of them; false: none is. At most
 * 600 instructions. */
bool slcan_port_receive(brace_app_t *app, brace_can_frame_t *frame);

/* Writes a line, at once or when the one before is out; false: that one still waits. Nothing is sent, and
 * that is fine, when the other end only listens or the channel is closed. */
bool slcan_port_send(brace_app_t *app, const brace_can_frame_t *frame);

#endif
