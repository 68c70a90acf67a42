/* The port self-test against a door that reports the truth, with entries left out, and when it is asked for what can
 * not be. What it makes of lies: test_hal_selftest_*.c. */
#include "brace_hal_blank.h"
#include "selftest_door.h"

static void the_truth_passes(void)
{
    for (int32_t slot = 0; slot < BRACE_NVM_SLOT_COUNT; slot++) {
        open_door();
        world.moves = world.limb_is_free = true;
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
        open_door();
        memset((uint8_t *)&door + entries[i].at, 0, sizeof(void *));
        const brace_selftest_setup_t setup = setup_of(0);
        TEST_ASSERT_EQUAL_INT32(1, brace_selftest_run(&door, &setup, NULL));
        TEST_ASSERT_EQUAL_STRING(entries[i].entry, first_failure()->entry);
    }
}

/* Not even for no offset: that moves a joint that had another. */
static void no_joint_is_commanded_unless_the_limb_is_free(void)
{
    for (uint32_t free = 0u; free < 2u; free++) {
        open_door();
        world.limb_is_free = free == 1u;
        const brace_selftest_setup_t setup = setup_of(0);
        brace_selftest_result_t result;
        TEST_ASSERT_EQUAL_INT32(0, brace_selftest_run(&door, &setup, &result));
        TEST_ASSERT_EQUAL_UINT32(2u * free, world.commands);
    }
    open_door();
    TEST_ASSERT_EQUAL_INT32(0, brace_selftest_run(&door, NULL, NULL));
    TEST_ASSERT_EQUAL_UINT32(0u, world.commands);
}

/* Joints behind a line that the board serves between ticks. */
static void a_line_is_served_while_a_check_waits(void)
{
    for (uint32_t served = 0u; served < 2u; served++) {
        open_door();
        world.is_line = true;
        brace_selftest_setup_t setup = setup_of(BRACE_SELFTEST_KEEP_NVM);
        setup.serve = served == 1u ? serve : NULL;
        (void)brace_selftest_run(&door, &setup, NULL);
        TEST_ASSERT_EQUAL(served == 0u, is_reported("joint_read(1)", "AGAIN for ever"));
    }
}

static void memory_is_kept_when_asked(void)
{
    open_door();
    const brace_selftest_setup_t setup = setup_of(BRACE_SELFTEST_KEEP_NVM);
    TEST_ASSERT_EQUAL_INT32(0, brace_selftest_run(&door, &setup, NULL));
    TEST_ASSERT_EACH_EQUAL_HEX8(0xa5, world.nvm, sizeof world.nvm);
}

static void what_is_optional_may_be_absent(void)
{
    open_door();
    door.joint_command = NULL;
    door.tip_force_read = NULL;
    door.can_setup = NULL;
    door.can_send = NULL;
    door.can_receive = NULL;
    door.can_health = NULL;
    door.can_recover = NULL;
    TEST_ASSERT_EQUAL_INT32(0, brace_selftest_run(&door, NULL, NULL));
}

static void impossible_requests_are_refused(void)
{
    open_door();
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
static void what_the_blank_door_lacks_is_reported(void)
{
    open_door();
    const brace_selftest_setup_t setup = setup_of(0);
    const int32_t failures = brace_selftest_run(brace_hal_blank(), &setup, NULL);
    static const char *const lacking[] = {"now_us", "joint_read(1)", "joint_read(2)", "nvm_shape"};
    for (uint32_t i = 0u; i < sizeof lacking / sizeof lacking[0]; i++) {
        TEST_ASSERT_TRUE_MESSAGE(is_reported(lacking[i], ""), lacking[i]);
    }
    TEST_ASSERT_GREATER_OR_EQUAL_INT32(4, failures);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(the_truth_passes);
    RUN_TEST(every_null_is_named);
    RUN_TEST(no_joint_is_commanded_unless_the_limb_is_free);
    RUN_TEST(a_line_is_served_while_a_check_waits);
    RUN_TEST(memory_is_kept_when_asked);
    RUN_TEST(what_is_optional_may_be_absent);
    RUN_TEST(impossible_requests_are_refused);
    RUN_TEST(what_the_blank_door_lacks_is_reported);
    return UNITY_END();
}
