#include "wire/answers/answer.h"

#include "wire/answers/rank.h"

int32_t answer_request(request_t *request, uint32_t code, const brace_request_t *asked, brace_answer_t *answer)
{
    const int32_t status = answer_admit(request, answer_command(code, asked));
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
