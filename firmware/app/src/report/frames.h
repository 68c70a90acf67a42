/* What the two frames say that every node sends by itself: heartbeat and emergency. */
#ifndef BRACE_APP_FRAMES_H
#define BRACE_APP_FRAMES_H

#include "brace/app.h"

/* State as CANopen numbers them, mode, faults, the dictionary's hash. */
void frame_heartbeat(uint8_t data[8], brace_mode_t mode, uint32_t faults);

/* The code of the lowest new fault; 0: every fault is over. */
void frame_emergency(uint8_t data[8], uint32_t faults_before, uint32_t faults, brace_mode_t mode);

/* CANopen's emergency code for the lowest of these faults; 0x1000 for faults that only ended in part, 0
 * for none. */
uint16_t frame_emergency_code(uint32_t fresh, uint32_t faults);

#endif
