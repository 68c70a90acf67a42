/* A serial port as any port: it takes and gives anything within what it is asked for. */
#ifndef BRACE_PROOF_PORT_H
#define BRACE_PROOF_PORT_H

#include "brace_hal.h"
#include "proof.h"

/* The buffers of the port. CBMC's own checks know where an object ends, and a buffer is only a part of one: a pointer's
 * reach is proven against these. */
static const uint8_t *in_from, *in_end, *out_from, *out_end;

/* What comes is what stands in the buffer already: a state of any content has any bytes there. */
static int32_t any_serial_read(void *context, brace_serial_port_t port, uint8_t *bytes, uint32_t room)
{
    (void)context;
    (void)port;
    const int32_t count = any_i32();
    PROVE(bytes >= in_from && bytes <= in_end && room <= (size_t)(in_end - bytes),
          "a port is given room that is there");
    ASSUME(count <= (int32_t)room);
    return count;
}

static int32_t any_serial_write(void *context, brace_serial_port_t port, const uint8_t *bytes, uint32_t count)
{
    (void)context;
    (void)port;
    const int32_t taken = any_i32();
    PROVE(bytes >= out_from && bytes <= out_end && count <= (size_t)(out_end - bytes),
          "a port is given bytes that are there");
    ASSUME(taken <= (int32_t)count);
    return taken;
}

static const brace_hal_t any_hal = {.serial_read = any_serial_read, .serial_write = any_serial_write};

#endif
