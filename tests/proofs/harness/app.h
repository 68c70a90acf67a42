/* The outside of the services that proofs look at: each stand-in may answer anything that its header allows. */
#ifndef BRACE_PROOF_APP_H
#define BRACE_PROOF_APP_H

#include "brace/app.h"
#include "proof.h"

/* A port that takes and gives anything, within what it is asked for. What comes is what stands in the buffer already: a
 * state of any content has any bytes there. */
static int32_t any_serial_read(void *context, brace_serial_port_t port, uint8_t *bytes, uint32_t room)
{
    (void)context;
    (void)port;
    const int32_t count = any_i32();
    PROVE(room <= 64u && __CPROVER_w_ok(bytes, room), "a port is given room that is there");
    ASSUME(count <= (int32_t)room);
    return count;
}

static int32_t any_serial_write(void *context, brace_serial_port_t port, const uint8_t *bytes, uint32_t count)
{
    (void)context;
    (void)port;
    const int32_t taken = any_i32();
    PROVE(__CPROVER_r_ok(bytes, count), "a port is given bytes that are there");
    ASSUME(taken <= (int32_t)count);
    return taken;
}

static const brace_hal_t any_hal = {.serial_read = any_serial_read, .serial_write = any_serial_write};

#endif
