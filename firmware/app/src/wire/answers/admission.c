/* Whether what a request does may be done. */
#include <stddef.h>

#include "wire/answers/answer.h"

int32_t answer_admit(request_t *request, brace_command_t command)
{
    brace_seal_t seal = {.is_there = false};
    if (command == BRACE_COMMAND_NONE) {
        return BRACE_OK;
    }
    if (request->seal != NULL) {
        seal = *request->seal;
        request->seal->is_there = false;
    }
    return brace_app_may_command(request->app, command, request->who, &seal, request->bytes, request->count);
}
