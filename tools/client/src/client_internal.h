/* A client's two ways to a controller. can_... and modbus_... return what client.h says of the call with that name, and
 * write client->why when that is not OK. */
#ifndef BRACE_CLIENT_INTERNAL_H
#define BRACE_CLIENT_INTERNAL_H

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
    uint64_t asked_us, limit_us, news_us;  /* when it was asked for, has to have ended, and was last told of */
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
    uint8_t master; /* upper four bits of the tokens of commands: they tell masters on one CAN bus apart */
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
    uint64_t ask_errors_us;                             /* when this call asks an SLCAN adapter for errors; 0: never */
    bool speaks_another;                                /* our node's heartbeat has another dictionary */
    uint32_t other_hash;
    uint8_t token;
    uint64_t foreign_us[256]; /* when another client last asked with each token; 0: never */
    bool is_down;             /* a sign of life has found the bus down */
    bool force_is_taken; /* another client has asked for K under a force: the controller may have counted its force */

    void *modbus; /* modbus_t; null over CAN */
    uint32_t unit;
    uint32_t baud;       /* of a serial line; 0 over TCP */
    bool is_out_of_step; /* an answer may come that nobody waits for any more */
    uint32_t marks;      /* reads that were asked for to find the step again */
};

typedef struct {
    uint32_t code;
    uint8_t data[8];
    uint8_t answers[ANSWER_PARTS_MOST][8];
} brace_question_t;

/* Why there is no K under a force, in words. */
#define BRACE_CLIENT_NO_COXA "the limb has no coxa joint; ask for K in its plane"
#define BRACE_CLIENT_FOLDS \
    "no stable equilibrium is near: the force folds the limb there; ask for a smaller force or another place"

/* What a client tells a controller to do, for both wires. */
typedef struct {
    brace_question_t question; /* over CAN */
    bool moves;                /* it begins with a sign of life, so it may be sent again until it is answered */
    uint32_t place, values[2], count; /* over Modbus */
} brace_command_t;

/* Sends a command. On a guarded board opens a session before, and again when the controller has ended it. */
brace_client_status_t brace_client_command(brace_client_t *client, brace_command_t *command, uint64_t deadline_us);

/* Opens a session on a guarded board, if none is open. */
brace_client_status_t brace_client_become_owner(brace_client_t *client, uint64_t deadline_us);

/* An outcome has 8 bits: a negative one comes as 256 plus it. */
static inline int32_t brace_client_outcome(uint32_t sent)
{
    const int32_t low = (int32_t)(sent & 0xffu);
    return low < 128 ? low : low - 256;
}

/* The limb was told to stop. */
void brace_client_end_motion(brace_client_t *client);

/* Gives a sign of life if one is due; over CAN not before the controller has sent a number. */
void brace_client_tend(brace_client_t *client, uint64_t deadline_us);

/* A refusal in words. The meaning of a status depends on the request. */
const char *brace_client_reason(uint32_t code, int32_t status, uint32_t detail);

/* A controller counts the force that was told last, whoever told it, and once. */
bool brace_client_is_about_force(uint32_t code);

uint64_t brace_client_deadline_after(int timeout_ms);

/* Writes why and returns status, to end a function with. */
brace_client_status_t brace_client_fail(brace_client_t *client, brace_client_status_t status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
brace_client_status_t brace_client_fail_version(brace_client_t *client, uint32_t node, uint32_t hash);
brace_client_status_t brace_client_out_of_range(brace_client_t *client);

brace_client_status_t brace_can_open(brace_client_t *client, uint32_t node, uint32_t bit_rate, uint64_t deadline_us);
brace_client_status_t brace_can_read(brace_client_t *client, uint32_t wanted, uint64_t deadline_us,
                                     brace_client_snapshot_t *snapshot);
/* Sends question->data, with a new token for each try, until every part of the answer has come. */
brace_client_status_t brace_can_ask(brace_client_t *client, brace_question_t *question, uint64_t deadline_us);
/* The same for a question about K under a force: sends the force first, and both again when another client comes
 * between them. */
brace_client_status_t brace_can_ask_under_force(brace_client_t *client, brace_question_t *force,
                                                brace_question_t *question, uint64_t deadline_us);

/* Sends question->data, sealed where a session is open. What moves the limb begins with the next sign of life. */
brace_client_status_t brace_can_command(brace_client_t *client, brace_question_t *question, bool moves,
                                        uint64_t deadline_us);
/* Its answer, whoever receives it, brings the next number. */
void brace_can_show_life(brace_client_t *client);
/* Listens until the sign of life that begins a motion has been answered, and gives it again meanwhile. */
void brace_can_hear_begin(brace_client_t *client, uint64_t deadline_us);

bool brace_modbus_is_url(const char *url);
brace_client_status_t brace_modbus_open(brace_client_t *client, uint64_t deadline_us);
void brace_modbus_close(brace_client_t *client);
brace_client_status_t brace_modbus_read(brace_client_t *client, uint32_t wanted, uint64_t deadline_us,
                                        brace_client_snapshot_t *snapshot);
brace_client_status_t brace_modbus_drift(brace_client_t *client, uint64_t deadline_us, brace_client_drift_t *drift);
/* A question of some commands that follow one another, each a float's or a whole number's bits, and all answers. */
brace_client_status_t brace_modbus_ask(brace_client_t *client, uint32_t first, const uint32_t *values, uint32_t count,
                                       uint64_t deadline_us, brace_answered_t *answered);
/* Writes a command, sealed where a session is open; code: its request on CAN, for words. Waits while the unit is busy, and
 * writes again when no answer comes. What moves the limb begins with the next sign of life. */
brace_client_status_t brace_modbus_command(brace_client_t *client, uint32_t code, uint32_t place,
                                           const uint32_t *values, uint32_t count, bool is_sealed, bool moves,
                                           uint64_t deadline_us);
/* Reads the next number too. */
void brace_modbus_show_life(brace_client_t *client, uint64_t deadline_us);
brace_client_status_t brace_modbus_load(brace_client_t *client, uint64_t deadline_us, brace_client_load_t *load);
brace_client_status_t brace_modbus_entry(brace_client_t *client, uint32_t index, uint64_t deadline_us, uint32_t *value);

#endif
