/* Entries of the dictionary, and parameters: staged member by member or uploaded as a block, in force only
 * once they are stored and have read back. */
#include <string.h>

#include "brace/measured.h"
#include "can/request.h"
#include "configure/staging.h"
#include "configure/storing.h"
#include "report/measured.h"

#define KEY 0xc0deu
#define SIZE_OF_BLOCK 0xffffu /* a word's number that asks for it */

enum {
    BLOCK_WORDS = BRACE_BLOCK_BYTES / 4,
    MEMBER_WORDS = BRACE_PARAMETER_COUNT,
    HEADER_WORDS = BRACE_BLOCK_HEADER_BYTES / 4
};
_Static_assert(BRACE_BLOCK_BYTES % 4 == 0, "a block is whole words");

int32_t request_read_entry(brace_app_t *app, request_t *request)
{
    brace_can_read_entry_request_t asked;
    brace_measured_t measured;
    uint8_t data[8];
    brace_can_unpack_read_entry_request(request->data, &asked);
    brace_can_read_entry_answer_0_t answer = {request->token, asked.index, 0};
    if (asked.index < BRACE_PARAMETER_COUNT) {
        memcpy(&answer.value, (const uint8_t *)&app->parameters + 4u * asked.index, 4);
    } else {
        brace_measured_take(app, app->hal->now_us(app->hal->context), &measured);
        if (measured_entry(&measured, asked.index, &answer.value) != BRACE_OK) {
            request->detail = asked.index;
            return BRACE_E_RANGE;
        }
    }
    (void)brace_can_pack_read_entry_answer_0(&answer, data);
    answer_put(app, data);
    return BRACE_OK;
}

int32_t request_write_entry(brace_app_t *app, request_t *request)
{
    brace_can_write_entry_request_t asked;
    uint8_t data[8];
    brace_can_unpack_write_entry_request(request->data, &asked);
    request->detail = asked.index;
    if (asked.index - BRACE_ENTRY_MEASURED < BRACE_MEASURED_COUNT) {
        return BRACE_REFUSED_READ_ONLY;
    }
    const brace_status_t status = staging_write(app, asked.index, asked.value);
    if (status != BRACE_OK) {
        return status == BRACE_E_UNSUPPORTED ? (int32_t)BRACE_REFUSED_BUSY : (int32_t)status;
    }
    (void)brace_can_pack_write_entry_answer_0(
        &(brace_can_write_entry_answer_0_t){request->token, asked.index, staging_read(app, asked.index)},
        data);
    answer_put(app, data);
    return BRACE_OK;
}

int32_t request_set_mode(brace_app_t *app, request_t *request)
{
    brace_can_set_mode_request_t asked;
    uint8_t data[8];
    brace_can_unpack_set_mode_request(request->data, &asked);
    request->detail = app->mode;
    if (asked.key != KEY) {
        return BRACE_REFUSED_KEY;
    }
    brace_status_t status = BRACE_OK;
    if (asked.mode == BRACE_MODE_CONFIGURATION && app->mode != BRACE_MODE_CONFIGURATION) {
        status = brace_app_configuration_enter(app);
    } else if (asked.mode == BRACE_MODE_MONITOR && app->mode == BRACE_MODE_CONFIGURATION) {
        if (storing_busy(app)) {
            return BRACE_REFUSED_BUSY;
        }
        status = brace_app_configuration_leave(app);
    } else if (asked.mode != (uint32_t)app->mode) {
        return asked.mode == BRACE_MODE_MONITOR ? (int32_t)BRACE_E_MODE : (int32_t)BRACE_E_RANGE;
    }
    staging_keep(app);
    if (status != BRACE_OK) {
        return status;
    }
    (void)brace_can_pack_set_mode_answer_0(&(brace_can_set_mode_answer_0_t){request->token, app->mode}, data);
    answer_put(app, data);
    return BRACE_OK;
}

/* -------------------------------------------------------------------------------------- upload -- */

/* May parameters be changed now? */
static int32_t open_for_change(brace_app_t *app, request_t *request)
{
    const brace_status_t status = staging_open(app);
    request->detail = app->mode;
    return status == BRACE_E_UNSUPPORTED ? (int32_t)BRACE_REFUSED_BUSY : (int32_t)status;
}

int32_t request_upload_begin(brace_app_t *app, request_t *request)
{
    brace_app_requests_t *requests = &app->requests;
    brace_can_upload_begin_request_t asked;
    uint8_t data[8];
    brace_can_unpack_upload_begin_request(request->data, &asked);
    const int32_t status = open_for_change(app, request);
    if (status != BRACE_OK) {
        return status;
    }
    if (asked.bytes != BRACE_BLOCK_BYTES) {
        request->detail = BRACE_BLOCK_BYTES;
        return BRACE_E_LENGTH;
    }
    requests->upload_open = true;
    requests->upload_next = 0;
    requests->upload_crc = asked.crc;
    (void)brace_can_pack_upload_begin_answer_0(
        &(brace_can_upload_begin_answer_0_t){request->token, BLOCK_WORDS}, data);
    answer_put(app, data);
    return BRACE_OK;
}

/* Words come in order; the last one may come again, changed or not: its answer may have been lost. */
int32_t request_upload_word(brace_app_t *app, request_t *request)
{
    brace_app_requests_t *requests = &app->requests;
    brace_can_upload_word_request_t asked;
    uint8_t data[8];
    brace_can_unpack_upload_word_request(request->data, &asked);
    const int32_t status = open_for_change(app, request);
    if (status != BRACE_OK) {
        return status;
    }
    const bool again = asked.word + 1u == requests->upload_next;
    request->detail = requests->upload_open ? requests->upload_next : 0u;
    if (!requests->upload_open || asked.word >= BLOCK_WORDS ||
        (asked.word != requests->upload_next && !again)) {
        return BRACE_REFUSED_ORDER;
    }
    uint8_t *place = &requests->upload[4u * asked.word];
    if (!again) { /* the word before stays as it is now */
        requests->upload_sum = asked.word == 0u ? 0u : brace_crc32(requests->upload_sum, place - 4, 4);
    }
    for (uint32_t i = 0; i < 4u; i++) {
        place[i] = (uint8_t)(asked.data >> (8u * i));
    }
    requests->upload_next = asked.word + 1u;
    (void)brace_can_pack_upload_word_answer_0(
        &(brace_can_upload_word_answer_0_t){request->token, asked.word, asked.data}, data);
    answer_put(app, data);
    return BRACE_OK;
}

static uint32_t word_at(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

/* An uploaded block that is whole, what was announced and of our dictionary is stored; its values are judged by the
 * store, on the way. What was staged stays so until then. */
static int32_t store_upload(brace_app_t *app, request_t *request, uint32_t crc)
{
    brace_block_header_t header;
    brace_parameters_t set;
    brace_app_requests_t *requests = &app->requests;
    request->detail = requests->upload_open ? requests->upload_next : 0u;
    if (!requests->upload_open || requests->upload_next != BLOCK_WORDS) {
        return BRACE_REFUSED_ORDER;
    }
    requests->upload_open = false; /* whatever comes of it: it was committed */
    request->detail = word_at(&requests->upload[BRACE_BLOCK_BYTES - 4]);
    if (crc != requests->upload_crc || crc != request->detail) {
        return BRACE_E_CHECKSUM;
    }
    request->detail = BRACE_SCHEMA_HASH;
    const brace_status_t status = brace_block_header(requests->upload, BRACE_BLOCK_BYTES, &header);
    if (status != BRACE_OK) {
        return status;
    }
    if (header.block_bytes != BRACE_BLOCK_BYTES) {
        return BRACE_E_LENGTH;
    }
    if (crc != requests->upload_sum) {
        return BRACE_E_CHECKSUM;
    }
    if (header.schema_hash != BRACE_SCHEMA_HASH) {
        return BRACE_E_SCHEMA;
    }
    brace_block_members(requests->upload, &set);
    return storing_commit(app, &set);
}

/* The end of it is answered by request_storing_answer. */
static int32_t begun(brace_app_t *app, const request_t *request, int32_t status)
{
    if (status == BRACE_OK) {
        app->requests.storing = (uint8_t)request->code;
        app->requests.storing_token = (uint8_t)request->token;
    }
    return status;
}

int32_t request_commit(brace_app_t *app, request_t *request)
{
    brace_can_commit_request_t asked;
    brace_can_unpack_commit_request(request->data, &asked);
    const int32_t status = open_for_change(app, request);
    if (status != BRACE_OK) {
        return status;
    }
    return begun(app, request, asked.crc != 0u ? store_upload(app, request, asked.crc)
                                               : (int32_t)staging_commit(app, &request->detail));
}

int32_t request_rollback(brace_app_t *app, request_t *request)
{
    const int32_t status = open_for_change(app, request);
    return status != BRACE_OK ? status : begun(app, request, brace_app_parameters_rollback(app));
}

void request_storing_answer(brace_app_t *app)
{
    brace_app_requests_t *requests = &app->requests;
    brace_store_status_t store;
    uint8_t data[8];
    if (storing_busy(app)) {
        return;
    }
    const uint32_t code = requests->storing, token = requests->storing_token;
    requests->storing = 0;
    brace_store_status(&app->store, &store);
    if (store.state == BRACE_STORE_FAILED && store.failure == BRACE_STORE_E_REFUSED) {
        answer_refusal(app, code, token, store.refusal, store.wrong_index);
        return;
    }
    if (store.state == BRACE_STORE_FAILED) {
        answer_refusal(app, code, token, BRACE_REFUSED_STORE + (int32_t)store.failure, 0);
        return;
    }
    (void)brace_can_pack_commit_answer_0(&(brace_can_commit_answer_0_t){token, store.sequence}, data);
    data[0] = (uint8_t)code;
    answer_put(app, data);
    (void)brace_can_pack_commit_answer_1(&(brace_can_commit_answer_1_t){token, app->parameter_crc}, data);
    data[0] = (uint8_t)(code + BRACE_ANSWER_PART);
    answer_put(app, data);
}

/* ------------------------------------------------------------------------------------ download -- */

/* A word of the block as brace_parameters_pack would write it; its CRC is kept as the words go out. */
static uint32_t block_word(const brace_app_t *app, uint32_t word)
{
    brace_store_status_t store;
    uint32_t member;
    switch (word) {
    case 0: return word_at((const uint8_t *)"BRCE");
    case 1: return BRACE_BLOCK_FORMAT | (uint32_t)BRACE_BLOCK_HEADER_BYTES << 16;
    case 2: return BRACE_SCHEMA_HASH;
    case 3: return 4u * MEMBER_WORDS;
    case 4:
        brace_store_status(&app->store, &store);
        return store.sequence;
    default: break;
    }
    if (word == BLOCK_WORDS - 1u) {
        return app->requests.download_crc;
    }
    memcpy(&member, (const uint8_t *)&app->parameters + 4u * (word - HEADER_WORDS), sizeof member);
    return member;
}

/* Words in order, the last one again if its answer was lost. */
static int32_t download_next(brace_app_t *app, request_t *request, uint32_t word, uint32_t *data)
{
    brace_app_requests_t *requests = &app->requests;
    if (word == 0u) {
        requests->download_next = 0;
        requests->download_crc = 0;
        requests->download_set = app->parameter_crc;
    }
    request->detail = requests->download_next;
    if (word >= BLOCK_WORDS || (word != requests->download_next && word + 1u != requests->download_next)) {
        return BRACE_REFUSED_ORDER;
    }
    if (requests->download_set != app->parameter_crc) {
        requests->download_next = 0;
        return BRACE_REFUSED_CHANGED;
    }
    *data = block_word(app, word);
    if (word == requests->download_next && word < BLOCK_WORDS - 1u) {
        const uint8_t bytes[4] = {(uint8_t)*data, (uint8_t)(*data >> 8), (uint8_t)(*data >> 16),
                                  (uint8_t)(*data >> 24)};
        requests->download_crc = brace_crc32(requests->download_crc, bytes, 4);
    }
    requests->download_next = word + 1u;
    return BRACE_OK;
}

int32_t request_download_word(brace_app_t *app, request_t *request)
{
    brace_can_download_word_request_t asked;
    uint8_t data[8];
    brace_can_unpack_download_word_request(request->data, &asked);
    uint32_t word = BRACE_BLOCK_BYTES | (uint32_t)app->origin << 16;
    if (storing_busy(app)) {
        return BRACE_REFUSED_BUSY;
    }
    const int32_t status =
        asked.word == SIZE_OF_BLOCK ? (int32_t)BRACE_OK : download_next(app, request, asked.word, &word);
    if (status != BRACE_OK) {
        return status;
    }
    (void)brace_can_pack_download_word_answer_0(
        &(brace_can_download_word_answer_0_t){request->token, asked.word, word}, data);
    answer_put(app, data);
    return BRACE_OK;
}
