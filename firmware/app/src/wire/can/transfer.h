/* A parameter block over the bus, word by word: uploaded and stored, or downloaded. */
#ifndef BRACE_WIRE_CAN_TRANSFER_H
#define BRACE_WIRE_CAN_TRANSFER_H

#include "wire/can/answers.h"
#include "wire/can/session.h"
#include "wire/wire.h"

/* Each tick, before requests are answered: closes an upload that CONFIGURATION has ended, and answers the commit or
 * roll-back that this port has asked for, once the store has ended. Takes two frames of room.
 * At most 250 instructions. */
void transfer_tick(can_session_t *session, can_answers_t *answers, const wire_tick_t *tick);

#endif
