/* One request on its way to its answer, whichever wire it came by.
 *
 * For each request of the dictionary there is a hand-written function answer_<name>. It does what the request asks for
 * and fills the whole answer. How fields travel is the wire's: CAN's frames and Modbus' registers are generated.
 *   asked: the request's fields
 *   answer (out): the fields of all the answer's parts; untouched unless BRACE_OK is returned
 * returns BRACE_OK; ANSWER_LATER: something was begun, and answer_of_storing reports how it ended; ANSWER_AGAIN: it is
 * being worked out, and the port puts the same request again in the next tick; or why not, as brace/refusals.h has it:
 * then nothing has changed. */
#ifndef BRACE_WIRE_ANSWERS_ANSWER_H
#define BRACE_WIRE_ANSWERS_ANSWER_H

#include <stdbool.h>
#include <stdint.h>

#include "brace/answering.h"
#include "brace/measured.h"
#include "brace/parameters.h"
#include "brace/refusals.h"
#include "brace/requests.h"

enum { ANSWER_LATER = 1, ANSWER_AGAIN = 2 };

/* A parameter block word by word, as somebody writes it by one port and has not ended. */
typedef struct {
    bool is_open;
    uint32_t next;    /* word that is expected; words before it have come [0, BRACE_BLOCK_BYTES / 4] */
    uint32_t crc;     /* the CRC that the block will end with, as it was announced */
    uint32_t sum;     /* CRC of all words but the last one that has come */
    uint8_t block[BRACE_BLOCK_BYTES];
} upload_t;

/* The same as one master reads it. */
typedef struct {
    uint32_t next;    /* word that is expected to be asked for [0, BRACE_BLOCK_BYTES / 4] */
    uint32_t sum;     /* CRC of the words before it */
    uint32_t set;     /* brace_parameters_crc of the set that they are of */
} download_t;

/* The force that the next question of K by the same master counts. Each kind of question has its own. */
typedef struct {
    bool is_there; /* of K under a load in the limb's plane */
    brace_force_t force;
    bool is_there_in_space;
    brace_force_t force_in_space;
    float across_n;
} asked_force_t;

typedef struct {
    brace_app_t *app;
    const brace_measured_t *measured; /* of the newest snapshot */
    brace_asker_t asker;    /* the port that it came through */
    brace_who_t who;        /* the master of that port */
    const brace_seal_t *seal; /* that came before it from that master, and further ones; null: none has come */
    brace_seal_t *brings;   /* (out) the seal that this request is, for the next one; null: none can come so */
    uint32_t token;         /* of CAN: the low bits of the counter of a seal */
    const uint8_t *bytes;   /* of the request as it came, over which its seal was made */
    uint32_t count;
    asked_force_t *asked_force; /* of that master */
    upload_t *upload;       /* of the port that it came through, null: of a wire that transfers no blocks; */
    download_t *download;   /* and of that master */
    uint32_t node_id;       /* of this node on CAN */
    uint32_t detail;        /* (out) what a refusal has to add; 0: nothing */
    bool is_of_now;         /* (out) the refusal is about the limb of now, whatever was asked */
} request_t;

#define ANSWER_FUNCTION(CODE, name) \
    int32_t answer_##name(request_t *request, const brace_##name##_request_t *asked, brace_##name##_answer_t *answer);
BRACE_REQUESTS(ANSWER_FUNCTION)
#undef ANSWER_FUNCTION

/* May what a request does be done? Its seal stays: a command that is refused may be a stranger's, and one that is let
 * in has used the seal's counter up.
 * returns BRACE_OK, or why not: brace/refusals.h */
int32_t answer_admit(request_t *request, brace_command_t command);

/* Answers the request of a code. BRACE_REFUSED_UNKNOWN: the dictionary has none; detail is the highest code there is.
 * At most 50 instructions and what brace/requests.h says of the request; 2,400 where a set is to be stored. */
int32_t answer_request(request_t *request, uint32_t code, const brace_request_t *asked, brace_answer_t *answer);

/* How the storing has ended that was to be answered later. */
int32_t answer_of_storing(request_t *request, brace_commit_answer_t *answer);

/* Each tick, before requests are answered: closes an upload that CONFIGURATION has ended. */
void upload_tick(upload_t *upload, const brace_app_t *app);

#endif
