#include "wire/can/transfer.h"

#include "wire/can/request.h"
#include "wire/measured.h"

#define SIZE_OF_BLOCK 0xffffu /* a word's number that asks for it */

enum {
    WORD_BYTES = 4,
    BLOCK_WORDS = BRACE_BLOCK_BYTES / WORD_BYTES,
    HEADER_WORDS = BRACE_BLOCK_HEADER_BYTES / WORD_BYTES
};
_Static_assert(BRACE_BLOCK_BYTES % WORD_BYTES == 0, "a block is whole words");

/* A block is little-endian on every processor. */
static uint32_t get_word(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

static void put_word(uint8_t *bytes, uint32_t word)
{
    for (uint32_t i = 0; i < (uint32_t)WORD_BYTES; i++) {
        bytes[i] = (uint8_t)(word >> (8u * i));
    }
}

/* May parameters be written now? */
static int32_t may_write(can_request_t *request)
{
    const brace_status_t status = brace_app_may_write(request->tick->app);
    request->detail = brace_app_mode(request->tick->app);
    return status == BRACE_E_UNSUPPORTED ? (int32_t)BRACE_REFUSED_BUSY : (int32_t)status;
}

/* ------------------------------------------------------------------------------------------ upload -- */

int32_t can_answer_upload_begin(can_request_t *request, const brace_can_upload_begin_request_t *asked,
                                brace_can_upload_begin_answer_t *answer)
{
    can_session_t *session = request->session;
    const int32_t status = may_write(request);
    if (status != BRACE_OK) {
        return status;
    }
    if (asked->bytes != BRACE_BLOCK_BYTES) {
        request->detail = BRACE_BLOCK_BYTES;
        return BRACE_E_LENGTH;
    }
    session->upload_is_open = true;
    session->upload_next = 0;
    session->upload_crc = asked->crc;
    answer->words = BLOCK_WORDS;
    return BRACE_OK;
}

/* Words come in order. The last one may come again, changed or not, because its answer may have been lost; so the CRC
 * leaves it out until the next one comes. */
int32_t can_answer_upload_word(can_request_t *request, const brace_can_upload_word_request_t *asked,
                               brace_can_upload_word_answer_t *answer)
{
    can_session_t *session = request->session;
    const int32_t status = may_write(request);
    if (status != BRACE_OK) {
        return status;
    }
    const bool comes_again = asked->word + 1u == session->upload_next;
    request->detail = session->upload_is_open ? session->upload_next : 0u;
    if (!session->upload_is_open || asked->word >= BLOCK_WORDS ||
        (asked->word != session->upload_next && !comes_again)) {
        return BRACE_REFUSED_ORDER;
    }
    uint8_t *place = &session->upload[WORD_BYTES * asked->word];
    if (!comes_again) { /* the word before stays as it is now */
        session->upload_sum =
            asked->word == 0u ? 0u : brace_crc32(session->upload_sum, place - WORD_BYTES, WORD_BYTES);
    }
    put_word(place, asked->data);
    session->upload_next = asked->word + 1u;
    *answer = (brace_can_upload_word_answer_t){asked->word, asked->data};
    return BRACE_OK;
}

/* ----------------------------------------------------------------------------------------- storing -- */

/* Begins to store an uploaded block that is whole, is what was announced and is of our dictionary. Its values are
 * judged by the store, on the way. */
static int32_t store_upload(can_request_t *request, uint32_t crc)
{
    brace_block_header_t header;
    brace_parameters_t set;
    can_session_t *session = request->session;
    request->detail = session->upload_is_open ? session->upload_next : 0u;
    if (!session->upload_is_open || session->upload_next != BLOCK_WORDS) {
        return BRACE_REFUSED_ORDER;
    }
    session->upload_is_open = false; /* it was committed, whatever comes of it */
    request->detail = get_word(&session->upload[BRACE_BLOCK_BYTES - WORD_BYTES]);
    if (crc != session->upload_crc || crc != request->detail) {
        return BRACE_E_CHECKSUM;
    }
    request->detail = BRACE_SCHEMA_HASH;
    const brace_status_t status = brace_block_header(session->upload, BRACE_BLOCK_BYTES, &header);
    if (status != BRACE_OK) {
        return status;
    }
    if (header.block_bytes != BRACE_BLOCK_BYTES) {
        return BRACE_E_LENGTH;
    }
    if (crc != session->upload_sum) {
        return BRACE_E_CHECKSUM;
    }
    if (header.schema_hash != BRACE_SCHEMA_HASH) {
        return BRACE_E_SCHEMA;
    }
    brace_block_members(session->upload, &set);
    return brace_app_parameters_commit(request->tick->app, &set);
}

/* Begins to store the entries that were written one by one. A refusal tells the number of the one at fault. */
static int32_t store_staged(can_request_t *request)
{
    uint32_t wrong_index = 0;
    const brace_status_t status = brace_app_parameters_commit_staged(request->tick->app, &wrong_index);
    if (status == BRACE_E_PARAMETER || status == BRACE_E_NOT_FINITE) {
        request->detail = brace_parameter_number(wrong_index);
    }
    return status;
}

/* What has begun is answered by transfer_tick when it has ended; a refusal is answered at once. */
static int32_t answer_later(const can_request_t *request, int32_t status)
{
    if (status != BRACE_OK) {
        return status;
    }
    request->session->storing = (uint8_t)request->code;
    request->session->storing_token = (uint8_t)request->token;
    return CAN_ANSWER_LATER;
}

int32_t can_answer_commit(can_request_t *request, const brace_can_commit_request_t *asked,
                          brace_can_commit_answer_t *answer)
{
    (void)answer;
    const int32_t status = may_write(request);
    if (status != BRACE_OK) {
        return status;
    }
    return answer_later(request, asked->crc != 0u ? store_upload(request, asked->crc) : store_staged(request));
}

int32_t can_answer_rollback(can_request_t *request, const brace_can_rollback_request_t *asked,
                            brace_can_rollback_answer_t *answer)
{
    (void)asked;
    (void)answer;
    const int32_t status = may_write(request);
    return status != BRACE_OK ? status : answer_later(request, brace_app_parameters_rollback(request->tick->app));
}

static void answer_end_of_storing(can_session_t *session, can_answers_t *answers, const brace_app_t *app)
{
    const uint32_t code = session->storing, token = session->storing_token;
    brace_store_status_t store;
    (void)brace_app_store_status(app, &store);
    session->storing = 0;
    if (store.state == BRACE_STORE_FAILED) {
        const bool is_refused = store.failure == BRACE_STORE_E_REFUSED;
        const int32_t status =
            is_refused ? (int32_t)store.refusal : (int32_t)BRACE_REFUSED_STORE + (int32_t)store.failure;
        can_answers_refuse(answers, code, token, status, is_refused ? brace_parameter_number(store.wrong_index) : 0u);
        return;
    }
    uint8_t parts[BRACE_CAN_ANSWER_PARTS_MOST][8];
    const brace_can_commit_answer_t answer = {store.sequence, brace_app_snapshot(app)->parameter_crc};
    if (code == BRACE_REQUEST_COMMIT) {
        brace_can_pack_commit_answer(&answer, token, parts);
    } else {
        brace_can_pack_rollback_answer(&answer, token, parts);
    }
    can_answers_add(answers, parts, brace_can_answer_parts[code]);
}

void transfer_tick(can_session_t *session, can_answers_t *answers, const wire_tick_t *tick)
{
    if (brace_app_mode(tick->app) != BRACE_MODE_CONFIGURATION) {
        session->upload_is_open = false;
    }
    if (session->storing != 0u && !brace_app_is_storing(tick->app)) {
        answer_end_of_storing(session, answers, tick->app);
    }
}

/* ---------------------------------------------------------------------------------------- download -- */

/* A word of the block as brace_parameters_pack would write it. */
static uint32_t block_word(const can_request_t *request, uint32_t word)
{
    const brace_app_t *app = request->tick->app;
    brace_store_status_t store;
    switch (word) {
    case 0: return get_word((const uint8_t *)"BRCE");
    case 1: return BRACE_BLOCK_FORMAT | (uint32_t)BRACE_BLOCK_HEADER_BYTES << 16;
    case 2: return BRACE_SCHEMA_HASH;
    case 3: return WORD_BYTES * BRACE_PARAMETER_COUNT;
    case 4: (void)brace_app_store_status(app, &store); return store.sequence;
    case BLOCK_WORDS - 1: return request->session->download_sum;
    default: return parameter_member(brace_app_parameters(app), word - HEADER_WORDS);
    }
}

/* Words in order; the last one again if its answer was lost. */
static int32_t download_next(can_request_t *request, uint32_t word, uint32_t *data)
{
    can_session_t *session = request->session;
    const uint32_t set = brace_app_snapshot(request->tick->app)->parameter_crc;
    if (word == 0u) {
        session->download_next = 0;
        session->download_sum = 0;
        session->download_set = set;
    }
    request->detail = session->download_next;
    if (word >= BLOCK_WORDS || (word != session->download_next && word + 1u != session->download_next)) {
        return BRACE_REFUSED_ORDER;
    }
    if (session->download_set != set) {
        session->download_next = 0;
        return BRACE_REFUSED_CHANGED;
    }
    *data = block_word(request, word);
    if (word == session->download_next && word < BLOCK_WORDS - 1u) {
        uint8_t bytes[WORD_BYTES];
        put_word(bytes, *data);
        session->download_sum = brace_crc32(session->download_sum, bytes, WORD_BYTES);
    }
    session->download_next = word + 1u;
    return BRACE_OK;
}

int32_t can_answer_download_word(can_request_t *request, const brace_can_download_word_request_t *asked,
                                 brace_can_download_word_answer_t *answer)
{
    const brace_app_t *app = request->tick->app;
    uint32_t data = BRACE_BLOCK_BYTES | (uint32_t)brace_app_snapshot(app)->parameter_origin << 16;
    if (brace_app_is_storing(app)) {
        return BRACE_REFUSED_BUSY;
    }
    const int32_t status =
        asked->word == SIZE_OF_BLOCK ? (int32_t)BRACE_OK : download_next(request, asked->word, &data);
    if (status == BRACE_OK) {
        *answer = (brace_can_download_word_answer_t){asked->word, data};
    }
    return status;
}
