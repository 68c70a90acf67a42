/* Questions about the limb, asked by writing command registers whose names begin with asked_: brace/questions.h lists
 * them. The answer can be read from the registers of brace_answered_t as soon as the write is answered. */
#ifndef BRACE_WIRE_MODBUS_ASK_H
#define BRACE_WIRE_MODBUS_ASK_H

#include "wire/answers/answer.h"
#include "wire/modbus/protocol.h"
#include "wire/modbus/server.h"
#include "wire/wire.h"

/* Nothing has been asked: questions and answers are unknown, which is NaN or all ones. */
void modbus_ask_nothing(modbus_server_t *server);

/* Does this command belong to a question? */
bool modbus_ask_is_of(uint32_t command);

/* Answers a question.
 *   first: command number of its first value
 *   words: its values as their 32 bits, `count` of them
 * returns MODBUS_E_VALUE also when no question of so many values begins there; MODBUS_AGAIN: the answer is being worked
 *   out, so the same is to be asked in the next tick
 * At most 400 instructions. */
modbus_exception_t modbus_ask(modbus_server_t *server, const wire_tick_t *tick, uint32_t first, uint32_t count,
                              const uint32_t *words);

#endif
