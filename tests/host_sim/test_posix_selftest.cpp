// A host's door through the port self-test: what it asks of every board it asks of this one.
#include <cmath>
#include <cstdio>

extern "C" {
#include "brace_hal_posix.h"
#include "brace_hal_selftest.h"
#include "unity.h"
}

extern "C" void setUp(void) {}
extern "C" void tearDown(void) {}

namespace {

brace_posix_t posix;
brace_posix_bus_t bus;
brace_hal_t door;

int32_t joint_read(void *, int32_t joint_index, brace_hal_joint_t *joint)
{
    if (joint_index != 1 && joint_index != 2) {
        return BRACE_HAL_E_UNSUPPORTED;
    }
    *joint = {1.0f, 0.0f, NAN, NAN, door.now_us(door.context)};
    return BRACE_HAL_OK;
}

void show_failure(void *, const brace_selftest_finding_t *finding)
{
    if (finding->verdict == BRACE_SELFTEST_FAIL) {
        std::printf("%s: %s (%d %s)\n", finding->entry, finding->what, static_cast<int>(finding->value), finding->unit);
    }
}

void passes(const char *console)
{
    brace_posix_init(&posix);
    TEST_ASSERT_EQUAL_INT32(BRACE_POSIX_OK, brace_posix_bus_open(&bus, "tcp://127.0.0.1:0"));
    TEST_ASSERT_TRUE(brace_posix_join(&posix, &bus));
    TEST_ASSERT_EQUAL_INT32(BRACE_POSIX_OK, brace_posix_stream_open(&posix.stream[BRACE_SERIAL_CONSOLE], console));
    posix.limb.joint_read = joint_read;
    brace_posix_hal(&posix, &door);
    brace_selftest_setup_t setup{};
    setup.report = show_failure;
    setup.scratch_slot = 1;
    brace_selftest_result_t result{};
    TEST_ASSERT_EQUAL_INT32(0, brace_selftest_run(&door, &setup, &result));
    TEST_ASSERT_GREATER_OR_EQUAL_UINT16(25, result.passed);
    brace_posix_close(&posix);
    brace_posix_bus_close(&bus);
}

void a_host_without_serial_ports_passes()
{
    passes("none");
}

void a_host_with_a_console_passes()
{
    passes("pty");
}

} // namespace

int main()
{
    UNITY_BEGIN();
    RUN_TEST(a_host_without_serial_ports_passes);
    RUN_TEST(a_host_with_a_console_passes);
    return UNITY_END();
}
