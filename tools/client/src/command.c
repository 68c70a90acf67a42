/* Commands, sent by an owner with its key. */
#include "client_can.h"
#include "client_modbus.h"
#include "command.h"
#include "refusal.h"

#include <ctype.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "brace/can_messages.h"
#include "brace/codes.h"
#include "brace/refusals.h"
#include "brace/status.h"

enum { BUSY_MS = 20, OTHER_SESSION_MS = 50, CHALLENGE_MS = 2, CHALLENGES = 5 };

/* -------------------------------------------------------------------------------------------- the key -- */

void brace_client_set_key(brace_client_t *client, const uint8_t key[BRACE_CLIENT_KEY_BYTES])
{
    client->owner = (brace_client_owner_t){.has_key = true};
    memcpy(client->owner.key, key, sizeof client->owner.key);
}

/* Hexadecimal digits with spaces between and behind them; false: other signs, or not as many. */
static bool read_key(FILE *file, uint8_t key[BRACE_CLIENT_KEY_BYTES])
{
    uint32_t digits = 0u;
    for (int sign = getc(file); sign != EOF; sign = getc(file)) {
        const char text[] = {(char)sign, '\0'};
        if (isspace(sign)) {
            continue;
        }
        if (!isxdigit(sign) || digits == 2u * BRACE_CLIENT_KEY_BYTES) {
            return false;
        }
        key[digits / 2u] = (uint8_t)(key[digits / 2u] << 4 | strtoul(text, NULL, 16));
        digits++;
    }
    return digits == 2u * BRACE_CLIENT_KEY_BYTES;
}

brace_client_status_t brace_client_load_key(brace_client_t *client, const char *path)
{
    uint8_t key[BRACE_CLIENT_KEY_BYTES] = {0};
    FILE *file = fopen(path, "r");
    const bool is_read = file != NULL && read_key(file, key);
    if (file != NULL) {
        (void)fclose(file);
    }
    if (!is_read) {
        return brace_client_fail(client, BRACE_CLIENT_E_USAGE,
                                 "%s: no key can be read; give a file with 32 hexadecimal digits", path);
    }
    brace_client_set_key(client, key);
    return BRACE_CLIENT_OK;
}

/* ---------------------------------------------------------------------------------------- the session -- */

/* A session that has ended gets its next challenge in a tick of the controller. */
static brace_client_status_t ask_challenge(brace_client_t *client, uint64_t deadline_us, uint64_t *challenge)
{
    uint32_t low = UINT32_MAX, high = UINT32_MAX;
    for (int i = 0; i < CHALLENGES && low == UINT32_MAX && high == UINT32_MAX; i++) {
        brace_client_status_t status =
            brace_client_entry_u32(client, BRACE_CLIENT_ENTRY(challenge_low), brace_bus_left_ms(deadline_us), &low);
        if (status == BRACE_CLIENT_OK) {
            status = brace_client_entry_u32(client, BRACE_CLIENT_ENTRY(challenge_high), brace_bus_left_ms(deadline_us),
                                            &high);
        }
        if (status != BRACE_CLIENT_OK) {
            return status;
        }
        if (low == UINT32_MAX && high == UINT32_MAX) {
            poll(NULL, 0, CHALLENGE_MS);
        }
    }
    *challenge = (uint64_t)high << 32 | low;
    return BRACE_CLIENT_OK;
}

static brace_client_status_t refuse(brace_client_t *client, int32_t refusal, const char *why)
{
    client->refusal = refusal;
    return brace_client_fail(client, BRACE_CLIENT_E_REFUSED, "%s: %s", client->url, why);
}

brace_client_status_t brace_client_become_owner(brace_client_t *client, uint64_t deadline_us)
{
    brace_client_owner_t *owner = &client->owner;
    const uint64_t challenge_before = owner->challenge;
    uint64_t challenge = 0u;
    uint32_t setting;
    if (owner->is_bench || owner->is_open) {
        return BRACE_CLIENT_OK;
    }
    brace_client_status_t status =
        brace_client_entry_u32(client, BRACE_CLIENT_ENTRY(setting), brace_bus_left_ms(deadline_us), &setting);
    if (status != BRACE_CLIENT_OK) {
        return status;
    }
    owner->is_bench = setting == BRACE_SETTING_BENCH;
    if (owner->is_bench) {
        return BRACE_CLIENT_OK;
    }
    if (setting != BRACE_SETTING_GUARDED) {
        return refuse(client, BRACE_REFUSED_NO_KEY, brace_client_reason(0u, BRACE_REFUSED_NO_KEY, 0u));
    }
    if (!owner->has_key) {
        return refuse(client, BRACE_REFUSED_STRANGER,
                      "the controller is guarded, and commands need its key; give it with brace_client_load_key");
    }
    status = ask_challenge(client, deadline_us, &challenge);
    if (status != BRACE_CLIENT_OK) {
        return status;
    }
    if (owner->is_accepted && challenge == challenge_before) {
        owner->is_open = true; /* the session is still ours: only a seal was lost on the way */
        return BRACE_CLIENT_OK;
    }
    uint32_t number;
    status = brace_client_entry_u32(client, BRACE_CLIENT_ENTRY(life_number), brace_bus_left_ms(deadline_us), &number);
    if (status != BRACE_CLIENT_OK) {
        return status;
    }
    brace_owner_open(owner, challenge);
    brace_owner_hears(owner, number);
    if (client->bus != NULL) {
        brace_can_show_life(client);
    } else {
        brace_modbus_show_life(client, deadline_us);
    }
    return BRACE_CLIENT_OK;
}

static brace_client_status_t send_command(brace_client_t *client, brace_command_t *command, uint64_t deadline_us)
{
    if (client->bus == NULL) {
        return brace_modbus_command(client, command->question.code, command->place, command->values, command->count,
                                    true, command->moves, deadline_us);
    }
    for (;;) {
        const brace_client_status_t status = brace_can_command(client, &command->question, command->moves, deadline_us);
        if (status != BRACE_CLIENT_E_REFUSED || client->refusal != BRACE_REFUSED_BUSY ||
            brace_bus_left_ms(deadline_us) <= BUSY_MS) {
            return status;
        }
        poll(NULL, 0, BUSY_MS);
    }
}

/* The controller may have ended the session, or may have started anew as another kind of board. A command whose seal
 * was lost is refused as somebody else's. */
static bool is_not_known(int32_t refusal)
{
    return refusal == BRACE_REFUSED_OWNED || refusal == BRACE_REFUSED_STRANGER || refusal == BRACE_REFUSED_REPLAY ||
           refusal == BRACE_REFUSED_NO_KEY;
}

/* A session that another program with the key has left on this bus ends after a second; until then all counts as a
 * replay. */
brace_client_status_t brace_client_command(brace_client_t *client, brace_command_t *command, uint64_t deadline_us)
{
    brace_client_status_t status = BRACE_CLIENT_E_REFUSED;
    bool goes_on = true, was_replay = false;
    for (int tries = 0; status == BRACE_CLIENT_E_REFUSED && goes_on; tries++) {
        if (tries > 0) {
            client->owner.is_open = client->owner.is_bench = false;
        }
        if (tries > 1) {
            poll(NULL, 0, OTHER_SESSION_MS);
        }
        status = brace_client_become_owner(client, deadline_us);
        if (status != BRACE_CLIENT_OK) {
            return status;
        }
        status = send_command(client, command, deadline_us);
        client->owner.is_accepted |= status == BRACE_CLIENT_OK;
        const bool is_replay = client->refusal == BRACE_REFUSED_REPLAY;
        const bool may_pass = (is_replay || was_replay) && brace_bus_left_ms(deadline_us) > 2 * OTHER_SESSION_MS;
        goes_on = client->owner.has_key && is_not_known(client->refusal) && (tries == 0 || may_pass);
        was_replay = is_replay;
    }
    return status;
}

/* ------------------------------------------------------------------------------------------- clear -- */

brace_client_status_t brace_client_clear(brace_client_t *client, uint32_t faults, int timeout_ms, uint32_t *left)
{
    const uint64_t deadline_us = brace_client_deadline_after(timeout_ms);
    const brace_can_clear_request_t request = {.faults = faults};
    brace_command_t command = {.question = {.code = BRACE_REQUEST_CLEAR},
                               .place = BRACE_CLIENT_COMMAND_PLACE(clear_faults),
                               .values = {faults},
                               .count = 1u};
    uint32_t now;
    (void)brace_can_pack_clear_request(&request, command.question.data);
    brace_client_status_t status = brace_client_command(client, &command, deadline_us);
    if (status == BRACE_CLIENT_OK) {
        status = brace_client_entry_u32(client, BRACE_CLIENT_ENTRY(faults), brace_bus_left_ms(deadline_us), &now);
    }
    if (status == BRACE_CLIENT_OK && left != NULL) {
        *left = now;
    }
    return status;
}
