/* The port self-test against a door that tells the truth, and against one that tells one lie at a time: each lie
 * must be named, in words that point at it, and nothing else may be blamed before it. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "brace_hal_blank.h"
#include "brace_hal_selftest.h"
#include "unity.h"

enum { SLOT_BYTES = 4096, UNIT = 4, FRAMES_MAX = 8, FINDINGS_MAX = 80, JOINTS = 3 };

typedef enum {
    TRUTH,
    CLOCK_STANDS,
    CLOCK_RUNS_BACK,
    CLOCK_COARSE,
    CLOCK_FAST,
    CLOCK_SLOW,
    JOINT_MISSING,
    JOINT_DEVICE,
    JOINT_AGAIN_FOR_EVER,
    JOINT_NAN,
    JOINT_DEGREES,
    JOINT_STALE,
    JOINT_FUTURE,
    JOINT_SAME_SAMPLE,
    JOINT_STUCK,
    JOINT_INDEX_UNCHECKED,
    COMMAND_REFUSED,
    COMMAND_INDEX_UNCHECKED,
    FORCE_AGAIN_FOR_EVER,
    FORCE_NAN,
    NVM_SMALL,
    NVM_ODD_UNIT,
    NVM_UNIT_TOO_SMALL,
    NVM_UNIT_TOO_LARGE,
    NVM_FORGETS,
    NVM_ALIASES,
    NVM_ERASES_TO_ZERO,
    NVM_ERASES_HALF,
    NVM_ERASES_BOTH,
    NVM_NO_BOUNDS,
    NVM_PROTECTED,
    NVM_OFF_GRID,
    CAN_HALF,
    CAN_DEAF,
    CAN_SCRAMBLES,
    CAN_REORDERS,
    CAN_BUSY,
    CAN_REFUSES,
    CAN_TAKES_ANYTHING,
    CAN_BUS_OFF,
    SERIAL_OVERRUNS,
    SERIAL_PORT_UNCHECKED,
    SERIAL_REFUSES,
    RESET_CAUSE_UNKNOWN,
    CRASH_ANSWER,
    LIES
} lie_t;

typedef struct {
    lie_t lie;
    uint32_t us, reads, fed;
    uint8_t nvm[BRACE_NVM_SLOT_COUNT][SLOT_BYTES];
    brace_can_frame_t frames[FRAMES_MAX];
    uint32_t queued, taken, early_counts;
    bool loopback, moves;
} world_t;

static world_t world;
static brace_hal_t door;

static brace_selftest_finding_t findings[FINDINGS_MAX];
static uint32_t finding_count;

/* --- a door ---------------------------------------------------------------------------------------------------- */

static uint32_t now_us(void *context)
{
    (void)context;
    world.reads++;
    switch (world.lie) {
    case CLOCK_STANDS: return 7u;
    case CLOCK_RUNS_BACK: world.us += world.reads % 1000u == 0u ? 0u - 50u : 1u; break;
    case CLOCK_COARSE: world.us += world.reads % 50u == 0u ? 1000u : 0u; break;
    default: world.us += 1u; break;
    }
    return world.us;
}

/* The second clock: a falling count of 16 bits at 1 MHz, which passes through zero. now_us is its judge's own cause of
 * time here, so a wrong rate is a wrong count. */
static uint32_t falling_count(void *context)
{
    (void)context;
    const uint32_t us = world.us;
    return (100u - (world.lie == CLOCK_FAST ? us / 8u * 7u : world.lie == CLOCK_SLOW ? 2u * us : us)) & 0xffffu;
}

/* As if an emulator had been away between the first readings of now_us and of the count: the window is over before the
 * count has moved. */
static uint32_t count_after_a_pause(void *context)
{
    if (world.early_counts > 0u) {
        world.early_counts--;
        return 77u;
    }
    return falling_count(context);
}

static uint32_t standing_count(void *context)
{
    (void)context;
    return 77u;
}

static int32_t joint_read(void *context, int32_t index, brace_hal_joint_t *joint)
{
    (void)context;
    if (index < 0 || index >= JOINTS) {
        if (world.lie == JOINT_INDEX_UNCHECKED) {
            joint->motor_rad = 0.0f;
        }
        return BRACE_HAL_E_UNSUPPORTED;
    }
    if (index == 0 || (index == 1 && world.lie == JOINT_MISSING)) {
        return BRACE_HAL_E_UNSUPPORTED;
    }
    const bool lying = index == 1;
    if (lying && world.lie == JOINT_DEVICE) {
        return BRACE_HAL_E_DEVICE;
    }
    const uint32_t now = world.lie == CLOCK_STANDS ? 7u : world.us;
    *joint = (brace_hal_joint_t){.motor_rad = 1.0f, .link_rad = NAN, .temp_degc = NAN, .taken_us = now};
    if (world.moves && !(lying && world.lie == JOINT_STUCK)) {
        joint->motor_rad += 1e-6f * (float)(now % 1000u);
    }
    if (!lying) {
        return BRACE_HAL_OK;
    }
    switch (world.lie) {
    case JOINT_AGAIN_FOR_EVER: return BRACE_HAL_AGAIN;
    case JOINT_NAN: joint->torque_n_mm = NAN; break;
    case JOINT_DEGREES: joint->motor_rad = 57.3f; break;
    case JOINT_STALE: joint->taken_us = now - 30000u; break;
    case JOINT_FUTURE: joint->taken_us = now + 5000u; break;
    case JOINT_SAME_SAMPLE: joint->taken_us = 1u; break;
    default: break;
    }
    return BRACE_HAL_OK;
}

static int32_t joint_command(void *context, int32_t index, const brace_hal_joint_command_t *command)
{
    (void)context;
    (void)command;
    if (world.lie == COMMAND_REFUSED) {
        return BRACE_HAL_E_DEVICE;
    }
    return index < JOINTS || world.lie == COMMAND_INDEX_UNCHECKED ? BRACE_HAL_OK : BRACE_HAL_E_UNSUPPORTED;
}

static int32_t tip_force_read(void *context, float *force_x_n, float *force_z_n)
{
    (void)context;
    *force_x_n = world.lie == FORCE_NAN ? NAN : 1.0f;
    *force_z_n = 2.0f;
    return world.lie == FORCE_AGAIN_FOR_EVER ? BRACE_HAL_AGAIN : BRACE_HAL_OK;
}

static bool outside(uint32_t slot, uint32_t offset, uint32_t count)
{
    return slot >= BRACE_NVM_SLOT_COUNT || offset > SLOT_BYTES || count > SLOT_BYTES - offset;
}

static uint8_t *nvm_at(uint32_t slot, uint32_t offset)
{
    return &world.nvm[slot][world.lie == NVM_ALIASES ? offset % 1024u : offset];
}

static int32_t nvm_read(void *context, uint32_t slot, uint32_t offset, uint8_t *bytes, uint32_t count)
{
    (void)context;
    if (outside(slot, offset, count)) {
        memset(bytes, 0, count <= UNIT ? count : 0u);
        return world.lie == NVM_NO_BOUNDS ? BRACE_HAL_OK : BRACE_HAL_E_RANGE;
    }
    for (uint32_t i = 0u; i < count; i++) {
        bytes[i] = *nvm_at(slot, offset + i);
    }
    return BRACE_HAL_OK;
}

static int32_t nvm_write(void *context, uint32_t slot, uint32_t offset, const uint8_t *bytes, uint32_t count)
{
    (void)context;
    const bool off_grid = offset % UNIT != 0u || count % UNIT != 0u;
    if (world.lie == NVM_UNIT_TOO_SMALL || world.lie == NVM_UNIT_TOO_LARGE) {
        /* The device knows units of 4 only, whatever the shape says: it fills up what is not given. */
        for (uint32_t i = offset - offset % UNIT; i < offset - offset % UNIT + UNIT; i++) {
            *nvm_at(slot, i) = i >= offset && i < offset + count ? bytes[i - offset] : 0u;
        }
        return BRACE_HAL_OK;
    }
    if (outside(slot, offset, count) || (off_grid && world.lie != NVM_OFF_GRID)) {
        return BRACE_HAL_E_RANGE;
    }
    for (uint32_t i = 0u; i < count && !(world.lie == NVM_FORGETS && offset >= 2048u); i++) {
        *nvm_at(slot, offset + i) &= bytes[i];
    }
    return BRACE_HAL_OK;
}

static int32_t nvm_erase(void *context, uint32_t slot)
{
    (void)context;
    if (world.lie == NVM_PROTECTED) {
        return BRACE_HAL_E_DEVICE;
    }
    memset(world.nvm[slot], world.lie == NVM_ERASES_TO_ZERO ? 0 : 0xff,
        world.lie == NVM_ERASES_HALF ? SLOT_BYTES / 2u : SLOT_BYTES);
    if (world.lie == NVM_ERASES_BOTH) {
        memset(world.nvm[1u - slot], 0xff, SLOT_BYTES);
    }
    return BRACE_HAL_OK;
}

static int32_t can_setup(void *context, const brace_can_setup_t *setup)
{
    (void)context;
    world.loopback = setup->loopback;
    return world.lie == CAN_REFUSES ? BRACE_HAL_E_DEVICE : BRACE_HAL_OK;
}

static int32_t can_send(void *context, const brace_can_frame_t *frame)
{
    (void)context;
    if (world.lie == CAN_BUSY) {
        return BRACE_HAL_AGAIN;
    }
    if (world.lie != CAN_TAKES_ANYTHING && (frame->id > 0x7ffu || frame->length > 8u)) {
        return BRACE_HAL_E_RANGE;
    }
    if (world.loopback && world.queued < FRAMES_MAX) {
        const uint32_t place = world.lie == CAN_REORDERS ? 2u - world.queued % 3u : world.queued;
        world.frames[place] = *frame;
        world.frames[place].data[3] ^= world.lie == CAN_SCRAMBLES ? 1u : 0u;
        world.queued++;
    }
    return BRACE_HAL_OK;
}

static int32_t can_receive(void *context, brace_can_frame_t *frame)
{
    (void)context;
    if (world.taken == world.queued || world.lie == CAN_DEAF) {
        return 0;
    }
    *frame = world.frames[world.taken++];
    return 1;
}

static int32_t can_health(void *context, brace_can_health_t *health)
{
    (void)context;
    *health = (brace_can_health_t){.bus_off = world.lie == CAN_BUS_OFF};
    return BRACE_HAL_OK;
}

static int32_t can_recover(void *context)
{
    (void)context;
    return BRACE_HAL_OK;
}

static int32_t serial_setup(void *context, brace_serial_port_t port, uint32_t baud, brace_parity_t parity)
{
    (void)context;
    (void)baud;
    (void)parity;
    if ((uint32_t)port >= BRACE_SERIAL_PORT_COUNT) {
        return world.lie == SERIAL_PORT_UNCHECKED ? BRACE_HAL_OK : BRACE_HAL_E_UNSUPPORTED;
    }
    return world.lie == SERIAL_REFUSES && port == BRACE_SERIAL_MODBUS ? BRACE_HAL_E_RANGE : BRACE_HAL_OK;
}

static int32_t serial_write(void *context, brace_serial_port_t port, const uint8_t *bytes, uint32_t count)
{
    (void)context;
    (void)port;
    (void)bytes;
    return (int32_t)count;
}

static int32_t serial_read(void *context, brace_serial_port_t port, uint8_t *bytes, uint32_t room)
{
    (void)context;
    if (world.lie == SERIAL_OVERRUNS && port == BRACE_SERIAL_SLCAN) {
        bytes[room] = 0u;
        return (int32_t)room + 1;
    }
    return 0;
}

static void watchdog_feed(void *context)
{
    (void)context;
    world.fed++;
}

static brace_reset_cause_t reset_cause(void *context)
{
    (void)context;
    return world.lie == RESET_CAUSE_UNKNOWN ? (brace_reset_cause_t)9 : BRACE_RESET_POWER;
}

static int32_t crash_read(void *context, brace_crash_record_t *record)
{
    (void)context;
    (void)record;
    return world.lie == CRASH_ANSWER ? -4 : 0;
}

static void crash_clear(void *context)
{
    (void)context;
}

static uint32_t stack_unused_bytes(void *context)
{
    (void)context;
    return 1000u;
}

static void restart(void *context)
{
    (void)context;
}

static void open_door(lie_t lie)
{
    memset(&world, 0, sizeof world);
    memset(world.nvm, 0xa5, sizeof world.nvm);
    world.lie = lie;
    world.us = UINT32_MAX - 20000u; /* the clock wraps during the test */
    door = (brace_hal_t){
        .board = "liar",
        .now_us = now_us,
        .joint_read = joint_read,
        .joint_command = joint_command,
        .tip_force_read = tip_force_read,
        .nvm_shape = {.slot_bytes = lie == NVM_SMALL ? 2048u : SLOT_BYTES,
            .write_bytes = lie == NVM_ODD_UNIT ? 3u
                : lie == NVM_UNIT_TOO_SMALL    ? 2u
                : lie == NVM_UNIT_TOO_LARGE    ? 8u
                                               : UNIT},
        .nvm_read = nvm_read,
        .nvm_write = nvm_write,
        .nvm_erase = nvm_erase,
        .can_setup = can_setup,
        .can_send = can_send,
        .can_receive = can_receive,
        .can_health = can_health,
        .can_recover = lie == CAN_HALF ? NULL : can_recover,
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

static void keep(void *context, const brace_selftest_finding_t *finding)
{
    TEST_ASSERT_EQUAL_PTR(&world, context);
    TEST_ASSERT_LESS_THAN_UINT32(FINDINGS_MAX, finding_count);
    findings[finding_count++] = *finding;
}

static brace_selftest_setup_t setup_of(int32_t scratch_slot)
{
    finding_count = 0u;
    return (brace_selftest_setup_t){
        .report = keep,
        .report_context = &world,
        .scratch_slot = scratch_slot,
        .joints_are_moved = world.moves,
        .reference_count = falling_count,
        .reference_hz = 1000000u,
        .reference_bits = 16u,
        .reference_falls = true,
    };
}

static const brace_selftest_finding_t *first_failure(void)
{
    for (uint32_t i = 0u; i < finding_count; i++) {
        if (findings[i].verdict == BRACE_SELFTEST_FAIL) {
            return &findings[i];
        }
    }
    return NULL;
}

static bool is_told(const char *entry, const char *words)
{
    for (uint32_t i = 0u; i < finding_count; i++) {
        if (findings[i].verdict == BRACE_SELFTEST_FAIL && strcmp(findings[i].entry, entry) == 0 &&
            strstr(findings[i].what, words) != NULL) {
            return true;
        }
    }
    return false;
}

void setUp(void) {}
void tearDown(void) {}

static void the_truth_passes(void)
{
    for (int32_t slot = 0; slot < BRACE_NVM_SLOT_COUNT; slot++) {
        open_door(TRUTH);
        world.moves = true;
        const brace_selftest_setup_t setup = setup_of(slot);
        brace_selftest_result_t result;
        TEST_ASSERT_EQUAL_INT32(0, brace_selftest_run(&door, &setup, &result));
        TEST_ASSERT_EQUAL_PTR(NULL, first_failure());
        TEST_ASSERT_EQUAL_UINT16(0u, result.failed);
        TEST_ASSERT_EQUAL_UINT32(finding_count, (uint32_t)(result.passed + result.noted));
        TEST_ASSERT_EQUAL_UINT16(1u, result.noted); /* the coxa: a limb in a plane */
        TEST_ASSERT_TRUE(world.fed >= 4u);
        TEST_ASSERT_EACH_EQUAL_HEX8(0xff, world.nvm[slot], SLOT_BYTES);
        TEST_ASSERT_EACH_EQUAL_HEX8(0xa5, world.nvm[1 - slot], SLOT_BYTES);
        TEST_ASSERT_FALSE(world.loopback);
    }
}

typedef struct {
    lie_t lie;
    const char *entry, *words;
} named_t;

static const named_t named[] = {
    {CLOCK_STANDS, "now_us", "stands still"},
    {CLOCK_RUNS_BACK, "now_us", "backwards"},
    {CLOCK_COARSE, "now_us", "too coarse"},
    {CLOCK_FAST, "now_us", "wrong rate"},
    {CLOCK_SLOW, "now_us", "wrong rate"},
    {JOINT_MISSING, "joint_read(1)", "no such joint"},
    {JOINT_DEVICE, "joint_read(1)", "device refuses"},
    {JOINT_AGAIN_FOR_EVER, "joint_read(1)", "AGAIN for ever"},
    {JOINT_NAN, "joint_read(1)", "not finite"},
    {JOINT_DEGREES, "joint_read(1)", "degrees"},
    {JOINT_STALE, "joint_read(1)", "taken_us"},
    {JOINT_FUTURE, "joint_read(1)", "taken_us"},
    {JOINT_SAME_SAMPLE, "joint_read(1)", "the same sample"},
    {JOINT_STUCK, "joint_read(1)", "stuck"},
    {JOINT_INDEX_UNCHECKED, "joint_read", "joint -1 or 3"},
    {COMMAND_REFUSED, "joint_command", "refuses an offset of 0"},
    {COMMAND_INDEX_UNCHECKED, "joint_command", "joint 3 is accepted"},
    {FORCE_AGAIN_FOR_EVER, "tip_force_read", "no sample in 50 ms"},
    {FORCE_NAN, "tip_force_read", "not finite"},
    {NVM_SMALL, "nvm_shape", "less than 4096"},
    {NVM_ODD_UNIT, "nvm_shape", "not 1, 2, 4 or 8"},
    {NVM_UNIT_TOO_SMALL, "nvm_shape", "unit's size lies"},
    {NVM_UNIT_TOO_LARGE, "nvm_shape", "unit's size lies"},
    {NVM_FORGETS, "nvm_write", "does not keep"},
    {NVM_ALIASES, "nvm_write", "offsets that alias"},
    {NVM_ERASES_TO_ZERO, "nvm_erase", "does not leave 0xff"},
    {NVM_ERASES_HALF, "nvm_erase", "does not leave 0xff"},
    {NVM_ERASES_BOTH, "nvm_erase", "the other slot changed"},
    {NVM_NO_BOUNDS, "nvm_read", "not refused with E_RANGE"},
    {NVM_PROTECTED, "nvm_erase", "write-protected"},
    {NVM_OFF_GRID, "nvm_write", "off the grid"},
    {CAN_HALF, "can", "half filled"},
    {CAN_DEAF, "can_receive", "do not come back"},
    {CAN_SCRAMBLES, "can_receive", "changed or out of order"},
    {CAN_REORDERS, "can_receive", "changed or out of order"},
    {CAN_BUSY, "can_send", "takes no frame"},
    {CAN_REFUSES, "can_setup", "is refused"},
    {CAN_TAKES_ANYTHING, "can_send", "12 bits or 9 bytes"},
    {CAN_BUS_OFF, "can_health", "bus off"},
    {SERIAL_OVERRUNS, "serial(slcan)", "room given"},
    {SERIAL_PORT_UNCHECKED, "serial_setup", "port 4"},
    {SERIAL_REFUSES, "serial(modbus)", "refused"},
    {RESET_CAUSE_UNKNOWN, "reset_cause", "does not have"},
    {CRASH_ANSWER, "crash_read", "neither 0 nor 1"},
};

static void every_lie_is_named(void)
{
    TEST_ASSERT_EQUAL_UINT32(LIES - 1u, sizeof named / sizeof named[0]);
    for (uint32_t i = 0u; i < sizeof named / sizeof named[0]; i++) {
        char which[24];
        snprintf(which, sizeof which, "lie %d", (int)named[i].lie);
        open_door(named[i].lie);
        world.moves = named[i].lie == JOINT_STUCK;
        const brace_selftest_setup_t setup = setup_of(1);
        const int32_t failures = brace_selftest_run(&door, &setup, NULL);
        TEST_ASSERT_GREATER_THAN_INT32_MESSAGE(0, failures, which);
        TEST_ASSERT_NOT_NULL_MESSAGE(first_failure(), which);
        TEST_ASSERT_EQUAL_STRING_MESSAGE(named[i].entry, first_failure()->entry, which);
        TEST_ASSERT_TRUE_MESSAGE(is_told(named[i].entry, named[i].words), which);
    }
}

/* Each entry that is not optional, taken away alone. */
static void every_null_is_named(void)
{
    static const struct {
        size_t at;
        const char *entry;
    } entries[] = {
        {offsetof(brace_hal_t, board), "board"},
        {offsetof(brace_hal_t, now_us), "now_us"},
        {offsetof(brace_hal_t, joint_read), "joint_read"},
        {offsetof(brace_hal_t, nvm_read), "nvm_read"},
        {offsetof(brace_hal_t, nvm_write), "nvm_write"},
        {offsetof(brace_hal_t, nvm_erase), "nvm_erase"},
        {offsetof(brace_hal_t, serial_setup), "serial_setup"},
        {offsetof(brace_hal_t, serial_write), "serial_write"},
        {offsetof(brace_hal_t, serial_read), "serial_read"},
        {offsetof(brace_hal_t, watchdog_feed), "watchdog_feed"},
        {offsetof(brace_hal_t, reset_cause), "reset_cause"},
        {offsetof(brace_hal_t, crash_read), "crash_read"},
        {offsetof(brace_hal_t, crash_clear), "crash_clear"},
        {offsetof(brace_hal_t, stack_unused_bytes), "stack_unused_bytes"},
        {offsetof(brace_hal_t, restart), "restart"},
    };
    for (uint32_t i = 0u; i < sizeof entries / sizeof entries[0]; i++) {
        open_door(TRUTH);
        memset((uint8_t *)&door + entries[i].at, 0, sizeof(void *));
        const brace_selftest_setup_t setup = setup_of(0);
        TEST_ASSERT_EQUAL_INT32(1, brace_selftest_run(&door, &setup, NULL));
        TEST_ASSERT_EQUAL_STRING(entries[i].entry, first_failure()->entry);
    }
}

static void memory_is_kept_when_asked(void)
{
    open_door(TRUTH);
    const brace_selftest_setup_t setup = setup_of(BRACE_SELFTEST_KEEP_NVM);
    TEST_ASSERT_EQUAL_INT32(0, brace_selftest_run(&door, &setup, NULL));
    TEST_ASSERT_EACH_EQUAL_HEX8(0xa5, world.nvm, sizeof world.nvm);
}

static void what_is_optional_may_be_absent(void)
{
    open_door(TRUTH);
    door.joint_command = NULL;
    door.tip_force_read = NULL;
    door.can_setup = NULL;
    door.can_send = NULL;
    door.can_receive = NULL;
    door.can_health = NULL;
    door.can_recover = NULL;
    TEST_ASSERT_EQUAL_INT32(0, brace_selftest_run(&door, NULL, NULL));
}

static bool is_found(brace_selftest_verdict_t verdict, const char *words)
{
    bool found = false;
    for (uint32_t i = 0u; i < finding_count; i++) {
        found = found || (findings[i].verdict == verdict && strstr(findings[i].what, words) != NULL);
    }
    return found;
}

static void the_other_clock_stands_only_when_it_always_does(void)
{
    open_door(TRUTH);
    world.early_counts = 2u; /* at the start and the end of the first attempt */
    brace_selftest_setup_t setup = setup_of(0);
    setup.reference_count = count_after_a_pause;
    TEST_ASSERT_EQUAL_INT32(0, brace_selftest_run(&door, &setup, NULL));
    TEST_ASSERT_EQUAL_UINT32(0u, world.early_counts);
    TEST_ASSERT_TRUE(is_found(BRACE_SELFTEST_PASS, "rate agrees"));
    open_door(TRUTH);
    setup = setup_of(0);
    setup.reference_count = standing_count;
    TEST_ASSERT_EQUAL_INT32(0, brace_selftest_run(&door, &setup, NULL));
    TEST_ASSERT_TRUE(is_found(BRACE_SELFTEST_NOTE, "the other clock stands"));
}

static void impossible_requests_are_refused(void)
{
    open_door(TRUTH);
    brace_selftest_result_t result = {.passed = 77u};
    TEST_ASSERT_EQUAL_INT32(BRACE_HAL_E_RANGE, brace_selftest_run(NULL, NULL, &result));
    brace_selftest_setup_t setup = setup_of(BRACE_NVM_SLOT_COUNT);
    TEST_ASSERT_EQUAL_INT32(BRACE_HAL_E_RANGE, brace_selftest_run(&door, &setup, &result));
    setup = setup_of(-2);
    TEST_ASSERT_EQUAL_INT32(BRACE_HAL_E_RANGE, brace_selftest_run(&door, &setup, &result));
    setup = setup_of(0);
    setup.reference_bits = 33u;
    TEST_ASSERT_EQUAL_INT32(BRACE_HAL_E_RANGE, brace_selftest_run(&door, &setup, &result));
    TEST_ASSERT_EQUAL_UINT16(77u, result.passed);
    TEST_ASSERT_EQUAL_UINT32(0u, finding_count);
}

/* The porter's start: everything is named that is still to be filled in, and it ends. */
static void the_blank_door_is_told_what_it_lacks(void)
{
    open_door(TRUTH);
    const brace_selftest_setup_t setup = setup_of(0);
    const int32_t failures = brace_selftest_run(brace_hal_blank(), &setup, NULL);
    static const char *const lacking[] = {"now_us", "joint_read(1)", "joint_read(2)", "nvm_shape"};
    for (uint32_t i = 0u; i < sizeof lacking / sizeof lacking[0]; i++) {
        TEST_ASSERT_TRUE_MESSAGE(is_told(lacking[i], ""), lacking[i]);
    }
    TEST_ASSERT_GREATER_OR_EQUAL_INT32(4, failures);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(the_truth_passes);
    RUN_TEST(every_lie_is_named);
    RUN_TEST(every_null_is_named);
    RUN_TEST(memory_is_kept_when_asked);
    RUN_TEST(what_is_optional_may_be_absent);
    RUN_TEST(the_other_clock_stands_only_when_it_always_does);
    RUN_TEST(impossible_requests_are_refused);
    RUN_TEST(the_blank_door_is_told_what_it_lacks);
    return UNITY_END();
}
