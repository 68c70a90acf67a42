/* The port self-test, serial ports and what the board says of its last start: each lie is named, and nothing else
 * blamed before it. */
#include "selftest_door.h"

enum { SERIAL_OVERRUNS = 1, SERIAL_PORT_UNCHECKED, SERIAL_REFUSES, RESET_CAUSE_UNKNOWN, CRASH_ANSWER, LIES };

static int32_t lying_serial_setup(void *context, brace_serial_port_t port, uint32_t baud, brace_parity_t parity)
{
    if (world.lie == SERIAL_PORT_UNCHECKED) {
        return BRACE_HAL_OK;
    }
    const int32_t answer = serial_setup(context, port, baud, parity);
    return world.lie == SERIAL_REFUSES && port == BRACE_SERIAL_MODBUS ? BRACE_HAL_E_RANGE : answer;
}

static int32_t lying_serial_read(void *context, brace_serial_port_t port, uint8_t *bytes, uint32_t room)
{
    (void)context;
    if (world.lie == SERIAL_OVERRUNS && port == BRACE_SERIAL_SLCAN) {
        bytes[room] = 0u;
        return (int32_t)room + 1;
    }
    return 0;
}

static brace_reset_cause_t lying_reset_cause(void *context)
{
    (void)context;
    return world.lie == RESET_CAUSE_UNKNOWN ? (brace_reset_cause_t)9 : BRACE_RESET_POWER;
}

static int32_t lying_crash_read(void *context, brace_crash_record_t *record)
{
    (void)context;
    (void)record;
    return world.lie == CRASH_ANSWER ? -4 : 0;
}

static void open_lying(int lie)
{
    (void)lie;
    door.serial_setup = lying_serial_setup;
    door.serial_read = lying_serial_read;
    door.reset_cause = lying_reset_cause;
    door.crash_read = lying_crash_read;
}

static void each_lie_is_named(void)
{
    static const named_t named[] = {
        {SERIAL_OVERRUNS, "serial(slcan)", "room given"}, {SERIAL_PORT_UNCHECKED, "serial_setup", "port 4"},
        {SERIAL_REFUSES, "serial(modbus)", "refused"},    {RESET_CAUSE_UNKNOWN, "reset_cause", "does not have"},
        {CRASH_ANSWER, "crash_read", "neither 0 nor 1"},
    };
    TEST_ASSERT_EQUAL_UINT32(LIES - 1u, sizeof named / sizeof named[0]);
    expect_each_named(named, sizeof named / sizeof named[0], open_lying);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(each_lie_is_named);
    return UNITY_END();
}
