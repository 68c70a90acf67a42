/* A client's two ways to a controller. can_... and modbus_... return what client.h says of the call with that name, and
 * write client->why when that is not OK. */
#ifndef BRACE_CLIENT_INTERNAL_H
#define BRACE_CLIENT_INTERNAL_H

#include "bus_internal.h"
#include "joiner.h"

enum {
    PARTS_MOST = BRACE_PART_ALL | BRACE_PART_SPACE | BRACE_PART_LOAD | BRACE_PART_LOAD_ACROSS,
    ANSWER_PARTS_MOST = 7
};

struct brace_client {
    char why[BRACE_CLIENT_WHY_ROOM];
    char url[128];
    brace_client_identity_t identity;
    int32_t refusal;

    brace_bus_t *bus; /* CAN; null over Modbus */
    uint32_t node;
    brace_joiner_t joiner;
    brace_client_snapshot_t latest[PARTS_MOST + 1]; /* newest snapshot for each set of parts; parts 0: none */
    uint64_t read_us[PARTS_MOST + 1];               /* time of the last one read, for each set of wanted parts */
    uint32_t read_sequence[PARTS_MOST + 1];
    uint32_t heard[4];                                  /* nodes that have sent in this call, one bit each */
    uint32_t errors_before, lost_before;                /* the bus' counts when our node last sent a readable frame */
    uint64_t ask_errors_us;                             /* when this call asks an SLCAN adapter for errors; 0: never */
    bool speaks_another;                                /* our node's heartbeat has another dictionary */
    uint32_t other_hash;
    uint8_t token;
    bool force_is_taken; /* another client has asked for K under a force: the controller may have counted its force */

    void *modbus; /* modbus_t; null over CAN */
    uint32_t unit;
    uint64_t late_until_us; /* until this time an answer may come that nobody waits for any more */
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

/* Writes why and returns status, to end a function with. */
brace_client_status_t brace_client_fail(brace_client_t *client, brace_client_status_t status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
brace_client_status_t brace_client_fail_version(brace_client_t *client, uint32_t node, uint32_t hash);

brace_client_status_t brace_can_open(brace_client_t *client, uint32_t node, uint32_t bit_rate, uint64_t deadline_us);
brace_client_status_t brace_can_read(brace_client_t *client, uint32_t wanted, uint64_t deadline_us,
                                     brace_client_snapshot_t *snapshot);
/* Sends question->data, with a new token for each try, until every part of the answer has come. */
brace_client_status_t brace_can_ask(brace_client_t *client, brace_question_t *question, uint64_t deadline_us);
/* The same for a question about K under a force: sends the force first, and both again when another client comes
 * between them. */
brace_client_status_t brace_can_ask_under_force(brace_client_t *client, brace_question_t *force,
                                                brace_question_t *question, uint64_t deadline_us);

bool brace_modbus_is_url(const char *url);
brace_client_status_t brace_modbus_open(brace_client_t *client, uint64_t deadline_us);
void brace_modbus_close(brace_client_t *client);
brace_client_status_t brace_modbus_read(brace_client_t *client, uint32_t wanted, uint64_t deadline_us,
                                        brace_client_snapshot_t *snapshot);
brace_client_status_t brace_modbus_drift(brace_client_t *client, uint64_t deadline_us, brace_client_drift_t *drift);
/* A question of some commands that follow one another, each a float's or a whole number's bits, and all answers. */
brace_client_status_t brace_modbus_ask(brace_client_t *client, uint32_t first, const uint32_t *values, uint32_t count,
                                       uint64_t deadline_us, brace_answered_t *answered);
brace_client_status_t brace_modbus_load(brace_client_t *client, uint64_t deadline_us, brace_client_load_t *load);
brace_client_status_t brace_modbus_entry(brace_client_t *client, uint32_t index, uint64_t deadline_us, uint32_t *value);

#endif
