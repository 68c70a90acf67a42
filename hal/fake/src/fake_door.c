#include "fake_door.h"

#include <stddef.h>

#define CALLED(entry) \
    brace_fake_t *fake = context; \
    const int32_t wanted = fake_called(fake, BRACE_FAKE_##entry); \
    if (wanted != BRACE_HAL_OK) { \
        return wanted; \
    }

static uint32_t now_us(void *context)
{
    brace_fake_t *fake = context;
    fake->calls[BRACE_FAKE_NOW_US]++;
    return fake->now_us;
}

/* ------------------------------------------------------------------------------------------- joints -- */

static int32_t joint_read(void *context, int32_t joint_index, brace_hal_joint_t *joint)
{
    CALLED(JOINT_READ)
    if (joint_index < 0 || joint_index >= BRACE_FAKE_JOINTS) {
        return BRACE_HAL_E_RANGE;
    }
    brace_fake_joint_t *ours = &fake->joint[joint_index];
    if (ours->absent) {
        return BRACE_HAL_E_UNSUPPORTED;
    }
    if (fake->play != NULL) {
        fake->play(fake->user, fake, joint_index);
    }
    if (!ours->keeps_taken_us && !ours->not_newer) {
        ours->sample.taken_us = fake->now_us;
    }
    *joint = ours->sample;
    return ours->not_newer ? BRACE_HAL_AGAIN : BRACE_HAL_OK;
}

static int32_t joint_command(void *context, int32_t joint_index, const brace_hal_joint_command_t *command)
{
    CALLED(JOINT_COMMAND)
    const bool numbers = command->offset_rad == command->offset_rad && command->torque_limit_n_mm >= 0.0f;
    if (joint_index < 0 || joint_index >= BRACE_FAKE_JOINTS || !numbers) {
        return BRACE_HAL_E_RANGE;
    }
    fake->joint[joint_index].command = *command;
    fake->joint[joint_index].commanded_us = fake->now_us;
    return BRACE_HAL_OK;
}

static int32_t tip_force_read(void *context, float *force_x_n, float *force_z_n)
{
    CALLED(TIP_FORCE_READ)
    *force_x_n = fake->force_x_n;
    *force_z_n = fake->force_z_n;
    return fake->force_not_newer ? BRACE_HAL_AGAIN : BRACE_HAL_OK;
}

/* ------------------------------------------------------------------------------------------- memory -- */

static bool outside(uint32_t slot, uint32_t offset, uint32_t count)
{
    return slot >= BRACE_NVM_SLOT_COUNT || offset > BRACE_FAKE_SLOT_BYTES || count > BRACE_FAKE_SLOT_BYTES - offset;
}

static int32_t nvm_read(void *context, uint32_t slot, uint32_t offset, uint8_t *bytes, uint32_t count)
{
    CALLED(NVM_READ)
    if (outside(slot, offset, count)) {
        return BRACE_HAL_E_RANGE;
    }
    for (uint32_t i = 0; i < count; i++) {
        bytes[i] = fake->nvm[slot][offset + i];
    }
    return BRACE_HAL_OK;
}

static int32_t nvm_write(void *context, uint32_t slot, uint32_t offset, const uint8_t *bytes, uint32_t count)
{
    CALLED(NVM_WRITE)
    const uint32_t unit = fake->hal.nvm_shape.write_bytes;
    if (outside(slot, offset, count) || offset % unit != 0u || count % unit != 0u) {
        return BRACE_HAL_E_RANGE;
    }
    for (uint32_t i = 0; i < count && !fake->nvm_forgets; i++) {
        /* as in flash: a write turns bits from 1 to 0, only an erase turns them back */
        fake->nvm[slot][offset + i] &= (uint8_t)(bytes[i] & ~fake->nvm_stuck);
    }
    return BRACE_HAL_OK;
}

static int32_t nvm_erase(void *context, uint32_t slot)
{
    CALLED(NVM_ERASE)
    if (slot >= BRACE_NVM_SLOT_COUNT) {
        return BRACE_HAL_E_RANGE;
    }
    for (uint32_t i = 0; i < BRACE_FAKE_SLOT_BYTES && !fake->nvm_forgets; i++) {
        fake->nvm[slot][i] = 0xff;
    }
    return BRACE_HAL_OK;
}

/* ---------------------------------------------------------------------------------------------- CAN -- */

static int32_t can_setup(void *context, const brace_can_setup_t *setup)
{
    CALLED(CAN_SETUP)
    if (setup->fd_bit_rate != 0u && !fake->can_takes_fd) {
        return BRACE_HAL_E_UNSUPPORTED;
    }
    fake->can_setup = *setup;
    return BRACE_HAL_OK;
}

static int32_t can_send(void *context, const brace_can_frame_t *frame)
{
    CALLED(CAN_SEND)
    if (frame->id > 0x7ffu || frame->length > (frame->fd ? 64u : 8u) ||
        (frame->fd && fake->can_setup.fd_bit_rate == 0u) || fake->can_setup.listen_only ||
        fake->can_setup.bit_rate == 0u) {
        return BRACE_HAL_E_RANGE;
    }
    if (fake->can_health.bus_off) {
        return BRACE_HAL_E_BUS_OFF;
    }
    if (fake->can_sent.count >= fake->can_room) {
        return BRACE_HAL_AGAIN;
    }
    (void)fake_frames_put(&fake->can_sent, frame);
    return BRACE_HAL_OK;
}

static int32_t can_receive(void *context, brace_can_frame_t *frame)
{
    CALLED(CAN_RECEIVE)
    if (fake->can_has_urgent) {
        *frame = fake->can_urgent;
        fake->can_has_urgent = false;
        return 1;
    }
    return fake_frames_take(&fake->can_received, frame) ? 1 : 0;
}

static int32_t can_health(void *context, brace_can_health_t *health)
{
    CALLED(CAN_HEALTH)
    *health = fake->can_health;
    return BRACE_HAL_OK;
}

static int32_t can_recover(void *context)
{
    CALLED(CAN_RECOVER)
    return BRACE_HAL_OK;
}

/* ------------------------------------------------------------------------------------------- serial -- */

static int32_t serial_setup(void *context, brace_serial_port_t port, uint32_t baud, brace_parity_t parity)
{
    CALLED(SERIAL_SETUP)
    if (port >= BRACE_SERIAL_PORT_COUNT || baud == 0u) {
        return BRACE_HAL_E_RANGE;
    }
    fake->baud[port] = baud;
    fake->parity[port] = parity;
    return BRACE_HAL_OK;
}

static int32_t serial_write(void *context, brace_serial_port_t port, const uint8_t *bytes, uint32_t count)
{
    CALLED(SERIAL_WRITE)
    return port < BRACE_SERIAL_PORT_COUNT ? (int32_t)fake_bytes_put(&fake->serial_sent[port], bytes, count)
                                          : BRACE_HAL_E_RANGE;
}

/* Bytes of the first ADU of a connection; 0: none has come whole. */
static uint32_t first_adu(const brace_fake_bytes_t *received)
{
    enum { HEADER = 6 };
    const uint8_t high = received->byte[(received->first + 4u) % BRACE_FAKE_SERIAL_BYTES];
    const uint8_t low = received->byte[(received->first + 5u) % BRACE_FAKE_SERIAL_BYTES];
    const uint32_t whole = HEADER + ((uint32_t)high << 8 | low);
    return received->count >= HEADER && received->count >= whole ? whole : 0u;
}

static int32_t read_connections(brace_fake_t *fake, uint8_t *bytes, uint32_t room)
{
    for (uint32_t i = 1; i <= BRACE_FAKE_CONNECTIONS && fake->left_of_adu == 0u; i++) {
        const uint32_t next = (fake->reads_from + i) % BRACE_FAKE_CONNECTIONS;
        fake->left_of_adu = first_adu(&fake->connection[next].received);
        if (fake->left_of_adu > 0u) {
            fake->reads_from = fake->peer = next;
        }
    }
    const uint32_t most = room < fake->left_of_adu ? room : fake->left_of_adu;
    const uint32_t given = fake_bytes_take(&fake->connection[fake->reads_from].received, bytes, most);
    fake->left_of_adu -= given;
    return (int32_t)given;
}

static int32_t serial_read(void *context, brace_serial_port_t port, uint8_t *bytes, uint32_t room)
{
    CALLED(SERIAL_READ)
    if (port == BRACE_SERIAL_MODBUS_TCP && fake->hal.serial_write_to != NULL) {
        return read_connections(fake, bytes, room);
    }
    return port < BRACE_SERIAL_PORT_COUNT ? (int32_t)fake_bytes_take(&fake->serial_received[port], bytes, room)
                                          : BRACE_HAL_E_RANGE;
}

static uint32_t serial_peer(void *context, brace_serial_port_t port)
{
    const brace_fake_t *fake = context;
    return port == BRACE_SERIAL_MODBUS_TCP ? fake->peer : 0u;
}

static bool serial_peer_is_open(void *context, brace_serial_port_t port, uint32_t peer)
{
    const brace_fake_t *fake = context;
    return port != BRACE_SERIAL_MODBUS_TCP || peer >= fake->open_from;
}

static int32_t serial_write_to(void *context, brace_serial_port_t port, uint32_t peer, const uint8_t *bytes,
                               uint32_t count)
{
    CALLED(SERIAL_WRITE)
    if (port != BRACE_SERIAL_MODBUS_TCP || peer >= BRACE_FAKE_CONNECTIONS) {
        return BRACE_HAL_E_RANGE;
    }
    brace_fake_bytes_t *sent = &fake->connection[peer].sent;
    return sent->count + count <= BRACE_FAKE_SERIAL_BYTES ? (int32_t)fake_bytes_put(sent, bytes, count) : 0;
}

void brace_fake_with_connections(brace_fake_t *fake)
{
    brace_fake_with_peers(fake);
    fake->hal.serial_write_to = serial_write_to;
}

bool brace_fake_adu_arrives(brace_fake_t *fake, uint32_t connection, const uint8_t *bytes, uint32_t count)
{
    brace_fake_bytes_t *received = &fake->connection[connection].received;
    return received->count + count <= BRACE_FAKE_SERIAL_BYTES && fake_bytes_put(received, bytes, count) == count;
}

void brace_fake_with_peers(brace_fake_t *fake)
{
    fake->hal.serial_peer = serial_peer;
    fake->hal.serial_peer_is_open = serial_peer_is_open;
}

/* ---------------------------------------------------------------------------------------------- key -- */

static int32_t key_read(void *context, uint8_t key[BRACE_HAL_KEY_BYTES])
{
    const brace_fake_t *fake = context;
    for (uint32_t i = 0; i < (uint32_t)BRACE_HAL_KEY_BYTES && fake->has_key; i++) {
        key[i] = fake->key[i];
    }
    return fake->has_key ? BRACE_HAL_KEY_LOCKED : BRACE_HAL_KEY_NONE;
}

static int32_t key_write(void *context, const uint8_t key[BRACE_HAL_KEY_BYTES])
{
    brace_fake_t *fake = context;
    if (fake->has_key) {
        return BRACE_HAL_E_RANGE;
    }
    for (uint32_t i = 0; i < (uint32_t)BRACE_HAL_KEY_BYTES; i++) {
        fake->key[i] = key[i];
    }
    fake->has_key = true;
    return BRACE_HAL_OK;
}

static int32_t random_read(void *context, uint32_t *word)
{
    brace_fake_t *fake = context;
    fake->random = 1664525u * fake->random + 1013904223u;
    *word = fake->random;
    return BRACE_HAL_OK;
}

void brace_fake_guarded(brace_fake_t *fake, const uint8_t key[BRACE_HAL_KEY_BYTES])
{
    fake->hal.key_read = key_read;
    fake->hal.key_write = key_write;
    fake->hal.random_read = random_read;
    fake->has_key = false;
    if (key != NULL) {
        (void)key_write(fake, key);
    }
}

/* ------------------------------------------------------------------------------------------- system -- */

static void watchdog_feed(void *context)
{
    brace_fake_t *fake = context;
    fake->calls[BRACE_FAKE_WATCHDOG_FEED]++;
}

static brace_reset_cause_t reset_cause(void *context)
{
    const brace_fake_t *fake = context;
    return fake->reset_cause;
}

static int32_t crash_read(void *context, brace_crash_record_t *record)
{
    CALLED(CRASH_READ)
    if (fake->crashed) {
        *record = fake->crash;
    }
    return fake->crashed ? 1 : 0;
}

static void crash_clear(void *context)
{
    brace_fake_t *fake = context;
    fake->crashed = false;
}

static uint32_t stack_unused_bytes(void *context)
{
    const brace_fake_t *fake = context;
    return fake->stack_unused_bytes;
}

static void restart(void *context)
{
    brace_fake_t *fake = context;
    fake->calls[BRACE_FAKE_RESTART]++;
}

void fake_door_fill(brace_fake_t *fake)
{
    fake->hal = (brace_hal_t){.context = fake,
                              .board = "fake",
                              .now_us = now_us,
                              .joint_read = joint_read,
                              .joint_command = joint_command,
                              .tip_force_read = tip_force_read,
                              .nvm_shape = {BRACE_FAKE_SLOT_BYTES, 4},
                              .nvm_read = nvm_read,
                              .nvm_write = nvm_write,
                              .nvm_erase = nvm_erase,
                              .can_setup = can_setup,
                              .can_send = can_send,
                              .can_receive = can_receive,
                              .can_health = can_health,
                              .can_recover = can_recover,
                              .serial_setup = serial_setup,
                              .serial_write = serial_write,
                              .serial_read = serial_read,
                              .watchdog_feed = watchdog_feed,
                              .reset_cause = reset_cause,
                              .crash_read = crash_read,
                              .crash_clear = crash_clear,
                              .stack_unused_bytes = stack_unused_bytes,
                              .restart = restart};
}
