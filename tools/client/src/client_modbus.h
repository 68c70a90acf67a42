/* The client over Modbus. Functions return what client.h says of the call with that name, and write client->why when
 * that is not OK. brace_modbus_close (client_modbus_link.h) closes what brace_modbus_open has opened. */
#ifndef BRACE_CLIENT_MODBUS_H
#define BRACE_CLIENT_MODBUS_H

#include "client_state.h"

bool brace_modbus_is_url(const char *url);
brace_client_status_t brace_modbus_open(brace_client_t *client, uint64_t deadline_us);
brace_client_status_t brace_modbus_read(brace_client_t *client, uint32_t wanted, uint64_t deadline_us,
                                        brace_client_snapshot_t *snapshot);
brace_client_status_t brace_modbus_drift(brace_client_t *client, uint64_t deadline_us, brace_client_drift_t *drift);
/* A question of some commands that follow one another, each a float's or a whole number's bits, and all answers. */
brace_client_status_t brace_modbus_ask(brace_client_t *client, uint32_t first, const uint32_t *values, uint32_t count,
                                       uint64_t deadline_us, brace_answered_t *answered);
/* Writes a command, sealed where a session is open; code: its request on CAN, for words. Waits while the unit is busy,
 * and writes again when no answer comes. What moves the limb begins with the next sign of life. */
brace_client_status_t brace_modbus_command(brace_client_t *client, uint32_t code, uint32_t place,
                                           const uint32_t *values, uint32_t count, bool is_sealed, bool moves,
                                           uint64_t deadline_us);
/* Gives a sign of life now. Reads the next number too. */
void brace_modbus_show_life(brace_client_t *client, uint64_t deadline_us);
/* Gives a sign of life if one is due. */
void brace_modbus_tend(brace_client_t *client, uint64_t deadline_us);
brace_client_status_t brace_modbus_load(brace_client_t *client, uint64_t deadline_us, brace_client_load_t *load);
brace_client_status_t brace_modbus_entry(brace_client_t *client, uint32_t index, uint64_t deadline_us, uint32_t *value);

#endif
