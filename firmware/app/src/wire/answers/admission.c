/* Whether what a request does may be done. */
#include "wire/answers/answer.h"

int32_t answer_admit(request_t *request, brace_command_t command)
{
    if (command == BRACE_COMMAND_NONE) {
        return BRACE_OK;
    }
    return brace_app_may_command(request->app, command, request->who, request->seal, request->bytes, request->count);
}
