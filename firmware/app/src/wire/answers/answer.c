#include "wire/answers/answer.h"

#include <stddef.h>

#define END_TEST (BRACE_ENTRY_COMMANDS + offsetof(brace_commands_t, end_test) / 4u)
#define STOP (BRACE_ENTRY_COMMANDS + offsetof(brace_commands_t, stop) / 4u)

static brace_command_t writing(uint32_t index)
{
    if (index < BRACE_ENTRY_COMMANDS) {
        return BRACE_COMMAND_WRITES;
    }
    return index == END_TEST ? BRACE_COMMAND_MOVES : BRACE_COMMAND_NONE;
}

/* What a request does beside answering. */
static brace_command_t command_of(uint32_t code, const brace_request_t *asked)
{
    switch (code) {
    case BRACE_REQUEST_TAKE_UP:
    case BRACE_REQUEST_LET_GO:
    case BRACE_REQUEST_LOADING_TEST_START: return BRACE_COMMAND_MOVES;
    case BRACE_REQUEST_WRITE_ENTRY: return writing(asked->write_entry.index);
    case BRACE_REQUEST_SET_MODE:
    case BRACE_REQUEST_UPLOAD_BEGIN:
    case BRACE_REQUEST_UPLOAD_WORD:
    case BRACE_REQUEST_COMMIT:
    case BRACE_REQUEST_ROLLBACK: return BRACE_COMMAND_WRITES;
    case BRACE_REQUEST_CLEAR:
    case BRACE_REQUEST_SET_GRAVITY: return BRACE_COMMAND_TELLS;
    default: return BRACE_COMMAND_NONE;
    }
}

/* Has the dictionary such a request? */
static bool is_known(uint32_t code)
{
#define KNOWN(CODE, name) case CODE:
    switch (code) {
        BRACE_REQUESTS(KNOWN)
        return true;
    default: return false;
    }
#undef KNOWN
}

answer_rank_t answer_rank(uint32_t code, const brace_request_t *asked)
{
    if (!is_known(code)) {
        return ANSWER_UNKNOWN;
    }
    switch (code) {
    case BRACE_REQUEST_LOADING_TEST_STOP: return ANSWER_STOPS;
    case BRACE_REQUEST_WRITE_ENTRY: return asked->write_entry.index == STOP ? ANSWER_STOPS : ANSWER_OF_SESSION;
    case BRACE_REQUEST_SIGN_OF_LIFE: return ANSWER_OF_SESSION;
    default: return command_of(code, asked) == BRACE_COMMAND_NONE ? ANSWER_QUESTION : ANSWER_OF_SESSION;
    }
}

int32_t answer_request(request_t *request, uint32_t code, const brace_request_t *asked, brace_answer_t *answer)
{
    const int32_t status = answer_admit(request, command_of(code, asked));
    if (status != BRACE_OK) {
        return status;
    }
#define ANSWER(CODE, name) \
    case CODE: return answer_##name(request, &asked->name, &answer->name);
    switch (code) {
        BRACE_REQUESTS(ANSWER)
    default: request->detail = BRACE_REQUEST_CODE_MOST; return BRACE_REFUSED_UNKNOWN;
    }
#undef ANSWER
}
