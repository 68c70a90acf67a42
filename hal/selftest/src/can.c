/* CAN, as far as a controller can be tested without a bus: it has to receive its own frames. */
#include "selftest.h"

enum { BIT_RATE = 500000, WINDOW_US = 20000, FRAMES = 3, IDENTIFIER = 0x555 };

static bool group_is_whole(selftest_t *test)
{
    const brace_hal_t *const hal = test->hal;
    const uint32_t there = (hal->can_setup != 0) + (hal->can_send != 0) + (hal->can_receive != 0) +
                           (hal->can_health != 0) + (hal->can_recover != 0);
    if (there == 0u) {
        selftest_report(test, BRACE_SELFTEST_NOTE, "can", "not there: no CAN on this board");
        return false;
    }
    return selftest_expect(test, there == 5u, "can", "the group is whole",
                           "half filled: setup, send, receive, health and recover are all there or all null");
}

static brace_can_frame_t frame_number(uint8_t number)
{
    brace_can_frame_t frame = {.id = IDENTIFIER, .length = 8u};
    for (uint8_t i = 0u; i < 8u; i++) {
        frame.data[i] = (uint8_t)(number * 16u + i);
    }
    return frame;
}

static bool equal(const brace_can_frame_t *a, const brace_can_frame_t *b)
{
    bool same = a->id == b->id && a->length == b->length && a->fd == b->fd;
    for (uint32_t i = 0u; i < 8u; i++) {
        same = same && a->data[i] == b->data[i];
    }
    return same;
}

static void refusals(selftest_t *test)
{
    const brace_hal_t *const hal = test->hal;
    brace_can_frame_t wrong = frame_number(0u);
    wrong.id = 0x800u;
    const int32_t long_id = hal->can_send(hal->context, &wrong);
    wrong = frame_number(0u);
    wrong.length = 9u;
    const int32_t long_data = hal->can_send(hal->context, &wrong);
    selftest_expect(test, long_id < BRACE_HAL_AGAIN && long_data < BRACE_HAL_AGAIN, "can_send",
                    "frames that can not be are refused", "an identifier of 12 bits or 9 bytes of data are accepted");
}

static void own_frames(selftest_t *test)
{
    const brace_hal_t *const hal = test->hal;
    brace_can_frame_t received = {0};
    for (uint8_t number = 0u; number < FRAMES; number++) {
        const brace_can_frame_t sent = frame_number(number);
        const int32_t answer = hal->can_send(hal->context, &sent);
        if (answer != BRACE_HAL_OK) {
            selftest_report_value(test, BRACE_SELFTEST_FAIL, "can_send", "an idle controller takes no frame", answer,
                                  "answer");
            return;
        }
    }
    uint8_t count = 0u;
    selftest_wait_t wait = selftest_wait(test, WINDOW_US);
    do { /* at most QUESTIONS_MAX */
        if (hal->can_receive(hal->context, &received) != 1) {
            continue;
        }
        const brace_can_frame_t expected = frame_number(count);
        if (!equal(&received, &expected)) {
            selftest_report_value(
                test, BRACE_SELFTEST_FAIL, "can_receive",
                "a frame came back changed or out of order: identifier shift, byte order, mailbox priority?", count,
                "frame");
            return;
        }
        count++;
    } while (count < FRAMES && selftest_waiting(test, &wait));
    if (count < FRAMES) {
        selftest_report_value(test, BRACE_SELFTEST_FAIL, "can_receive",
                              "frames sent in loopback do not come back: filter, receive interrupt, bit timing?", count,
                              "of 3 frames");
        return;
    }
    selftest_report(test, BRACE_SELFTEST_PASS, "can", "loopback: what is sent comes back, in order");
}

static void health(selftest_t *test)
{
    const brace_hal_t *const hal = test->hal;
    brace_can_health_t state = {0};
    selftest_wait_t wait = selftest_wait(test, WINDOW_US);
    bool is_on_bus = false;
    do { /* at most QUESTIONS_MAX; the controller comes onto the bus after 11 bits */
        is_on_bus = hal->can_health(hal->context, &state) == BRACE_HAL_OK && !state.bus_off;
    } while (!is_on_bus && selftest_waiting(test, &wait));
    selftest_expect(test, is_on_bus, "can_health", "on the bus", "no answer, or bus off with nothing connected");
}

/* Frames that the filter keeps out must take no room: a busy bus would fill the ring with them. */
static void filter(selftest_t *test)
{
    const brace_hal_t *const hal = test->hal;
    const brace_can_setup_t setup = {
        .bit_rate = BIT_RATE, .loopback = true, .filter_id = IDENTIFIER, .filter_mask = 0x7ffu};
    brace_can_frame_t wanted = frame_number(0u), other = frame_number(1u), received = {0};
    if (hal->can_setup(hal->context, &setup) != BRACE_HAL_OK) {
        selftest_report(test, BRACE_SELFTEST_FAIL, "can_setup", "a filter for one identifier is refused");
        return;
    }
    health(test);
    other.id = IDENTIFIER ^ 1u;
    bool is_right =
        hal->can_send(hal->context, &other) == BRACE_HAL_OK && hal->can_send(hal->context, &wanted) == BRACE_HAL_OK;
    int32_t came = 0;
    selftest_wait_t wait = selftest_wait(test, WINDOW_US);
    do { /* at most QUESTIONS_MAX */
        came = hal->can_receive(hal->context, &received);
    } while (came != 1 && selftest_waiting(test, &wait));
    is_right = is_right && came == 1 && equal(&received, &wanted);
    selftest_expect(test, is_right, "can_setup", "the filter lets in the identifier that is asked for, and no other",
                    "the filter lets in another identifier, or not the one that is asked for");
}

void selftest_can(selftest_t *test)
{
    const brace_hal_t *const hal = test->hal;
    if (!group_is_whole(test)) {
        return;
    }
    const brace_can_setup_t loopback = {.bit_rate = BIT_RATE, .loopback = true};
    const int32_t answer = hal->can_setup(hal->context, &loopback);
    if (answer == BRACE_HAL_E_UNSUPPORTED) {
        selftest_report(test, BRACE_SELFTEST_NOTE, "can_setup",
                        "no loopback, or no CAN behind it: frames are not tried");
        return;
    }
    if (answer != BRACE_HAL_OK) {
        selftest_report_value(test, BRACE_SELFTEST_FAIL, "can_setup",
                              "500 kbit/s in loopback is refused: controller clocked, pins, crystal?", answer,
                              "answer");
        return;
    }
    health(test);
    own_frames(test);
    refusals(test);
    filter(test);
    const brace_can_setup_t quiet = {.bit_rate = BIT_RATE, .listen_only = true};
    (void)hal->can_setup(hal->context, &quiet);
}
