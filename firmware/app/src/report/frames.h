/* The two CAN frames that every node sends: heartbeat 0x700 + node, emergency 0x080 + node. Little-endian. */
#ifndef BRACE_APP_FRAMES_H
#define BRACE_APP_FRAMES_H

#include "brace/app.h"

/* state u8 (0 start, 5 operational, 0x7f configuration, 4 fault), mode u8, faults u16, dictionary's hash u32 */
void frame_heartbeat(brace_can_frame_t *frame, uint8_t node_id, brace_mode_t mode, uint32_t faults);

/* code u16 (of the lowest new fault; 0: every fault is over), mode u8, 0 u8, faults u32 */
void frame_emergency(brace_can_frame_t *frame, uint8_t node_id, uint32_t faults_before, uint32_t faults,
                     brace_mode_t mode);

/* CANopen's emergency code for the lowest of these faults; 0x1000 for faults that only ended in part, 0
 * for none. */
uint16_t frame_emergency_code(uint32_t fresh, uint32_t faults);

#endif
