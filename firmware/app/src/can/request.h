/* One request on its way to its answer. Each request_... unpacks it, does it, puts its answers into the
 * queue and returns BRACE_OK, or why not: then nothing has changed and nothing has been queued. */
#ifndef BRACE_APP_REQUEST_H
#define BRACE_APP_REQUEST_H

#include "brace/app.h"
#include "brace/refusals.h"

typedef struct {
    const uint8_t *data;
    uint32_t code, token;
    uint32_t detail; /* (out) what a refusal has to add */
} request_t;

/* Queues one frame of an answer, to be written where this says; requests_take leaves room for all parts of one. */
static inline uint8_t *answer_place(brace_app_t *app)
{
    brace_app_requests_t *requests = &app->requests;
    const uint32_t count = requests->answer_count, place = (requests->answer_first + count) % BRACE_APP_ANSWERS;
    requests->answer_count = (uint8_t)(count + (count < (uint32_t)BRACE_APP_ANSWERS));
    return requests->answer[place];
}

/* Queues a frame that is written already. */
void answer_put(brace_app_t *app, const uint8_t data[8]);

/* Queues a refusal. */
void answer_refusal(brace_app_t *app, uint32_t code, uint32_t token, int32_t status, uint32_t detail);

int32_t request_read_entry(brace_app_t *app, request_t *request);
int32_t request_write_entry(brace_app_t *app, request_t *request);
int32_t request_set_mode(brace_app_t *app, request_t *request);
int32_t request_upload_begin(brace_app_t *app, request_t *request);
int32_t request_upload_word(brace_app_t *app, request_t *request);
int32_t request_commit(brace_app_t *app, request_t *request);
int32_t request_rollback(brace_app_t *app, request_t *request);
int32_t request_download_word(brace_app_t *app, request_t *request);

/* Answers a commit or roll-back once the store has ended and the set is in force; else nothing. */
void request_storing_answer(brace_app_t *app);

int32_t request_k_at_posture(brace_app_t *app, request_t *request);
int32_t request_k_at_tip(brace_app_t *app, request_t *request); /* knee up, knee down */
int32_t request_contact_force(brace_app_t *app, request_t *request);
int32_t request_sag_for_load(brace_app_t *app, request_t *request);
int32_t request_friction_margin(brace_app_t *app, request_t *request);

int32_t request_take_up(brace_app_t *app, request_t *request);
int32_t request_let_go(brace_app_t *app, request_t *request);
int32_t request_loading_start(brace_app_t *app, request_t *request);
int32_t request_loading_stop(brace_app_t *app, request_t *request);
int32_t request_fetch_row(brace_app_t *app, request_t *request);
int32_t request_loading_result(brace_app_t *app, request_t *request);
int32_t request_identify(brace_app_t *app, request_t *request);
int32_t request_clear(brace_app_t *app, request_t *request);

#endif
