/* What a client knows, and what every part of it uses: words for a failure, a deadline, when a sign of life is due.
 * Knows no wire. */
#ifndef BRACE_CLIENT_STATE_H
#define BRACE_CLIENT_STATE_H

#include "brace/client_motion.h"
#include "bus_common.h"
#include "joiner.h"
#include "owner.h"

enum {
    PARTS_MOST = BRACE_PART_ALL | BRACE_PART_SPACE | BRACE_PART_LOAD | BRACE_PART_LOAD_ACROSS | BRACE_PART_SIGMA |
                 BRACE_PART_SIGMA_SPACE,
    ANSWER_PARTS_MOST = 7
};

/* Number of a command on CAN, and its place among the commands, from its member. */
#define BRACE_CLIENT_COMMAND(member) (BRACE_ENTRY_COMMANDS + BRACE_CLIENT_COMMAND_PLACE(member))
#define BRACE_CLIENT_COMMAND_PLACE(member) ((uint32_t)(offsetof(brace_commands_t, member) / 4u))

typedef enum { BRACE_TAKES_UP, BRACE_LETS_GO, BRACE_LOADS, BRACE_ENDS_TEST } brace_motion_kind_t;

/* The motion that was begun last. */
typedef struct {
    brace_motion_t now;
    brace_motion_kind_t kind;
    uint32_t joint;
    uint32_t silences;                     /* that the controller had counted before */
    uint64_t asked_us, limit_us, news_us;  /* when it was asked for, has to have ended, and was last reported */
    uint64_t next_poll_us;
    bool has_begun; /* the controller has taken the sign of life with which the motion begins */
    bool in_fault; /* the controller, when it was last asked */
} brace_client_motion_t;

struct brace_client {
    char why[BRACE_CLIENT_WHY_ROOM];
    char url[128];
    brace_client_identity_t identity;
    int32_t refusal;

    brace_client_owner_t owner;
    uint8_t master; /* upper four bits of the tokens of commands: they distinguish masters on one CAN bus */
    bool lives;     /* signs of life are given */
    uint64_t next_life_us;
    brace_client_motion_t motion;

    brace_bus_t *bus; /* CAN; null over Modbus */
    uint32_t node;
    brace_joiner_t joiner;
    brace_client_snapshot_t latest[PARTS_MOST + 1]; /* newest snapshot for each set of parts; parts 0: none */
    uint64_t read_us[PARTS_MOST + 1];               /* time of the last one read, for each set of wanted parts */
    uint32_t read_sequence[PARTS_MOST + 1];
    uint32_t heard[4];                                  /* nodes that have sent in this call, one bit each */
    uint32_t errors_before, lost_before, unacknowledged_before; /* the bus' counts when our node last sent a readable
                                                                   frame */
    uint64_t ask_errors_us; /* when this call asks an SLCAN adapter for errors; 0: never */
    bool speaks_another; /* our node's heartbeat has another dictionary */
    uint32_t other_hash;
    uint8_t token;
    uint64_t foreign_us[256]; /* when another client last asked with each token; 0: never */
    bool is_down; /* a sign of life has found the bus down */
    bool force_is_taken; /* another client has asked for K under a force: the controller may have counted its force */

    void *modbus; /* modbus_t; null over CAN */
    uint32_t unit;
    uint32_t baud; /* of a serial line; 0 over TCP */
    bool is_out_of_step; /* an answer may come that nobody waits for any more */
    uint32_t marks; /* reads that were asked for to find the step again */
};

typedef struct {
    uint32_t code;
    uint8_t data[8];
    uint8_t answers[ANSWER_PARTS_MOST][8];
} brace_question_t;

/* An outcome has 8 bits: a negative one comes as 256 plus it. */
static inline int32_t brace_client_outcome(uint32_t sent)
{
    const int32_t low = (int32_t)(sent & 0xffu);
    return low < 128 ? low : low - 256;
}

/* Is a sign of life due? Counts it as given. Over CAN none is before the controller has sent a number. */
bool brace_client_life_is_due(brace_client_t *client);

uint64_t brace_client_deadline_after(int timeout_ms);

/* Writes why and returns status, to end a function with. */
brace_client_status_t brace_client_fail(brace_client_t *client, brace_client_status_t status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
brace_client_status_t brace_client_fail_version(brace_client_t *client, uint32_t node, uint32_t hash);
brace_client_status_t brace_client_out_of_range(brace_client_t *client);

#endif
