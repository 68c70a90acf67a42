#include "wire/modbus/command.h"

#include <stddef.h>

#include "wire/modbus/refusal.h"

#define KEY 0xc0deu /* in the high half of what nobody must write by mistake */
#define COMMAND(member) (offsetof(brace_commands_t, member) / 4u) /* its place: every value has 32 bits */

enum { STORES_NOW = 1, FLANK_POSITIVE = 1, FLANK_NEGATIVE = 2 };

/* The request that a command's value stands for. returns its code; 0: it stands for none */
static uint32_t request_of(uint32_t command, uint32_t value, brace_request_t *asked)
{
    const uint32_t low = value & 0xffffu, high = value >> 16, flank = value >> 8;
    switch (command) {
    case COMMAND(set_mode):
        asked->set_mode = (brace_set_mode_request_t){.mode = low, .key = high};
        return high == KEY && (low == BRACE_MODE_CONFIGURATION || low == BRACE_MODE_MONITOR) ? BRACE_REQUEST_SET_MODE
                                                                                             : 0u;
    case COMMAND(commit):
        asked->commit = (brace_commit_request_t){.crc = 0}; /* what has been written value by value */
        return high == KEY && low == STORES_NOW ? BRACE_REQUEST_COMMIT : 0u;
    case COMMAND(rollback): return high == KEY && low == STORES_NOW ? BRACE_REQUEST_ROLLBACK : 0u;
    case COMMAND(clear_faults): asked->clear = (brace_clear_request_t){.faults = value}; return BRACE_REQUEST_CLEAR;
    case COMMAND(take_up):
        asked->take_up = (brace_take_up_request_t){.joint = value & 0xffu, .flank = flank == FLANK_POSITIVE ? 1 : -1};
        return flank == FLANK_POSITIVE || flank == FLANK_NEGATIVE ? BRACE_REQUEST_TAKE_UP : 0u;
    case COMMAND(let_go): return BRACE_REQUEST_LET_GO;
    case COMMAND(stop): return BRACE_REQUEST_LOADING_TEST_STOP;
    case COMMAND(end_test):
        asked->write_entry = (brace_write_entry_request_t){BRACE_ENTRY_COMMANDS + command, value};
        return BRACE_REQUEST_WRITE_ENTRY;
    case COMMAND(commit_crc):
        asked->commit = (brace_commit_request_t){.crc = value};
        return value != 0u ? BRACE_REQUEST_COMMIT : 0u;
    default: return 0; /* a value of a question */
    }
}

request_t modbus_request(const modbus_server_t *server, const wire_tick_t *tick)
{
    return (request_t){.app = tick->app,
                       .measured = tick->measured,
                       .asker = server->asker,
                       .who = server->who,
                       .seal = server->seal,
                       .token = 0,
                       .bytes = server->pdu,
                       .count = server->length,
                       .asked_force = NULL,
                       .upload = NULL,
                       .download = NULL,
                       .node_id = 0,
                       .detail = 0,
                       .is_of_now = false};
}

modbus_exception_t modbus_command_show(modbus_server_t *server, const wire_tick_t *tick, uint32_t first,
                                       const uint32_t words[2])
{
    if (first == COMMAND(life_heard)) {
        const brace_sign_t sign = {.heard = words[0], .heard_bits = 32, .check = words[1]};
        return modbus_refusal_of(brace_app_life(tick->app, server->who, &sign));
    }
    *server->seal = (brace_seal_t){.is_there = true, .counter = words[0], .counter_bits = 32, .mac = words[1]};
    return MODBUS_FINE;
}

bool modbus_command_shows(uint32_t first, uint32_t count)
{
    return count == 2u && (first == COMMAND(life_heard) || first == COMMAND(seal_counter));
}

modbus_exception_t modbus_command_run(modbus_server_t *server, const wire_tick_t *tick, uint32_t command,
                                      uint32_t value)
{
    request_t request = modbus_request(server, tick);
    brace_request_t asked;
    brace_answer_t answer;
    const uint32_t code = request_of(command, value, &asked);
    if (code == 0u) {
        return MODBUS_E_VALUE;
    }
    const bool leaves = code == BRACE_REQUEST_SET_MODE && asked.set_mode.mode == BRACE_MODE_MONITOR;
    if (leaves && brace_app_mode(tick->app) != BRACE_MODE_CONFIGURATION) {
        return MODBUS_FINE; /* there is nothing to leave */
    }
    const modbus_exception_t why = modbus_refusal_of(answer_request(&request, code, &asked, &answer));
    if (why == MODBUS_FINE && code == BRACE_REQUEST_TAKE_UP) {
        server->written.take_up = value;
    }
    return why;
}

static uint32_t storing(const brace_app_t *app)
{
    brace_store_status_t status;
    (void)brace_app_store_status(app, &status);
    const uint32_t outcome = status.state == BRACE_STORE_FAILED ? (uint32_t)(256 + (int)status.failure) : 0u;
    return brace_app_is_storing(app) ? 1u : outcome;
}

void modbus_command_report(const modbus_server_t *server, const brace_app_t *app, brace_commands_t *reported)
{
    *reported = server->written;
    reported->set_mode = brace_app_mode(app);
    reported->commit = reported->commit_crc = reported->rollback = storing(app);
    reported->clear_faults = brace_app_faults(app);
    reported->let_go = reported->stop = reported->end_test = 0;
    reported->life_heard = reported->life_mac = reported->seal_counter = reported->seal_mac = 0;
}
