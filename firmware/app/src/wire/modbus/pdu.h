/* A request and its answer, whatever port carries them: functions 03, 04, 06, 08, 16, 17 and 43/14 of Modbus
 * application protocol 1.1b3. */
#ifndef BRACE_WIRE_MODBUS_PDU_H
#define BRACE_WIRE_MODBUS_PDU_H

#include "wire/answers/answer.h"
#include "wire/answers/rank.h"
#include "wire/modbus/protocol.h"
#include "wire/modbus/server.h"
#include "wire/wire.h"

/* Does what a request asks for; the answer takes the request's place.
 *   half: of the connection by which the request came
 *   pdu: room for MODBUS_PDU_BYTES
 *   length: of the request [1, MODBUS_PDU_BYTES]
 * returns the answer's length [2, MODBUS_PDU_BYTES]; 0: it is being worked out, and the request, which is untouched, is
 *   to be put again in the next tick. At most what modbus_write_block costs. */
uint32_t modbus_pdu_answer(modbus_server_t *server, modbus_half_t *half, const wire_tick_t *tick, uint8_t *pdu,
                           uint32_t length);

/* How urgent a request is. A question is whatever reads, and a write that asks something (modbus_ask). */
answer_rank_t modbus_pdu_rank(const uint8_t *pdu, uint32_t length);

/* Makes an exception of the request, and counts it. returns the answer's length */
uint32_t modbus_pdu_refuse(modbus_server_t *server, const wire_tick_t *tick, uint8_t *pdu, modbus_exception_t why);

/* How many bytes a request must have before it can be whole, judged by the first `length` of them (at least 1); 1 when
 * that is not known. */
uint32_t modbus_pdu_least_length(const uint8_t *pdu, uint32_t length);

#endif
