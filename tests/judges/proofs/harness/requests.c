/* Any 8 bytes that come as a request, whatever the port's state. What a request asks of the controller may answer
 * anything that brace/requests.h allows, and notes that it was asked. */
#include "proof.h"
#include "wire/can/requests.h"
#include "wire/measured.h"

/* What was done, besides answering. */
enum {
    MOVES = 1,
    CONFIGURES = 2,
    LEAVES = 4,
    STAGES = 8,
    STORES = 16,
    ROLLS_BACK = 32,
    CLEARS = 64,
    TESTS = 128,
    FEEDS = 256,
    STOPS = 512
};
static uint32_t done;
static bool open_for_writing;
static bool is_admitted; /* whoever asks may command it */

static brace_status_t any_status(void)
{
    const int32_t status = any_i32();
    ASSUME(status <= 0 && status >= BRACE_E_MODE);
    return (brace_status_t)status;
}

static brace_status_t asked_for(uint32_t what)
{
    done |= what;
    return any_status();
}

/* ------------------------------------------------------------------------------------------ who may -- */

int32_t brace_app_may_command(brace_app_t *app, brace_command_t command, brace_who_t who, const brace_seal_t *seal,
                              const uint8_t *bytes, uint32_t count)
{
    (void)app;
    (void)who;
    (void)seal;
    PROVE(command != BRACE_COMMAND_NONE && __CPROVER_r_ok(bytes, count) && count == 8u, "a command, with its frame");
    const int32_t status = any_i32();
    ASSUME(status <= 0 && status >= BRACE_REFUSED_EARLY);
    is_admitted = status == BRACE_OK;
    return status;
}

int32_t brace_app_life(brace_app_t *app, brace_who_t who, const brace_sign_t *sign)
{
    (void)app;
    (void)who;
    PROVE(sign != NULL && (sign->heard_bits == 16u || sign->heard_bits == 32u),
          "a sign of life has a number, or half of one");
    const int32_t status = any_i32();
    ASSUME(status <= 0 && status >= BRACE_REFUSED_EARLY);
    return status;
}

brace_setting_t brace_app_setting(const brace_app_t *app)
{
    (void)app;
    return (brace_setting_t)any_u32();
}
brace_status_t brace_app_stop(brace_app_t *app)
{
    (void)app;
    return asked_for(STOPS);
}
bool brace_app_has_staged(const brace_app_t *app)
{
    (void)app;
    return any_bool();
}

int32_t brace_app_may_commit(brace_app_t *app, uint32_t *wait_ms)
{
    (void)app;
    *wait_ms = any_u32();
    return any_bool() ? BRACE_OK : BRACE_REFUSED_EARLY;
}

uint32_t brace_app_beyond_board(const brace_app_t *app, const brace_parameters_t *set)
{
    (void)app;
    (void)set;
    const uint32_t index = any_u32();
    ASSUME(index <= BRACE_PARAMETER_COUNT);
    return index;
}

/* ------------------------------------------------------------------------- what changes the controller -- */

brace_status_t brace_app_take_up(brace_app_t *app, int32_t joint, int32_t flank)
{
    (void)app;
    (void)flank;
    const brace_status_t status = asked_for(MOVES);
    ASSUME(status != BRACE_OK || (joint >= BRACE_COXA && joint <= BRACE_TIBIA));
    return status;
}

brace_status_t brace_app_let_go(brace_app_t *app)
{
    (void)app;
    return asked_for(MOVES);
}
brace_status_t brace_app_loading_start(brace_app_t *app, const brace_loading_setup_t *setup)
{
    (void)app;
    (void)setup;
    return asked_for(TESTS);
}
brace_status_t brace_app_loading_stop(brace_app_t *app)
{
    (void)app;
    return asked_for(TESTS);
}
brace_status_t brace_app_configuration_enter(brace_app_t *app)
{
    (void)app;
    return asked_for(CONFIGURES);
}
brace_status_t brace_app_configuration_leave(brace_app_t *app)
{
    (void)app;
    return asked_for(LEAVES);
}
brace_status_t brace_app_parameters_rollback(brace_app_t *app)
{
    (void)app;
    return asked_for(ROLLS_BACK);
}
brace_status_t brace_app_clear(brace_app_t *app, uint32_t faults)
{
    (void)app;
    (void)faults;
    return asked_for(CLEARS);
}

brace_status_t brace_app_parameters_commit_staged(brace_app_t *app, uint32_t *wrong_index)
{
    (void)app;
    *wrong_index = any_u32();
    return asked_for(STORES);
}

brace_status_t brace_app_parameters_commit_named(brace_app_t *app, uint32_t crc, uint32_t *wrong_index)
{
    (void)app;
    (void)crc;
    *wrong_index = any_u32();
    return asked_for(STORES);
}

brace_status_t brace_app_parameters_commit(brace_app_t *app, const brace_parameters_t *parameters)
{
    (void)app;
    (void)parameters;
    return asked_for(STORES);
}

brace_status_t brace_app_may_write(brace_app_t *app)
{
    (void)app;
    done |= FEEDS;
    return open_for_writing ? BRACE_OK : any_bool() ? BRACE_E_MODE : BRACE_E_UNSUPPORTED;
}

brace_status_t brace_app_parameters_stage(brace_app_t *app, uint32_t first_number, uint32_t count,
                                          const uint32_t *words)
{
    (void)app;
    (void)first_number;
    PROVE(count == 1u && __CPROVER_r_ok(words, 4), "one member, and its word");
    const brace_status_t status = asked_for(STAGES);
    ASSUME(status != BRACE_OK || open_for_writing);
    return status;
}

/* ------------------------------------------------------------------------------------- what only informs -- */

static brace_snapshot_t snapshot;
const brace_snapshot_t *brace_app_snapshot(const brace_app_t *app)
{
    (void)app;
    return &snapshot;
}
static brace_parameters_t parameters;
const brace_parameters_t *brace_app_parameters(const brace_app_t *app)
{
    (void)app;
    return &parameters;
}
const brace_parameters_t *brace_app_parameters_staged(const brace_app_t *app)
{
    (void)app;
    return &parameters;
}
brace_mode_t brace_app_mode(const brace_app_t *app)
{
    (void)app;
    return (brace_mode_t)any_u32();
}
uint32_t brace_app_faults(const brace_app_t *app)
{
    (void)app;
    return any_u32();
}
bool brace_app_is_storing(const brace_app_t *app)
{
    (void)app;
    return any_bool();
}
bool brace_app_loading_is_returning(const brace_app_t *app)
{
    (void)app;
    return any_bool();
}
static brace_loading_result_t result;
const brace_loading_result_t *brace_app_loading_result(const brace_app_t *app)
{
    (void)app;
    return &result;
}
uint32_t brace_app_row_count(const brace_app_t *app)
{
    (void)app;
    return any_u32();
}

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

brace_status_t brace_app_store_status(const brace_app_t *app, brace_store_status_t *status)
{
    (void)app;
    brace_store_status_t any;
    *status = any;
    return BRACE_OK;
}

int32_t brace_app_ask_k(brace_app_t *app, brace_asker_t asker, const brace_k_question_t *question,
                        brace_k_answer_t *answer)
{
    (void)app;
    PROVE((uint32_t)asker < (uint32_t)BRACE_ASKER_COUNT, "an asker that there is");
    PROVE(question->where != BRACE_K_AT_TIP || question->knee == BRACE_KNEE_UP || question->knee == BRACE_KNEE_DOWN,
          "a knee that there is");
    brace_k_answer_t any;
    *answer = any;
    return any_bool() ? (int32_t)BRACE_APP_LATER : (int32_t)any_status();
}

brace_status_t brace_app_set_gravity(brace_app_t *app, float direction_rad, float lean_rad)
{
    (void)app;
    (void)direction_rad;
    (void)lean_rad;
    return any_status();
}

void brace_app_gravity(const brace_app_t *app, float *direction_rad, float *lean_rad)
{
    (void)app;
    *direction_rad = any_float();
    *lean_rad = any_float();
}

brace_status_t brace_app_contact_force(const brace_app_t *app, brace_displacement_t displacement,
                                       brace_contact_force_t *contact)
{
    (void)app;
    (void)displacement;
    brace_contact_force_t any;
    *contact = any;
    return any_status();
}

brace_status_t brace_app_sag(const brace_app_t *app, brace_force_t load, brace_displacement_t *sag)
{
    (void)app;
    (void)load;
    brace_displacement_t any;
    *sag = any;
    return any_status();
}

brace_status_t brace_app_grip(const brace_app_t *app, float normal_rad, float friction_ratio,
                              brace_contact_grip_t *grip)
{
    (void)app;
    (void)normal_rad;
    (void)friction_ratio;
    brace_contact_grip_t any;
    *grip = any;
    return any_status();
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

brace_status_t parameter_entry(const brace_parameters_t *of, uint32_t number, uint32_t *value)
{
    (void)of;
    (void)number;
    *value = any_u32();
    return any_bool() ? BRACE_OK : BRACE_E_RANGE;
}

uint32_t parameter_member(const brace_parameters_t *of, uint32_t index)
{
    (void)of;
    PROVE(index < BRACE_PARAMETER_COUNT, "a member that there is");
    return any_u32();
}

uint32_t brace_parameter_number(uint32_t index)
{
    (void)index;
    return any_u32();
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

void brace_block_members(const uint8_t *block, brace_parameters_t *set)
{
    PROVE(__CPROVER_r_ok(block, BRACE_BLOCK_BYTES), "a whole block");
    brace_parameters_t any;
    *set = any;
}

/* The fields of a request: any, but for those by which set_mode is judged. */
void brace_can_unpack_request(const uint8_t data[8], brace_request_t *asked)
{
    brace_request_t any;
    *asked = any;
    if (data[0] == BRACE_REQUEST_SET_MODE) {
        asked->set_mode.mode = data[2];
        asked->set_mode.key = (uint32_t)data[3] | (uint32_t)data[4] << 8;
    }
}

/* A frame begins with its number, then the token (the dictionary's tests); the rest is any (codec_numbers,
 * codec_whole). */
static uint8_t number_of(uint32_t code, uint32_t part)
{
    const uint32_t number = any_u8();
    ASSUME(brace_can_answer_frames[number].parts > 0u && brace_can_answer_frames[number].code == code &&
           brace_can_answer_frames[number].part == part);
    return (uint8_t)number;
}

void brace_can_pack_answer(uint32_t code, const brace_answer_t *answer, uint32_t token, uint8_t (*parts)[8])
{
    (void)answer;
    for (uint32_t i = 0; i < brace_can_answer_parts[code]; i++) { /* at most BRACE_CAN_ANSWER_PARTS_MOST */
        uint8_t any[8];
        memcpy(parts[i], any, 8);
        parts[i][0] = number_of(code, i);
        parts[i][1] = (uint8_t)token;
    }
}

/* -------------------------------------------------------------------------------------------- the claims -- */

/* All that a request of this kind may do. */
static uint32_t allowed(const uint8_t *request)
{
    const uint32_t key = (uint32_t)request[3] | (uint32_t)request[4] << 8, mode = request[2];
    switch (request[0]) {
    case BRACE_REQUEST_WRITE_ENTRY: return STAGES | STOPS | TESTS;
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
    case BRACE_REQUEST_LOADING_TEST_START: return TESTS;
    case BRACE_REQUEST_LOADING_TEST_STOP: return STOPS;
    case BRACE_REQUEST_CLEAR: return CLEARS;
    default: return 0;
    }
}

static void answers_are_of(const can_answers_t *answers, const uint8_t *request, uint32_t before, bool later)
{
    const uint32_t count = answers->count - before, which = any_u32();
    PROVE(answers->count >= before && count <= BRACE_CAN_ANSWER_PARTS_MOST && answers->count <= CAN_ANSWERS_ROOM,
          "as many parts as there is room for");
    PROVE(later ? count == 0u : count >= 1u, "an answer or a refusal, at once; or later, when it is stored");
    ASSUME(which < count); /* any part, so all */
    const uint8_t *part = answers->frame[(answers->first + before + which) % CAN_ANSWERS_ROOM];
    const brace_can_answer_frame_t *is = &brace_can_answer_frames[part[0]];
    const bool is_refusal = part[0] == BRACE_ANSWER_REFUSED;
    PROVE((is_refusal ? part[2] : is->code) == request[0] && part[1] == request[1],
          "with the request's code and token");
    PROVE(is_refusal ? count == 1u : is->parts > 0u && is->part == which, "its parts in order, or one refusal");
}

int main(void)
{
    done = 0;
    can_requests_t port; /* of any content, as all of these */
    brace_measured_t measured;
    uint8_t data[8], as_sent[8];
    wire_tick_t tick;
    tick.measured = &measured;
    const upload_t *upload = &port.upload;
    const download_t *download = &port.download[data[1] >> 4];
    const can_answers_t *answers = &port.answers;
    const uint32_t at = any_u32();
    ASSUME(*(const uint8_t *)&upload->is_open <= 1u);
    for (uint32_t i = 0; i < BRACE_SEALS_MOST; i++) {
        ASSUME(*(const uint8_t *)&port.seal[i].is_there <= 1u);
    }
    ASSUME(port.oldest_seal < BRACE_SEALS_MOST);
    ASSUME(answers->first < CAN_ANSWERS_ROOM && answers->count + BRACE_CAN_ANSWER_PARTS_MOST <= CAN_ANSWERS_ROOM);
    ASSUME(upload->next <= BRACE_BLOCK_BYTES / 4 && download->next <= BRACE_BLOCK_BYTES / 4);
    open_for_writing = any_bool();
    ASSUME(port.storing == 0u || !open_for_writing); /* while a set is being stored, parameters cannot be written */
    ASSUME(at < BRACE_BLOCK_BYTES);
    ANY(snapshot);
    ANY(parameters);
    ANY(result);
    const brace_asker_t asker = any_bool() ? BRACE_ASKER_CAN : BRACE_ASKER_SLCAN;
    const uint32_t count = answers->count;
    memcpy(as_sent, data, 8);
    const uint8_t storing_before = port.storing, token_before = port.storing_token;
    const upload_t kept = port.upload, *before = &kept;
    const download_t kept_download = *download, *before_download = &kept_download;

    const bool is_known = can_requests_answer(&port, &tick, asker, any_u8(), data);

    const uint32_t code = data[0];
    const bool stores = storing_before == 0u && port.storing != 0u;
    PROVE(same(data, as_sent, 8), "a request is not changed");
    PROVE(is_known || (done == 0u && answers->count == count + 1u), "an unknown request does nothing but be refused");
    PROVE((done & ~allowed(data)) == 0u, "nothing is done but what the request names");
    PROVE(is_admitted || (done & ~(uint32_t)STOPS) == 0u, "and nothing but stopping by whoever may not command");
    PROVE(!stores || (port.storing == code && port.storing_token == data[1]),
          "what is stored is answered to who asked");
    PROVE(storing_before == 0u || (port.storing == storing_before && port.storing_token == token_before),
          "nobody else is given the answer to what is being stored");
    PROVE(upload->next <= BRACE_BLOCK_BYTES / 4 && download->next <= BRACE_BLOCK_BYTES / 4, "words within the block");
    const bool uploads =
        code == BRACE_REQUEST_UPLOAD_BEGIN || code == BRACE_REQUEST_UPLOAD_WORD || code == BRACE_REQUEST_COMMIT;
    PROVE(uploads || (upload->is_open == before->is_open && upload->next == before->next &&
                      upload->sum == before->sum && upload->crc == before->crc),
          "an upload is left alone");
    PROVE(code == BRACE_REQUEST_UPLOAD_WORD || upload->block[at] == before->block[at], "and so are its words");
    PROVE(code == BRACE_REQUEST_DOWNLOAD_WORD ||
              (download->next == before_download->next && download->sum == before_download->sum &&
               download->set == before_download->set),
          "a download is left alone");
    answers_are_of(answers, data, count, stores || port.waits); /* the last, since it assumes that there is a part */
    return 0;
}
