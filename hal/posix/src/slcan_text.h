/* CAN frames as LAWICEL text (CAN232 manual, version 3): one frame, one line ended by CR. Extended by 'd' and
 * 'b' for CAN FD frames, as current SLCAN adapters have it. */
#ifndef SLCAN_TEXT_H
#define SLCAN_TEXT_H

#include "brace_hal_posix.h"

enum { SLCAN_LINE_BYTES = 160 };

/* The frame of a command t T r R d b; length without the CR. false: not one. */
bool posix_slcan_read(const char *text, uint32_t length, brace_posix_wire_frame_t *frame);

/* The line with its CR; room SLCAN_LINE_BYTES. stamp_ms < 0: none. Returns its length. */
uint32_t posix_slcan_write(const brace_posix_wire_frame_t *frame, int32_t stamp_ms, char *line);

/* The bit rate of S0-S8; 0: no such. */
uint32_t posix_slcan_bit_rate(char digit);

#endif
