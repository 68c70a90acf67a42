/* One request over Modbus, and the connection that carries it. client_modbus_link.c is the only file that knows
 * libmodbus. An error is libmodbus' number or the system's; 0: none. */
#ifndef BRACE_CLIENT_MODBUS_LINK_H
#define BRACE_CLIENT_MODBUS_LINK_H

#include "client_state.h"

typedef enum {
    BRACE_MODBUS_READ_HOLDING = 3,
    BRACE_MODBUS_READ_INPUT = 4,
    BRACE_MODBUS_WRITE = 16
} brace_modbus_function_t;

enum { BRACE_MODBUS_REGISTERS_MOST = 125 /* of one read; 123 of one write */ };

/* Opens the connection that client->url names, and closes it. */
brace_client_status_t brace_modbus_connect(brace_client_t *client, uint64_t deadline_us);
void brace_modbus_close(brace_client_t *client);

/* Reads or writes so many registers from an address on, once. returns the error */
int brace_modbus_try(brace_client_t *client, brace_modbus_function_t function, uint32_t address, uint32_t count,
                     uint16_t *words, uint64_t deadline_us);

/* Drops answers that come late, after one that did not come in time. To be called before brace_modbus_try. returns the
 * error */
int brace_modbus_fall_into_step(brace_client_t *client, uint64_t deadline_us);

/* Is another try worth it? Nothing came, or something broken, or the unit is busy. */
bool brace_modbus_may_pass(int error);

/* Did something come that was broken? Did nothing come? */
bool brace_modbus_is_broken(int error);
bool brace_modbus_is_silent(int error);

/* The exception code by which the unit has refused; 0: the error is none. */
int brace_modbus_exception(int error);

/* Writes what the error means, and what to try. */
brace_client_status_t brace_modbus_fail(brace_client_t *client, int error);

#endif
