/* The fake board does what it says: it is what the application's tests believe. */
#include <string.h>

#include "brace_hal_fake.h"
#include "close.h"
#include "unity.h"

static brace_fake_t fake;

void setUp(void)
{
    brace_fake_start(&fake);
}

void tearDown(void) {}

static void *door(void)
{
    return fake.hal.context;
}

static void test_joints_say_what_they_were_given_and_when(void)
{
    brace_hal_joint_t joint;
    fake.now_us = 77;
    fake.joint[1].sample.motor_rad = 0.5f;
    TEST_ASSERT_EQUAL(BRACE_HAL_OK, fake.hal.joint_read(door(), 1, &joint));
    ASSERT_CLOSE(0.5, joint.motor_rad, 0.0);
    TEST_ASSERT_EQUAL(77, joint.taken_us);
    fake.now_us = 99;
    fake.joint[1].not_newer = true;
    TEST_ASSERT_EQUAL(BRACE_HAL_AGAIN, fake.hal.joint_read(door(), 1, &joint));
    TEST_ASSERT_EQUAL(77, joint.taken_us);
    fake.joint[1].absent = true;
    TEST_ASSERT_EQUAL(BRACE_HAL_E_UNSUPPORTED, fake.hal.joint_read(door(), 1, &joint));
    TEST_ASSERT_EQUAL(BRACE_HAL_E_RANGE, fake.hal.joint_read(door(), 3, &joint));
    TEST_ASSERT_EQUAL(4, fake.calls[BRACE_FAKE_JOINT_READ]);
}

static void test_calls_fail_when_they_were_set_to_and_leave_outputs_alone(void)
{
    brace_hal_joint_t joint = {.motor_rad = 9.0f};
    TEST_ASSERT_TRUE(brace_fake_fail(&fake, BRACE_FAKE_JOINT_READ, 2, 3, BRACE_HAL_E_DEVICE));
    TEST_ASSERT_EQUAL(BRACE_HAL_OK, fake.hal.joint_read(door(), 0, &joint));
    joint.motor_rad = 9.0f;
    TEST_ASSERT_EQUAL(BRACE_HAL_E_DEVICE, fake.hal.joint_read(door(), 0, &joint));
    TEST_ASSERT_EQUAL(BRACE_HAL_E_DEVICE, fake.hal.joint_read(door(), 0, &joint));
    ASSERT_CLOSE(9.0, joint.motor_rad, 0.0);
    TEST_ASSERT_EQUAL(BRACE_HAL_OK, fake.hal.joint_read(door(), 0, &joint));
    TEST_ASSERT_TRUE(brace_fake_fail_next(&fake, BRACE_FAKE_JOINT_READ, 1, BRACE_HAL_AGAIN));
    TEST_ASSERT_EQUAL(BRACE_HAL_AGAIN, fake.hal.joint_read(door(), 0, &joint));
    TEST_ASSERT_EQUAL(BRACE_HAL_OK, fake.hal.joint_read(door(), 0, &joint));
    for (int i = 2; i < BRACE_FAKE_FAILURES; i++) {
        TEST_ASSERT_TRUE(brace_fake_fail(&fake, BRACE_FAKE_NVM_READ, 1, 1, -4));
    }
    TEST_ASSERT_FALSE(brace_fake_fail(&fake, BRACE_FAKE_NVM_READ, 1, 1, -4));
}

static void test_memory_is_flash(void)
{
    uint8_t bytes[4] = {0};
    const uint8_t first[4] = {0xf0, 0x0f, 0x55, 0xaa}, second[4] = {0x3c, 0xff, 0xff, 0x00};
    TEST_ASSERT_EQUAL(BRACE_HAL_OK, fake.hal.nvm_read(door(), 1, 4092, bytes, 4));
    TEST_ASSERT_EQUAL_HEX8(0xff, bytes[0]);
    TEST_ASSERT_EQUAL(BRACE_HAL_OK, fake.hal.nvm_write(door(), 1, 8, first, 4));
    TEST_ASSERT_EQUAL(BRACE_HAL_OK, fake.hal.nvm_write(door(), 1, 8, second, 4)); /* bits only fall */
    TEST_ASSERT_EQUAL(BRACE_HAL_OK, fake.hal.nvm_read(door(), 1, 8, bytes, 4));
    const uint8_t both[4] = {0x30, 0x0f, 0x55, 0x00};
    TEST_ASSERT_EQUAL_HEX8_ARRAY(both, bytes, 4);
    TEST_ASSERT_EQUAL(BRACE_HAL_E_RANGE, fake.hal.nvm_write(door(), 1, 6, first, 4));
    TEST_ASSERT_EQUAL(BRACE_HAL_E_RANGE, fake.hal.nvm_write(door(), 1, BRACE_FAKE_SLOT_BYTES, first, 4));
    TEST_ASSERT_EQUAL(BRACE_HAL_E_RANGE, fake.hal.nvm_read(door(), 2, 0, bytes, 4));
    brace_fake_reset(&fake, BRACE_RESET_POWER);
    TEST_ASSERT_EQUAL(BRACE_HAL_OK, fake.hal.nvm_read(door(), 1, 8, bytes, 4));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(both, bytes, 4);
    TEST_ASSERT_EQUAL(BRACE_HAL_OK, fake.hal.nvm_erase(door(), 1));
    TEST_ASSERT_EQUAL_HEX8(0xff, fake.nvm[1][8]);
    fake.nvm_forgets = true;
    TEST_ASSERT_EQUAL(BRACE_HAL_OK, fake.hal.nvm_write(door(), 1, 8, first, 4));
    TEST_ASSERT_EQUAL_HEX8(0xff, fake.nvm[1][8]);
}

static void test_frames_and_bytes_queue_in_order(void)
{
    brace_can_frame_t frame = {.id = 1, .length = 1};
    TEST_ASSERT_EQUAL(BRACE_HAL_E_RANGE, fake.hal.can_send(door(), &frame)); /* before set-up */
    TEST_ASSERT_EQUAL(BRACE_HAL_OK, fake.hal.can_setup(door(), &(brace_can_setup_t){.bit_rate = 500000}));
    for (uint32_t id = 1; id <= BRACE_FAKE_FRAMES; id++) {
        frame.id = id;
        TEST_ASSERT_EQUAL(BRACE_HAL_OK, fake.hal.can_send(door(), &frame));
    }
    TEST_ASSERT_EQUAL(BRACE_HAL_AGAIN, fake.hal.can_send(door(), &frame));
    TEST_ASSERT_TRUE(brace_fake_frame_take(&fake, &frame));
    TEST_ASSERT_EQUAL(1, frame.id);
    frame.id = 0x321;
    TEST_ASSERT_TRUE(brace_fake_frame_arrives(&fake, &frame));
    TEST_ASSERT_EQUAL(1, fake.hal.can_receive(door(), &frame));
    TEST_ASSERT_EQUAL(0x321, frame.id);
    TEST_ASSERT_EQUAL(0, fake.hal.can_receive(door(), &frame));
    fake.can_health.bus_off = true;
    TEST_ASSERT_EQUAL(BRACE_HAL_E_BUS_OFF, fake.hal.can_send(door(), &frame));

    uint8_t text[8];
    TEST_ASSERT_EQUAL(5, fake.hal.serial_write(door(), BRACE_SERIAL_CONSOLE, (const uint8_t *)"hello", 5));
    TEST_ASSERT_EQUAL(5, brace_fake_bytes_take(&fake, BRACE_SERIAL_CONSOLE, text, sizeof text));
    TEST_ASSERT_EQUAL_MEMORY("hello", text, 5);
    TEST_ASSERT_EQUAL(3, brace_fake_bytes_arrive(&fake, BRACE_SERIAL_MODBUS, (const uint8_t *)"abc", 3));
    TEST_ASSERT_EQUAL(2, fake.hal.serial_read(door(), BRACE_SERIAL_MODBUS, text, 2));
    TEST_ASSERT_EQUAL(1, fake.hal.serial_read(door(), BRACE_SERIAL_MODBUS, text, 2));
    TEST_ASSERT_EQUAL(0, fake.hal.serial_read(door(), BRACE_SERIAL_MODBUS, text, 2));
}

/* A full ring keeps no urgent frame out, and one that waits in it does not go first. */
static void test_an_urgent_frame_finds_room_and_goes_first(void)
{
    brace_can_frame_t frame = {.id = 0x605, .length = 8};
    const brace_can_setup_t setup = {.bit_rate = 500000, .filter_id = 0x605, .filter_mask = 0x7ff, .urgent_id = 1};
    TEST_ASSERT_EQUAL(BRACE_HAL_OK, fake.hal.can_setup(door(), &setup));
    for (uint32_t i = 0; i < BRACE_FAKE_FRAMES; i++) {
        TEST_ASSERT_TRUE(brace_fake_frame_arrives(&fake, &frame));
    }
    TEST_ASSERT_FALSE(brace_fake_frame_arrives(&fake, &frame));
    frame = (brace_can_frame_t){.id = 1};
    TEST_ASSERT_TRUE(brace_fake_frame_arrives(&fake, &frame));
    TEST_ASSERT_TRUE(brace_fake_frame_arrives(&fake, &frame));
    TEST_ASSERT_EQUAL(1, fake.can_health.frames_lost);
    TEST_ASSERT_EQUAL(1, fake.hal.can_receive(door(), &frame));
    TEST_ASSERT_EQUAL(1, frame.id);
    for (uint32_t i = 0; i < BRACE_FAKE_FRAMES; i++) {
        TEST_ASSERT_EQUAL(1, fake.hal.can_receive(door(), &frame));
        TEST_ASSERT_EQUAL(0x605, frame.id);
    }
    TEST_ASSERT_EQUAL(0, fake.hal.can_receive(door(), &frame));
    fake.can_filters = true;
    frame.id = 0x606;
    TEST_ASSERT_TRUE(brace_fake_frame_arrives(&fake, &frame));
    TEST_ASSERT_EQUAL(0, fake.hal.can_receive(door(), &frame));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_joints_say_what_they_were_given_and_when);
    RUN_TEST(test_calls_fail_when_they_were_set_to_and_leave_outputs_alone);
    RUN_TEST(test_memory_is_flash);
    RUN_TEST(test_frames_and_bytes_queue_in_order);
    RUN_TEST(test_an_urgent_frame_finds_room_and_goes_first);
    return UNITY_END();
}
