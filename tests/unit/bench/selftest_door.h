/* A door that reports the truth, for tests of the port self-test, and what those judge by. A test of lies opens it,
 * puts entries in place that lie as `world.lie` says, and expects each lie to be named. */
#ifndef SELFTEST_DOOR_H
#define SELFTEST_DOOR_H

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "brace_hal_selftest.h"
#include "unity.h"

enum { SLOT_BYTES = 4096, UNIT = 4, FRAMES_MAX = 8, FINDINGS_MAX = 80, JOINTS = 3 };

typedef struct {
    int lie; /* 0: none; else of the test's own list */
    uint32_t us, fed, commands;
    uint32_t count_eighths; /* of the second clock, per us: 8 in truth */
    uint8_t nvm[BRACE_NVM_SLOT_COUNT][SLOT_BYTES];
    brace_can_frame_t frames[FRAMES_MAX];
    uint32_t queued, taken;
    bool loopback, moves, limb_is_free;
    bool is_line;           /* the joints' samples come by a line that is served */
    uint32_t served;
    uint32_t filter_id, filter_mask;
} world_t;

static world_t world;
static brace_hal_t door;

static brace_selftest_finding_t findings[FINDINGS_MAX];
static uint32_t finding_count;

/* --- the door -------------------------------------------------------------------------------------------------- */

static inline uint32_t now_us(void *context)
{
    (void)context;
    return ++world.us;
}

/* The second clock: a falling count of 16 bits at 1 MHz, which passes through zero. now_us is its judge's own cause of
 * time here, so a wrong rate is a wrong count. */
static inline uint32_t falling_count(void *context)
{
    (void)context;
    return (100u - (uint32_t)((uint64_t)world.us * world.count_eighths / 8u)) & 0xffffu;
}

static inline int32_t joint_read(void *context, int32_t index, brace_hal_joint_t *joint)
{
    (void)context;
    if (index < 1 || index >= JOINTS) { /* a limb in a plane: no coxa */
        return BRACE_HAL_E_UNSUPPORTED;
    }
    if (world.is_line && world.served == 0u) {
        return BRACE_HAL_AGAIN;
    }
    world.served = 0u;
    *joint = (brace_hal_joint_t){.motor_rad = 1.0f, .link_rad = NAN, .temp_degc = NAN, .taken_us = world.us};
    joint->motor_rad += world.moves ? 1e-6f * (float)(world.us % 1000u) : 0.0f;
    return BRACE_HAL_OK;
}

static inline int32_t joint_command(void *context, int32_t index, const brace_hal_joint_command_t *command)
{
    (void)context;
    (void)command;
    world.commands++;
    return index < JOINTS ? BRACE_HAL_OK : BRACE_HAL_E_UNSUPPORTED;
}

static inline int32_t tip_force_read(void *context, float *force_x_n, float *force_z_n)
{
    (void)context;
    *force_x_n = 1.0f;
    *force_z_n = 2.0f;
    return BRACE_HAL_OK;
}

static inline bool outside(uint32_t slot, uint32_t offset, uint32_t count)
{
    return slot >= BRACE_NVM_SLOT_COUNT || offset > SLOT_BYTES || count > SLOT_BYTES - offset;
}

static inline int32_t nvm_read(void *context, uint32_t slot, uint32_t offset, uint8_t *bytes, uint32_t count)
{
    (void)context;
    if (outside(slot, offset, count)) {
        return BRACE_HAL_E_RANGE;
    }
    memcpy(bytes, &world.nvm[slot][offset], count);
    return BRACE_HAL_OK;
}

static inline int32_t nvm_write(void *context, uint32_t slot, uint32_t offset, const uint8_t *bytes, uint32_t count)
{
    (void)context;
    if (outside(slot, offset, count) || offset % UNIT != 0u || count % UNIT != 0u) {
        return BRACE_HAL_E_RANGE;
    }
    for (uint32_t i = 0u; i < count; i++) {
        world.nvm[slot][offset + i] &= bytes[i];
    }
    return BRACE_HAL_OK;
}

static inline int32_t nvm_erase(void *context, uint32_t slot)
{
    (void)context;
    memset(world.nvm[slot], 0xff, SLOT_BYTES);
    return BRACE_HAL_OK;
}

static inline int32_t can_setup(void *context, const brace_can_setup_t *setup)
{
    (void)context;
    world.loopback = setup->loopback;
    world.filter_id = setup->filter_id;
    world.filter_mask = setup->filter_mask;
    world.queued = world.taken = 0u;
    return BRACE_HAL_OK;
}

static inline bool passes(const brace_can_frame_t *frame)
{
    return ((frame->id ^ world.filter_id) & world.filter_mask) == 0u;
}

static inline int32_t can_send(void *context, const brace_can_frame_t *frame)
{
    (void)context;
    if (frame->id > 0x7ffu || frame->length > 8u) {
        return BRACE_HAL_E_RANGE;
    }
    if (world.loopback && world.queued < FRAMES_MAX && passes(frame)) {
        world.frames[world.queued++] = *frame;
    }
    return BRACE_HAL_OK;
}

static inline int32_t can_receive(void *context, brace_can_frame_t *frame)
{
    (void)context;
    if (world.taken == world.queued) {
        return 0;
    }
    *frame = world.frames[world.taken++];
    return 1;
}

static inline int32_t can_health(void *context, brace_can_health_t *health)
{
    (void)context;
    *health = (brace_can_health_t){.bus_off = false};
    return BRACE_HAL_OK;
}

static inline int32_t can_recover(void *context)
{
    (void)context;
    return BRACE_HAL_OK;
}

static inline int32_t serial_setup(void *context, brace_serial_port_t port, uint32_t baud, brace_parity_t parity)
{
    (void)context;
    (void)baud;
    (void)parity;
    return (uint32_t)port < BRACE_SERIAL_PORT_COUNT ? BRACE_HAL_OK : BRACE_HAL_E_UNSUPPORTED;
}

static inline int32_t serial_write(void *context, brace_serial_port_t port, const uint8_t *bytes, uint32_t count)
{
    (void)context;
    (void)port;
    (void)bytes;
    return (int32_t)count;
}

static inline int32_t serial_read(void *context, brace_serial_port_t port, uint8_t *bytes, uint32_t room)
{
    (void)context;
    (void)port;
    (void)bytes;
    (void)room;
    return 0;
}

static inline void watchdog_feed(void *context)
{
    (void)context;
    world.fed++;
}

static inline brace_reset_cause_t reset_cause(void *context)
{
    (void)context;
    return BRACE_RESET_POWER;
}

static inline int32_t crash_read(void *context, brace_crash_record_t *record)
{
    (void)context;
    (void)record;
    return 0;
}

static inline void crash_clear(void *context)
{
    (void)context;
}

static inline uint32_t stack_unused_bytes(void *context)
{
    (void)context;
    return 1000u;
}

static inline void restart(void *context)
{
    (void)context;
}

void setUp(void) {} /* every lie has a door opened for it */
void tearDown(void) {}

static inline void open_door(void)
{
    memset(&world, 0, sizeof world);
    memset(world.nvm, 0xa5, sizeof world.nvm);
    world.count_eighths = 8u;
    world.us = UINT32_MAX - 20000u; /* the clock wraps during the test */
    door = (brace_hal_t){
        .board = "test",
        .now_us = now_us,
        .joint_read = joint_read,
        .joint_command = joint_command,
        .tip_force_read = tip_force_read,
        .nvm_shape = {.slot_bytes = SLOT_BYTES, .write_bytes = UNIT},
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
        .restart = restart,
    };
}

/* --- the judge -------------------------------------------------------------------------------------------------- */

static inline void keep(void *context, const brace_selftest_finding_t *finding)
{
    TEST_ASSERT_EQUAL_PTR(&world, context);
    TEST_ASSERT_LESS_THAN_UINT32(FINDINGS_MAX, finding_count);
    findings[finding_count++] = *finding;
}

static inline void serve(void)
{
    world.served++;
}

static inline brace_selftest_setup_t setup_of(int32_t scratch_slot)
{
    finding_count = 0u;
    return (brace_selftest_setup_t){
        .report = keep,
        .report_context = &world,
        .scratch_slot = scratch_slot,
        .serve = serve,
        .limb_is_free = world.limb_is_free,
        .joints_are_moved = world.moves,
        .reference_count = falling_count,
        .reference_hz = 1000000u,
        .reference_bits = 16u,
        .reference_falls = true,
    };
}

static inline const brace_selftest_finding_t *first_failure(void)
{
    for (uint32_t i = 0u; i < finding_count; i++) {
        if (findings[i].verdict == BRACE_SELFTEST_FAIL) {
            return &findings[i];
        }
    }
    return NULL;
}

static inline bool is_reported(const char *entry, const char *words)
{
    for (uint32_t i = 0u; i < finding_count; i++) {
        if (findings[i].verdict == BRACE_SELFTEST_FAIL && strcmp(findings[i].entry, entry) == 0 &&
            strstr(findings[i].what, words) != NULL) {
            return true;
        }
    }
    return false;
}

typedef struct {
    int lie;
    const char *entry, *words; /* what is to be blamed first, and how */
} named_t;

static inline void expect_each_named(const named_t *named, uint32_t count, void (*open_lying)(int lie))
{
    for (uint32_t i = 0u; i < count; i++) {
        char which[24];
        snprintf(which, sizeof which, "lie %d", named[i].lie);
        open_door();
        open_lying(world.lie = named[i].lie);
        const brace_selftest_setup_t setup = setup_of(1);
        const int32_t failures = brace_selftest_run(&door, &setup, NULL);
        TEST_ASSERT_GREATER_THAN_INT32_MESSAGE(0, failures, which);
        TEST_ASSERT_NOT_NULL_MESSAGE(first_failure(), which);
        TEST_ASSERT_EQUAL_STRING_MESSAGE(named[i].entry, first_failure()->entry, which);
        TEST_ASSERT_TRUE_MESSAGE(is_reported(named[i].entry, named[i].words), which);
    }
}

#endif
