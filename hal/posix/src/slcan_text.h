/* CAN frames as LAWICEL text (CAN232 manual, version 3): one frame is one line ended by CR. 'd' and 'b' add CAN FD
 * frames, as current SLCAN adapters do. */
#ifndef SLCAN_TEXT_H
#define SLCAN_TEXT_H

#include "brace_hal_posix.h"

enum { SLCAN_LINE_BYTES = 160 };

/* Reads the frame of a command t T r R d b; length without the CR. false: this is no frame. */
bool posix_slcan_read(const char *text, uint32_t length, brace_posix_wire_frame_t *frame);

/* Writes the line with its CR; room SLCAN_LINE_BYTES. stamp_ms < 0: without time stamp. Returns its length. */
uint32_t posix_slcan_write(const brace_posix_wire_frame_t *frame, int32_t stamp_ms, char *line);

/* The bit rate of S0-S8; 0: there is no such number. */
uint32_t posix_slcan_bit_rate(char digit);

#endif
