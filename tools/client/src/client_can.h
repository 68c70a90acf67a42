/* The client over CAN. Functions return what client.h says of the call with that name, and write client->why when
 * that is not OK. */
#ifndef BRACE_CLIENT_CAN_H
#define BRACE_CLIENT_CAN_H

#include "client_state.h"

brace_client_status_t brace_can_open(brace_client_t *client, uint32_t node, uint32_t bit_rate, uint64_t deadline_us);
brace_client_status_t brace_can_read(brace_client_t *client, uint32_t wanted, uint64_t deadline_us,
                                     brace_client_snapshot_t *snapshot);
/* Sends question->data, with a new token for each try, until every part of the answer has come. */
brace_client_status_t brace_can_ask(brace_client_t *client, brace_question_t *question, uint64_t deadline_us);
/* The same for a question about K under a force: sends the force first, and both again when another client comes
 * between them. */
brace_client_status_t brace_can_ask_under_force(brace_client_t *client, brace_question_t *force,
                                                brace_question_t *question, uint64_t deadline_us);

/* Sends question->data, sealed where a session is open. What moves the limb begins with the next sign of life. */
brace_client_status_t brace_can_command(brace_client_t *client, brace_question_t *question, bool moves,
                                        uint64_t deadline_us);
/* Gives a sign of life now. Its answer, whoever receives it, brings the next number. */
void brace_can_show_life(brace_client_t *client);
/* Gives a sign of life if one is due. */
void brace_can_tend(brace_client_t *client);
/* Listens until the sign of life that begins a motion has been answered, and gives it again meanwhile. */
void brace_can_hear_begin(brace_client_t *client, uint64_t deadline_us);

#endif
