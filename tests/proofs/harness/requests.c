/* Any 8 bytes that come as a request, whatever the controller's state. What a request asks of the rest of the
 * controller may answer anything that its header allows, and notes that it was asked. */
#include "brace/measured.h"
#include "can/request.h"
#include "can/requests.h"
#include "answers.h"
#include "proof.h"
#include "report/measured.h"

#include "can/requests.c"

/* What was done, besides answering. */
enum { MOVES = 1, CONFIGURES = 2, LEAVES = 4, STAGES = 8, STORES = 16, ROLLS_BACK = 32, CLEARS = 64, TESTS = 128,
       FEEDS = 256 };
static uint32_t done;

static brace_status_t asked_for(uint32_t what)
{
    done |= what;
    return any_status();
}

/* ------------------------------------------------------------------------- what changes the controller -- */

brace_status_t brace_app_take_up(brace_app_t *app, int32_t joint, int32_t flank)
{
    (void)app;
    (void)flank;
    const brace_status_t status = asked_for(MOVES);
    ASSUME(status != BRACE_OK || joint == BRACE_FEMUR || joint == BRACE_TIBIA);
    return status;
}

brace_status_t brace_app_let_go(brace_app_t *app) { (void)app; return asked_for(MOVES); }
brace_status_t brace_app_loading_start(brace_app_t *app, const brace_loading_setup_t *setup)
{
    (void)app;
    (void)setup;
    return asked_for(TESTS);
}
brace_status_t brace_app_loading_stop(brace_app_t *app) { (void)app; return asked_for(TESTS); }
brace_status_t brace_app_configuration_enter(brace_app_t *app) { (void)app; return asked_for(CONFIGURES); }
brace_status_t brace_app_configuration_leave(brace_app_t *app) { (void)app; return asked_for(LEAVES); }
brace_status_t brace_app_parameters_rollback(brace_app_t *app) { (void)app; return asked_for(ROLLS_BACK); }
brace_status_t brace_app_clear(brace_app_t *app, uint32_t faults) { (void)app; (void)faults; return asked_for(CLEARS); }
brace_status_t staging_commit(brace_app_t *app, uint32_t *wrong_index)
{
    (void)app;
    (void)wrong_index;
    return asked_for(STORES);
}
brace_status_t storing_commit(brace_app_t *app, const brace_parameters_t *set)
{
    (void)app;
    (void)set;
    return asked_for(STORES);
}
void staging_keep(brace_app_t *app) { (void)app; done |= FEEDS; }

static bool open_for_writing;

brace_status_t staging_open(brace_app_t *app)
{
    (void)app;
    done |= FEEDS;
    return open_for_writing ? BRACE_OK : any_bool() ? BRACE_E_MODE : BRACE_E_UNSUPPORTED;
}

brace_status_t staging_write(brace_app_t *app, uint32_t index, uint32_t word)
{
    (void)app;
    (void)word;
    const brace_status_t status = asked_for(STAGES);
    ASSUME(status != BRACE_OK || (index < BRACE_PARAMETER_COUNT && open_for_writing));
    return status;
}

/* ----------------------------------------------------------------------- what only tells (else: answers.h) -- */

static brace_loading_result_t result;
const brace_loading_result_t *brace_app_loading_result(const brace_app_t *app) { (void)app; return &result; }
uint32_t brace_app_row_count(const brace_app_t *app) { (void)app; return any_u32(); }
brace_status_t brace_app_row(const brace_app_t *app, uint32_t index, brace_row_t *row)
{
    (void)app;
    (void)index;
    brace_row_t any;
    *row = any;
    return any_status();
}

brace_status_t brace_row_value(const brace_row_t *row, uint32_t column, float *value)
{
    (void)row;
    (void)column;
    *value = any_float();
    return any_status();
}

void brace_measured_take(const brace_app_t *app, uint32_t now_us, brace_measured_t *measured)
{
    (void)app;
    (void)now_us;
    brace_measured_t any;
    *measured = any;
}

brace_status_t measured_entry(const brace_measured_t *measured, uint32_t entry, uint32_t *value)
{
    (void)measured;
    if (entry - BRACE_ENTRY_MEASURED >= BRACE_MEASURED_COUNT) {
        return BRACE_E_RANGE;
    }
    *value = any_u32();
    return BRACE_OK;
}

uint32_t brace_crc32(uint32_t crc, const uint8_t *bytes, uint32_t count)
{
    (void)crc;
    PROVE(__CPROVER_r_ok(bytes, count), "the CRC is of bytes that are there");
    return any_u32();
}

brace_status_t brace_block_header(const uint8_t *block, uint32_t length, brace_block_header_t *header)
{
    PROVE(__CPROVER_r_ok(block, length) && length == BRACE_BLOCK_BYTES, "a whole block");
    brace_block_header_t any;
    *header = any;
    return any_status();
}

void brace_block_members(const uint8_t *block, brace_parameters_t *parameters)
{
    PROVE(__CPROVER_r_ok(block, BRACE_BLOCK_BYTES), "a whole block");
    brace_parameters_t any;
    *parameters = any;
}

/* A frame begins with code and part, then the token (the dictionary's tests);
 * the rest is any (codec_numbers, codec_whole). */
#define PACKS(frame, head)                                                                                             \
    uint32_t brace_can_pack_##frame(const brace_can_##frame##_t *message, uint8_t data[8])                             \
    {                                                                                                                  \
        uint8_t any[8];                                                                                                \
        memcpy(data, any, 8);                                                                                          \
        data[0] = (uint8_t)(head);                                                                                     \
        data[1] = (uint8_t)message->token;                                                                             \
        return any_u8();                                                                                               \
    }
PACKS(read_entry_answer_0, BRACE_REQUEST_READ_ENTRY)
PACKS(write_entry_answer_0, BRACE_REQUEST_WRITE_ENTRY)
PACKS(k_at_posture_answer_0, BRACE_REQUEST_K_AT_POSTURE)
PACKS(k_at_posture_answer_1, BRACE_REQUEST_K_AT_POSTURE + BRACE_ANSWER_PART)
PACKS(k_at_posture_answer_2, BRACE_REQUEST_K_AT_POSTURE + 2 * BRACE_ANSWER_PART)
PACKS(contact_force_answer_0, BRACE_REQUEST_CONTACT_FORCE)
PACKS(contact_force_answer_1, BRACE_REQUEST_CONTACT_FORCE + BRACE_ANSWER_PART)
PACKS(sag_for_load_answer_0, BRACE_REQUEST_SAG_FOR_LOAD)
PACKS(friction_margin_answer_0, BRACE_REQUEST_FRICTION_MARGIN)
PACKS(set_mode_answer_0, BRACE_REQUEST_SET_MODE)
PACKS(upload_begin_answer_0, BRACE_REQUEST_UPLOAD_BEGIN)
PACKS(upload_word_answer_0, BRACE_REQUEST_UPLOAD_WORD)
PACKS(commit_answer_0, BRACE_REQUEST_COMMIT)
PACKS(commit_answer_1, BRACE_REQUEST_COMMIT + BRACE_ANSWER_PART)
PACKS(download_word_answer_0, BRACE_REQUEST_DOWNLOAD_WORD)
PACKS(take_up_answer_0, BRACE_REQUEST_TAKE_UP)
PACKS(let_go_answer_0, BRACE_REQUEST_LET_GO)
PACKS(loading_test_start_answer_0, BRACE_REQUEST_LOADING_TEST_START)
PACKS(loading_test_stop_answer_0, BRACE_REQUEST_LOADING_TEST_STOP)
PACKS(fetch_row_answer_0, BRACE_REQUEST_FETCH_ROW)
PACKS(identify_answer_0, BRACE_REQUEST_IDENTIFY)
PACKS(identify_answer_1, BRACE_REQUEST_IDENTIFY + BRACE_ANSWER_PART)
PACKS(identify_answer_2, BRACE_REQUEST_IDENTIFY + 2 * BRACE_ANSWER_PART)
PACKS(identify_answer_3, BRACE_REQUEST_IDENTIFY + 3 * BRACE_ANSWER_PART)
PACKS(loading_test_result_answer_0, BRACE_REQUEST_LOADING_TEST_RESULT)
PACKS(clear_answer_0, BRACE_REQUEST_CLEAR)
PACKS(refusal, 7 * BRACE_ANSWER_PART)

/* What of the bus is not under proof here. */
bool bus_receive(brace_app_t *app, brace_can_frame_t *frame) { (void)app; (void)frame; return false; }
bool slcan_port_receive(brace_app_t *app, brace_can_frame_t *frame) { (void)app; (void)frame; return false; }
uint32_t bus_send_some(brace_app_t *app, uint32_t function, const uint8_t (*data)[8], uint32_t count)
{
    (void)app;
    (void)function;
    (void)data;
    (void)count;
    return 0;
}

static uint32_t any_clock(void *context)
{
    (void)context;
    return any_u32();
}

/* -------------------------------------------------------------------------------------------- the claims -- */

/* All that a request of this kind may do. */
static uint32_t allowed(const uint8_t *request)
{
    const uint32_t key = (uint32_t)request[3] | (uint32_t)request[4] << 8, mode = request[2];
    switch (request[0]) {
    case BRACE_REQUEST_WRITE_ENTRY: return STAGES;
    case BRACE_REQUEST_SET_MODE:
        return key != 0xc0deu ? 0u
                              : FEEDS | (mode == BRACE_MODE_CONFIGURATION ? CONFIGURES
                                         : mode == BRACE_MODE_MONITOR     ? LEAVES
                                                                          : 0u);
    case BRACE_REQUEST_UPLOAD_BEGIN:
    case BRACE_REQUEST_UPLOAD_WORD: return FEEDS;
    case BRACE_REQUEST_COMMIT: return FEEDS | (open_for_writing ? STORES : 0u);
    case BRACE_REQUEST_ROLLBACK: return FEEDS | (open_for_writing ? ROLLS_BACK : 0u);
    case BRACE_REQUEST_TAKE_UP:
    case BRACE_REQUEST_LET_GO: return MOVES;
    case BRACE_REQUEST_LOADING_TEST_START:
    case BRACE_REQUEST_LOADING_TEST_STOP: return TESTS;
    case BRACE_REQUEST_CLEAR: return CLEARS;
    default: return 0;
    }
}

static void answers_are_of(const brace_app_requests_t *requests, const uint8_t *request, uint32_t before, bool later)
{
    const uint32_t count = requests->answer_count - before, which = any_u32();
    PROVE(requests->answer_count >= before && count <= PARTS_MOST && requests->answer_count <= BRACE_APP_ANSWERS,
          "as many parts as there is room for");
    PROVE(later ? count == 0u : count >= 1u, "an answer or a refusal, at once; or later, when it is stored");
    ASSUME(which < count); /* any part, so all */
    const uint8_t *part = requests->answer[(requests->answer_first + before + which) % BRACE_APP_ANSWERS];
    PROVE((part[0] & 31u) == request[0] && part[1] == request[1], "with the request's code and token");
    PROVE(part[0] >> 5 == which || (part[0] >> 5 == 7u && count == 1u), "its parts in order, or one refusal");
}

int main(void)
{
    brace_app_t app; /* of any content */
    const brace_hal_t door = {.now_us = any_clock};
    app.hal = &door;
    brace_app_requests_t *requests = &app.requests;
    const uint32_t at = any_u32();
    ASSUME(*(const uint8_t *)&requests->upload_open <= 1u && *(const uint8_t *)&requests->refuses <= 1u);
    ASSUME(requests->request[0] < BRACE_ANSWER_PART); /* else it is not taken for one */
    ASSUME(requests->answer_first < BRACE_APP_ANSWERS && requests->answer_count + PARTS_MOST <= BRACE_APP_ANSWERS);
    ASSUME(requests->upload_next <= BRACE_BLOCK_BYTES / 4 && requests->download_next <= BRACE_BLOCK_BYTES / 4);
    ASSUME(requests->storing == 0u); /* what was stored before is answered before: services_run */
    ASSUME(at < BRACE_BLOCK_BYTES);
    open_for_writing = any_bool();
    const uint32_t count = requests->answer_count;
    uint8_t request[8];
    memcpy(request, requests->request, 8);
    const brace_app_requests_t before = *requests;
    const brace_mode_t mode = app.mode;
    const uint32_t faults = app.faults, crc = app.parameter_crc;

    requests_serve(&app);

    const uint32_t code = request[0];
    const bool stores = requests->storing != 0u;
    answers_are_of(requests, request, count, stores);
    PROVE((done & ~allowed(request)) == 0u, "nothing is done but what the request names");
    PROVE(app.mode == mode && app.faults == faults && app.parameter_crc == crc,
          "nor is anything changed behind its back");
    PROVE(!stores || (requests->storing == code && requests->storing_token == request[1]),
          "what is stored is answered to who asked");
    PROVE(requests->upload_next <= BRACE_BLOCK_BYTES / 4 && requests->download_next <= BRACE_BLOCK_BYTES / 4,
          "words within the block");
    const bool uploads =
        code == BRACE_REQUEST_UPLOAD_BEGIN || code == BRACE_REQUEST_UPLOAD_WORD || code == BRACE_REQUEST_COMMIT;
    PROVE(uploads || (requests->upload_open == before.upload_open && requests->upload_next == before.upload_next &&
                      requests->upload_sum == before.upload_sum && requests->upload_crc == before.upload_crc),
          "an upload is left alone");
    PROVE(code == BRACE_REQUEST_UPLOAD_WORD || requests->upload[at] == before.upload[at], "and so are its words");
    PROVE(code == BRACE_REQUEST_DOWNLOAD_WORD ||
              (requests->download_next == before.download_next && requests->download_crc == before.download_crc &&
               requests->download_set == before.download_set),
          "a download is left alone");
    return 0;
}
