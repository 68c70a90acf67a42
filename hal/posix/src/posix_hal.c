#include "brace_hal_posix.h"

#include <string.h>
#include <sys/random.h>
#include <time.h>

#include "posix_door.h"
#include "posix_io.h"

static int64_t clock_ns(void)
{
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

static uint32_t door_now_us(void *context)
{
    const brace_posix_t *posix = context;
    return posix->time_is_given ? posix->given_us : (uint32_t)((clock_ns() - posix->started_ns) / 1000);
}

static int32_t door_joint_read(void *context, int32_t joint_index, brace_hal_joint_t *joint)
{
    const brace_posix_limb_t *limb = &((brace_posix_t *)context)->limb;
    return limb->joint_read != NULL ? limb->joint_read(limb->context, joint_index, joint) : BRACE_HAL_E_UNSUPPORTED;
}

static int32_t door_joint_command(void *context, int32_t joint_index, const brace_hal_joint_command_t *command)
{
    const brace_posix_limb_t *limb = &((brace_posix_t *)context)->limb;
    return limb->joint_command(limb->context, joint_index, command);
}

static int32_t door_tip_force_read(void *context, float *force_x_n, float *force_z_n)
{
    const brace_posix_limb_t *limb = &((brace_posix_t *)context)->limb;
    return limb->tip_force_read(limb->context, force_x_n, force_z_n);
}

static int32_t door_serial_setup(void *context, brace_serial_port_t port, uint32_t baud, brace_parity_t parity)
{
    brace_posix_t *posix = context;
    if (port == BRACE_SERIAL_MODBUS_TCP) {
        return posix->modbus.listener >= 0 ? BRACE_HAL_OK : BRACE_HAL_E_UNSUPPORTED;
    }
    return port <= BRACE_SERIAL_SLCAN ? stream_setup(&posix->stream[port], baud, parity) : BRACE_HAL_E_UNSUPPORTED;
}

static int32_t door_serial_write(void *context, brace_serial_port_t port, const uint8_t *bytes, uint32_t count)
{
    brace_posix_t *posix = context;
    return port <= BRACE_SERIAL_SLCAN ? brace_posix_stream_write(&posix->stream[port], bytes, count)
                                      : BRACE_HAL_E_UNSUPPORTED;
}

static int32_t door_serial_write_to(void *context, brace_serial_port_t port, uint32_t peer, const uint8_t *bytes,
                                    uint32_t count)
{
    brace_posix_t *posix = context;
    return port == BRACE_SERIAL_MODBUS_TCP ? posix_modbus_write_to(&posix->modbus, peer, bytes, count)
                                           : BRACE_HAL_E_UNSUPPORTED;
}

static int32_t door_serial_read(void *context, brace_serial_port_t port, uint8_t *bytes, uint32_t room)
{
    brace_posix_t *posix = context;
    if (port == BRACE_SERIAL_MODBUS_TCP) {
        return posix_modbus_read(&posix->modbus, bytes, room);
    }
    return port <= BRACE_SERIAL_SLCAN ? brace_posix_stream_read(&posix->stream[port], bytes, room)
                                      : BRACE_HAL_E_UNSUPPORTED;
}

static uint32_t door_serial_peer(void *context, brace_serial_port_t port)
{
    const brace_posix_t *posix = context;
    return port == BRACE_SERIAL_MODBUS_TCP ? posix->modbus.current_serial : 0u;
}

static bool door_serial_peer_is_open(void *context, brace_serial_port_t port, uint32_t peer)
{
    const brace_posix_t *posix = context;
    bool is_open = port != BRACE_SERIAL_MODBUS_TCP;
    for (uint32_t i = 0; i < BRACE_POSIX_CLIENTS; i++) {
        const brace_posix_modbus_client_t *client = &posix->modbus.client[i];
        is_open = is_open || (client->file >= 0 && client->serial == peer);
    }
    return is_open;
}

static int32_t door_key_read(void *context, uint8_t key[BRACE_HAL_KEY_BYTES])
{
    const brace_posix_t *posix = context;
    if (posix->has_key) {
        memcpy(key, posix->key, BRACE_HAL_KEY_BYTES);
    }
    return posix->has_key ? BRACE_HAL_KEY_OPEN : BRACE_HAL_KEY_NONE; /* whoever writes the file has another */
}

static int32_t door_random_read(void *context, uint32_t *word)
{
    (void)context;
    return getrandom(word, sizeof *word, GRND_NONBLOCK) == (ssize_t)sizeof *word ? BRACE_HAL_OK : BRACE_HAL_AGAIN;
}

static void door_watchdog_feed(void *context)
{
    ((brace_posix_t *)context)->fed_us = door_now_us(context);
}

static brace_reset_cause_t door_reset_cause(void *context)
{
    return ((const brace_posix_t *)context)->cause;
}

static int32_t door_crash_read(void *context, brace_crash_record_t *record)
{
    (void)context;
    (void)record;
    return 0; /* the system reports a process that crashes */
}

static void door_crash_clear(void *context)
{
    (void)context;
}

static uint32_t door_stack_unused_bytes(void *context)
{
    (void)context;
    return 0;
}

static void door_restart(void *context)
{
    ((brace_posix_t *)context)->restart_asked = true;
}

void brace_posix_init(brace_posix_t *posix)
{
    memset(posix, 0, sizeof *posix);
    posix->started_ns = clock_ns();
    (void)brace_posix_nvm_open(&posix->nvm, NULL, NULL);
    for (uint32_t i = 0; i <= BRACE_SERIAL_SLCAN; i++) {
        (void)brace_posix_stream_open(&posix->stream[i], "none");
    }
    (void)brace_posix_modbus_open(&posix->modbus, "none");
}

bool brace_posix_join(brace_posix_t *posix, brace_posix_bus_t *bus)
{
    for (uint32_t i = 0; i < BRACE_POSIX_NODES; i++) {
        if (!bus->node[i].used) {
            memset(&bus->node[i], 0, sizeof bus->node[i]);
            bus->node[i].used = true;
            posix->bus = bus;
            posix->node = i;
            return true;
        }
    }
    return false;
}

void brace_posix_hal(brace_posix_t *posix, brace_hal_t *hal)
{
    memset(hal, 0, sizeof *hal);
    hal->context = posix;
    hal->board = "posix";
    hal->now_us = door_now_us;
    hal->joint_read = door_joint_read;
    hal->joint_command = posix->limb.joint_command != NULL ? door_joint_command : NULL;
    hal->tip_force_read = posix->limb.tip_force_read != NULL ? door_tip_force_read : NULL;
    hal->nvm_shape = (brace_nvm_shape_t){.slot_bytes = BRACE_POSIX_SLOT_BYTES, .write_bytes = BRACE_POSIX_WRITE_BYTES};
    hal->nvm_read = door_nvm_read;
    hal->nvm_write = door_nvm_write;
    hal->nvm_erase = door_nvm_erase;
    if (posix->bus != NULL) {
        hal->can_setup = door_can_setup;
        hal->can_send = door_can_send;
        hal->can_receive = door_can_receive;
        hal->can_health = door_can_health;
        hal->can_recover = door_can_recover;
    }
    hal->serial_setup = door_serial_setup;
    hal->serial_write = door_serial_write;
    hal->serial_read = door_serial_read;
    hal->serial_write_to = door_serial_write_to;
    hal->serial_peer = door_serial_peer;
    hal->serial_peer_is_open = door_serial_peer_is_open;
    hal->key_read = posix->is_guarded ? door_key_read : NULL;
    hal->random_read = door_random_read;
    hal->watchdog_feed = door_watchdog_feed;
    hal->reset_cause = door_reset_cause;
    hal->crash_read = door_crash_read;
    hal->crash_clear = door_crash_clear;
    hal->stack_unused_bytes = door_stack_unused_bytes;
    hal->restart = door_restart;
}

void brace_posix_poll(brace_posix_t *posix)
{
    for (uint32_t i = 0; i <= BRACE_SERIAL_SLCAN; i++) {
        stream_poll(&posix->stream[i]);
    }
    posix_modbus_poll(&posix->modbus);
}

void brace_posix_close(brace_posix_t *posix)
{
    brace_posix_nvm_close(&posix->nvm);
    for (uint32_t i = 0; i <= BRACE_SERIAL_SLCAN; i++) {
        brace_posix_stream_close(&posix->stream[i]);
    }
    brace_posix_modbus_close(&posix->modbus);
    if (posix->bus != NULL) {
        posix->bus->node[posix->node].used = false;
        posix->bus = NULL;
    }
}
