/* A parameter block word by word: uploaded, stored, downloaded. */
#include <stddef.h>

#include "brace/words.h"
#include "wire/answers/answer.h"
#include "wire/measured.h"

#define SIZE_OF_BLOCK 0xffffu /* a word's number that asks for it */

enum {
    WORD_BYTES = 4,
    BLOCK_WORDS = BRACE_BLOCK_BYTES / WORD_BYTES,
    HEADER_WORDS = BRACE_BLOCK_HEADER_BYTES / WORD_BYTES
};
_Static_assert(BRACE_BLOCK_BYTES % WORD_BYTES == 0, "a block is whole words");

/* May parameters be written now? */
static int32_t may_write(request_t *request)
{
    const brace_status_t status = brace_app_may_write(request->app);
    request->detail = brace_app_mode(request->app);
    return status == BRACE_E_UNSUPPORTED ? (int32_t)BRACE_REFUSED_BUSY : (int32_t)status;
}

/* ------------------------------------------------------------------------------------------ upload -- */

int32_t answer_upload_begin(request_t *request, const brace_upload_begin_request_t *asked,
                            brace_upload_begin_answer_t *answer)
{
    upload_t *upload = request->upload;
    const int32_t status = may_write(request);
    if (status != BRACE_OK) {
        return status;
    }
    if (asked->bytes != BRACE_BLOCK_BYTES) {
        request->detail = BRACE_BLOCK_BYTES;
        return BRACE_E_LENGTH;
    }
    upload->is_open = true;
    upload->next = 0;
    upload->crc = asked->crc;
    answer->words = BLOCK_WORDS;
    answer->setting = brace_app_setting(request->app);
    return BRACE_OK;
}

/* Words come in order. The last one may come again, changed or not, because its answer may have been lost; so the CRC
 * leaves it out until the next one comes. */
int32_t answer_upload_word(request_t *request, const brace_upload_word_request_t *asked,
                           brace_upload_word_answer_t *answer)
{
    upload_t *upload = request->upload;
    const int32_t status = may_write(request);
    if (status != BRACE_OK) {
        return status;
    }
    const bool comes_again = asked->word + 1u == upload->next;
    request->detail = upload->is_open ? upload->next : 0u;
    if (!upload->is_open || asked->word >= BLOCK_WORDS || (asked->word != upload->next && !comes_again)) {
        return BRACE_REFUSED_ORDER;
    }
    uint8_t *place = &upload->block[WORD_BYTES * asked->word];
    if (!comes_again) { /* the word before stays as it is now */
        upload->sum = asked->word == 0u ? 0u : brace_crc32(upload->sum, place - WORD_BYTES, WORD_BYTES);
    }
    brace_put_u32(place, asked->data);
    upload->next = asked->word + 1u;
    *answer = (brace_upload_word_answer_t){asked->word, asked->data};
    return BRACE_OK;
}

/* ----------------------------------------------------------------------------------------- storing -- */

/* Does the board allow this set? */
static int32_t within_board(request_t *request, const brace_parameters_t *set)
{
    const uint32_t beyond = brace_app_beyond_board(request->app, set);
    if (beyond == BRACE_PARAMETER_COUNT) {
        return BRACE_OK;
    }
    request->detail = brace_parameter_number(beyond);
    return BRACE_REFUSED_CEILING;
}

/* Begins to store an uploaded block that is whole, is what was announced and is of our dictionary. Its values are
 * judged by the store, on the way. */
static int32_t store_upload(request_t *request, uint32_t crc)
{
    brace_block_header_t header;
    brace_parameters_t set;
    upload_t *upload = request->upload;
    request->detail = upload->is_open ? upload->next : 0u;
    if (!upload->is_open || upload->next != BLOCK_WORDS) {
        return BRACE_REFUSED_ORDER;
    }
    upload->is_open = false; /* it was committed, whatever comes of it */
    request->detail = brace_get_u32(&upload->block[BRACE_BLOCK_BYTES - WORD_BYTES]);
    if (crc != upload->crc || crc != request->detail) {
        return BRACE_E_CHECKSUM;
    }
    request->detail = BRACE_SCHEMA_HASH;
    const brace_status_t status = brace_block_header(upload->block, BRACE_BLOCK_BYTES, &header);
    if (status != BRACE_OK) {
        return status;
    }
    if (header.block_bytes != BRACE_BLOCK_BYTES) {
        return BRACE_E_LENGTH;
    }
    if (crc != upload->sum) {
        return BRACE_E_CHECKSUM;
    }
    if (header.schema_hash != BRACE_SCHEMA_HASH) {
        return BRACE_E_SCHEMA;
    }
    brace_block_members(upload->block, &set);
    const int32_t within = within_board(request, &set);
    return within == BRACE_OK ? (int32_t)brace_app_parameters_commit(request->app, &set) : within;
}

/* Begins to store the entries that were written one by one. A refusal reports the number of the one at fault.
 *   crc: brace_parameters_crc of the whole set; 0: not sent */
static int32_t store_staged(request_t *request, uint32_t crc)
{
    brace_app_t *app = request->app;
    uint32_t wrong_index = 0;
    const int32_t within = within_board(request, brace_app_parameters_staged(app));
    if (within != BRACE_OK) {
        return within;
    }
    if (crc == 0u && brace_app_setting(app) != BRACE_SETTING_BENCH) {
        return BRACE_E_CHECKSUM; /* only by hand, on a bench, a set need not be named */
    }
    const brace_status_t status = crc == 0u ? brace_app_parameters_commit_staged(app, &wrong_index)
                                            : brace_app_parameters_commit_named(app, crc, &wrong_index);
    if (status == BRACE_E_PARAMETER || status == BRACE_E_NOT_FINITE) {
        request->detail = brace_parameter_number(wrong_index);
    }
    return status;
}

/* What has begun is answered when it has ended; a refusal is answered at once. */
static int32_t later(int32_t status)
{
    return status == BRACE_OK ? ANSWER_LATER : status;
}

int32_t answer_commit(request_t *request, const brace_commit_request_t *asked, brace_commit_answer_t *answer)
{
    (void)answer;
    const int32_t status = may_write(request);
    if (status != BRACE_OK) {
        return status;
    }
    uint32_t wait_ms = 0;
    const int32_t early = brace_app_may_commit(request->app, &wait_ms);
    if (early != BRACE_OK) {
        request->detail = wait_ms;
        return early;
    }
    const upload_t *upload = request->upload;
    const bool is_staged = upload == NULL || (!upload->is_open && brace_app_has_staged(request->app));
    return later(asked->crc == 0u || is_staged ? store_staged(request, asked->crc) : store_upload(request, asked->crc));
}

int32_t answer_rollback(request_t *request, const brace_rollback_request_t *asked, brace_rollback_answer_t *answer)
{
    (void)asked;
    (void)answer;
    const int32_t status = may_write(request);
    return status != BRACE_OK ? status : later(brace_app_parameters_rollback(request->app));
}

int32_t answer_of_storing(request_t *request, brace_commit_answer_t *answer)
{
    brace_store_status_t store;
    (void)brace_app_store_status(request->app, &store);
    if (store.state != BRACE_STORE_FAILED) {
        *answer = (brace_commit_answer_t){store.sequence, brace_app_snapshot(request->app)->parameter_crc,
                                          brace_app_setting(request->app)};
        return BRACE_OK;
    }
    if (store.failure != BRACE_STORE_E_REFUSED) {
        return (int32_t)BRACE_REFUSED_STORE + (int32_t)store.failure;
    }
    request->detail = brace_parameter_number(store.wrong_index);
    return store.refusal;
}

void upload_tick(upload_t *upload, const brace_app_t *app)
{
    upload->is_open = upload->is_open && brace_app_mode(app) == BRACE_MODE_CONFIGURATION;
}

/* ---------------------------------------------------------------------------------------- download -- */

/* A word of the block as brace_parameters_pack would write it. */
static uint32_t block_word(const request_t *request, uint32_t word)
{
    const brace_app_t *app = request->app;
    switch (word) {
    case 0: return brace_get_u32((const uint8_t *)"BRCE");
    case 1: return BRACE_BLOCK_FORMAT | (uint32_t)BRACE_BLOCK_HEADER_BYTES << 16;
    case 2: return BRACE_SCHEMA_HASH;
    case 3: return WORD_BYTES * BRACE_PARAMETER_COUNT;
    case 4: return brace_app_snapshot(app)->parameter_sequence;
    case BLOCK_WORDS - 1: return request->download->sum;
    default: return parameter_member(brace_app_parameters(app), word - HEADER_WORDS);
    }
}

/* Words in order; the last one again if its answer was lost. */
static int32_t download_next(request_t *request, uint32_t word, uint32_t *data)
{
    download_t *download = request->download;
    const uint32_t set = brace_app_snapshot(request->app)->parameter_crc;
    if (word == 0u) {
        download->next = 0;
        download->sum = 0;
        download->set = set;
    }
    request->detail = download->next;
    if (word >= BLOCK_WORDS || (word != download->next && word + 1u != download->next)) {
        return BRACE_REFUSED_ORDER;
    }
    if (download->set != set) {
        download->next = 0;
        return BRACE_REFUSED_CHANGED;
    }
    *data = block_word(request, word);
    if (word == download->next && word < BLOCK_WORDS - 1u) {
        uint8_t bytes[WORD_BYTES];
        brace_put_u32(bytes, *data);
        download->sum = brace_crc32(download->sum, bytes, WORD_BYTES);
    }
    download->next = word + 1u;
    return BRACE_OK;
}

int32_t answer_download_word(request_t *request, const brace_download_word_request_t *asked,
                             brace_download_word_answer_t *answer)
{
    const brace_app_t *app = request->app;
    uint32_t data = BRACE_BLOCK_BYTES | (uint32_t)brace_app_snapshot(app)->parameter_origin << 16;
    if (brace_app_is_storing(app)) {
        return BRACE_REFUSED_BUSY;
    }
    const int32_t status =
        asked->word == SIZE_OF_BLOCK ? (int32_t)BRACE_OK : download_next(request, asked->word, &data);
    if (status == BRACE_OK) {
        *answer = (brace_download_word_answer_t){asked->word, data};
    }
    return status;
}
