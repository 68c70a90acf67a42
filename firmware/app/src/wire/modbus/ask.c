#include "wire/modbus/ask.h"

#include <string.h>

#include "brace/questions.h"
#include "wire/modbus/refusal.h"

/* Values are 32 bits each, so a value stands at four times its place. */
static void copy_values(void *to, uint32_t to_place, const void *from, uint32_t from_place, uint32_t count)
{
    memcpy((uint8_t *)to + 4u * to_place, (const uint8_t *)from + 4u * from_place, 4u * count);
}

void modbus_ask_nothing(modbus_server_t *server)
{
    server->written = brace_commands_unknown;
    server->answered = brace_answered_unknown;
}

/* The question that begins at this command and has so many values; null: none. */
static const brace_question_t *find(uint32_t first, uint32_t count)
{
    const brace_question_t *question = brace_questions;
    for (uint32_t i = 0; i < BRACE_QUESTION_COUNT; i++, question++) {
        if (question->first == first && question->count == count) {
            return question;
        }
    }
    return NULL;
}

bool modbus_ask_is_of(uint32_t command)
{
    for (uint32_t i = 0; i < BRACE_QUESTION_COUNT; i++) {
        if (command - brace_questions[i].first < brace_questions[i].count) {
            return true;
        }
    }
    return false;
}

/* Of questions that are answered in the same registers, only the last one stands. */
static void put_out(modbus_server_t *server, const brace_question_t *question)
{
    for (uint32_t i = 0; i < BRACE_QUESTION_COUNT; i++) {
        const brace_question_t *other = &brace_questions[i];
        if (other->answer_first == question->answer_first) {
            copy_values(&server->written, other->first, &brace_commands_unknown, other->first, other->count);
        }
    }
}

modbus_exception_t modbus_ask(modbus_server_t *server, const wire_tick_t *tick, uint32_t first, uint32_t count,
                              const uint32_t *words)
{
    const brace_question_t *question = find(first, count);
    asked_force_t asked_force = {.is_there = false,
                                 .force = {0.0f, 0.0f},
                                 .is_there_in_space = false,
                                 .force_in_space = {0.0f, 0.0f},
                                 .across_n = 0.0f};
    request_t request = {.app = tick->app,
                         .measured = tick->measured,
                         .asker = server->asker,
                         .asked_force = &asked_force,
                         .who = server->who,
                         .seal = server->seal,
                         .token = 0,
                         .bytes = server->pdu,
                         .count = server->length,
                         .upload = NULL,
                         .download = NULL,
                         .node_id = 0,
                         .detail = 0,
                         .is_of_now = false};
    brace_request_t asked;
    brace_answer_t answer;
    const uint32_t picks = question == NULL ? 0u : (uint32_t)question->begin_fields + question->fields;
    if (question == NULL || (question->codes > 1u && words[picks] >= question->codes)) {
        return MODBUS_E_VALUE;
    }
    if (question->begin_code != 0u) {
        copy_values(&asked, 0, words, 0, question->begin_fields);
        (void)answer_request(&request, question->begin_code, &asked, &answer);
    }
    copy_values(&asked, 0, words, question->begin_fields, question->fields);
    const uint8_t code = question->code[question->codes > 1u ? words[picks] : 0u];
    const int32_t status = answer_request(&request, code, &asked, &answer);
    if (status == ANSWER_AGAIN) {
        return MODBUS_AGAIN;
    }
    modbus_exception_t why = request.is_of_now ? MODBUS_E_DEVICE : modbus_refusal_of(status);
    if (question->none_is_an_answer) {
        if (why == MODBUS_E_VALUE) {
            return why; /* the answer before stands */
        }
        why = MODBUS_FINE;
    }
    const bool is_known = status == BRACE_OK;
    copy_values(&server->answered, question->answer_first, is_known ? (const void *)&answer : &brace_answered_unknown,
                is_known ? 0u : question->answer_first, question->answer_count);
    if (why == MODBUS_FINE) {
        put_out(server, question);
        copy_values(&server->written, first, words, 0, count);
    }
    return why;
}
