/* The node on its bus: frames of eight bytes in and out, a snapshot's of CAN FD out, over the CAN controller, over a
 * serial port as SLCAN text, or both. Two ports carry the same; while an SLCAN channel is open it is the one that is
 * waited for, since a board without a transceiver has nobody to acknowledge on the other. */
#ifndef BRACE_APP_BUS_H
#define BRACE_APP_BUS_H

#include "brace/app.h"

/* Sets both up; not for the tick. With node 0 CAN only listens, and only requests to node 0 over SLCAN, which
 * has one other end, are answered: so a board is given its number. */
void bus_start(brace_app_t *app);

/* Health of the CAN controller, and the way back after bus off: tried again after 125 ms, then after twice
 * as long each time, at most 2 s. About 30 instructions. */
void bus_watch(brace_app_t *app);

/* May this node send by itself, and is there anybody to send to? */
bool bus_speaks(const brace_app_t *app);

/* Sends one frame with this node's identifier. false: no room, try again at the next tick.
 *   function: identifier of node 0 (BRACE_CAN_ID_...)
 * About 60 instructions; over SLCAN 300. */
bool bus_send(brace_app_t *app, uint32_t function, const uint8_t data[8]);

/* Sends frames of one identifier, in this order, as far as there is room. returns how many */
uint32_t bus_send_some(brace_app_t *app, uint32_t function, const uint8_t (*data)[8], uint32_t count);

/* Do snapshots go out as one frame of CAN FD? Where the parameters and the controller's CAN have it, and nobody listens
 * over SLCAN. */
bool bus_takes_fd(const brace_app_t *app);

/* As bus_send; a frame of 64 bytes. About 100 instructions. */
bool bus_send_fd(brace_app_t *app, uint32_t function, const uint8_t data[64]);

/* A frame that has come over CAN, whoever it is for; what comes over SLCAN: slcan_port_receive. About 40
 * instructions. */
bool bus_receive(brace_app_t *app, brace_can_frame_t *frame);

#endif
