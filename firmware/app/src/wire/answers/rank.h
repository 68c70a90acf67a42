/* What a request does beside answering, and how urgent it is.
 *
 * Inline: whoever sorts a burst asks for every frame. 15 instructions on a Cortex-M4F. */
#ifndef BRACE_WIRE_ANSWERS_RANK_H
#define BRACE_WIRE_ANSWERS_RANK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "brace/answering.h"
#include "brace/requests.h"

/* How urgent a request is. */
typedef enum {
    ANSWER_STOPS,      /* the limb: obeyed as soon as it is seen, before anything else */
    ANSWER_OF_SESSION, /* a sign of life, a seal, a command: each in its order, before all questions */
    ANSWER_QUESTION,
    ANSWER_UNKNOWN     /* the dictionary has no such request: refused where it is seen */
} answer_rank_t;

#define ANSWER_END_TEST (BRACE_ENTRY_COMMANDS + offsetof(brace_commands_t, end_test) / 4u)
#define ANSWER_STOP_ENTRY (BRACE_ENTRY_COMMANDS + offsetof(brace_commands_t, stop) / 4u)

static inline brace_command_t answer_writes(uint32_t index)
{
    if (index < BRACE_ENTRY_COMMANDS) {
        return BRACE_COMMAND_WRITES;
    }
    return index == ANSWER_END_TEST ? BRACE_COMMAND_MOVES : BRACE_COMMAND_NONE;
}

/* What a request does beside answering. */
static inline brace_command_t answer_command(uint32_t code, const brace_request_t *asked)
{
    switch (code) {
    case BRACE_REQUEST_TAKE_UP:
    case BRACE_REQUEST_LET_GO:
    case BRACE_REQUEST_LOADING_TEST_START: return BRACE_COMMAND_MOVES;
    case BRACE_REQUEST_WRITE_ENTRY: return answer_writes(asked->write_entry.index);
    case BRACE_REQUEST_SET_MODE:
    case BRACE_REQUEST_UPLOAD_BEGIN:
    case BRACE_REQUEST_UPLOAD_WORD:
    case BRACE_REQUEST_COMMIT:
    case BRACE_REQUEST_ROLLBACK: return BRACE_COMMAND_WRITES;
    case BRACE_REQUEST_CLEAR:
    case BRACE_REQUEST_SET_GRAVITY: return BRACE_COMMAND_INFORMS;
    default: return BRACE_COMMAND_NONE;
    }
}

/* Has the dictionary such a request? */
static inline bool answer_is_known(uint32_t code)
{
#define KNOWN(CODE, name) case CODE:
    switch (code) {
        BRACE_REQUESTS(KNOWN)
        return true;
    default: return false;
    }
#undef KNOWN
}

/* asked: looked at where the code alone does not say it */
static inline answer_rank_t answer_rank(uint32_t code, const brace_request_t *asked)
{
    if (!answer_is_known(code)) {
        return ANSWER_UNKNOWN;
    }
    switch (code) {
    case BRACE_REQUEST_LOADING_TEST_STOP: return ANSWER_STOPS;
    case BRACE_REQUEST_WRITE_ENTRY:
        return asked->write_entry.index == ANSWER_STOP_ENTRY ? ANSWER_STOPS : ANSWER_OF_SESSION;
    case BRACE_REQUEST_SIGN_OF_LIFE: return ANSWER_OF_SESSION;
    default: return answer_command(code, asked) == BRACE_COMMAND_NONE ? ANSWER_QUESTION : ANSWER_OF_SESSION;
    }
}

#endif
