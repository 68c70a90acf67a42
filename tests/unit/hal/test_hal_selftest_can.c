/* The port self-test and CAN: each lie is named, and nothing else blamed before it. */
#include "selftest_door.h"

enum {
    CAN_HALF = 1,
    CAN_DEAF,
    CAN_SCRAMBLES,
    CAN_REORDERS,
    CAN_BUSY,
    CAN_REFUSES,
    CAN_TAKES_ANYTHING,
    CAN_BUS_OFF,
    CAN_HEARS_ALL,
    LIES
};

static int32_t lying_can_setup(void *context, const brace_can_setup_t *setup)
{
    const int32_t answer = can_setup(context, setup);
    return world.lie == CAN_REFUSES ? BRACE_HAL_E_DEVICE : answer;
}

static int32_t lying_can_send(void *context, const brace_can_frame_t *frame)
{
    (void)context;
    if (world.lie == CAN_BUSY) {
        return BRACE_HAL_AGAIN;
    }
    if (world.lie != CAN_TAKES_ANYTHING && (frame->id > 0x7ffu || frame->length > 8u)) {
        return BRACE_HAL_E_RANGE;
    }
    if (world.loopback && world.queued < FRAMES_MAX && (world.lie == CAN_HEARS_ALL || passes(frame))) {
        const uint32_t place = world.lie == CAN_REORDERS ? 2u - world.queued % 3u : world.queued;
        world.frames[place] = *frame;
        world.frames[place].data[3] ^= world.lie == CAN_SCRAMBLES ? 1u : 0u;
        world.queued++;
    }
    return BRACE_HAL_OK;
}

static int32_t lying_can_receive(void *context, brace_can_frame_t *frame)
{
    return world.lie == CAN_DEAF ? 0 : can_receive(context, frame);
}

static int32_t lying_can_health(void *context, brace_can_health_t *health)
{
    (void)context;
    *health = (brace_can_health_t){.bus_off = world.lie == CAN_BUS_OFF};
    return BRACE_HAL_OK;
}

static void open_lying(int lie)
{
    door.can_setup = lying_can_setup;
    door.can_send = lying_can_send;
    door.can_receive = lying_can_receive;
    door.can_health = lying_can_health;
    door.can_recover = lie == CAN_HALF ? NULL : can_recover;
}

static void each_lie_is_named(void)
{
    static const named_t named[] = {
        {CAN_HALF, "can", "half filled"},
        {CAN_DEAF, "can_receive", "do not come back"},
        {CAN_SCRAMBLES, "can_receive", "changed or out of order"},
        {CAN_REORDERS, "can_receive", "changed or out of order"},
        {CAN_BUSY, "can_send", "takes no frame"},
        {CAN_REFUSES, "can_setup", "is refused"},
        {CAN_TAKES_ANYTHING, "can_send", "12 bits or 9 bytes"},
        {CAN_BUS_OFF, "can_health", "bus off"},
        {CAN_HEARS_ALL, "can_setup", "lets in another identifier"},
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
