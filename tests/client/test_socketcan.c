/* What the client takes from the kernel's queue: a pair of sockets stands in for the CAN socket, which not every kernel
 * has. */
#include <linux/can.h>
#include <linux/can/error.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>
#include <unity.h>

#include "bus_socketcan.h"

enum { MORE_THAN_ONE_CALL_SKIPS = 200 };

static brace_bus_t bus;
static int kernel;

void setUp(void)
{
    int ends[2];
    TEST_ASSERT_EQUAL_INT(0, socketpair(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0, ends));
    bus = (brace_bus_t){.fd = ends[0]};
    kernel = ends[1];
}

void tearDown(void)
{
    close(bus.fd);
    close(kernel);
}

static void gives(canid_t id, uint8_t data1, uint8_t data3)
{
    struct can_frame frame;
    memset(&frame, 0, sizeof frame);
    frame.can_id = id;
    frame.can_dlc = 8;
    frame.data[1] = data1;
    frame.data[3] = data3;
    TEST_ASSERT_EQUAL_INT(sizeof frame, write(kernel, &frame, sizeof frame));
}

static brace_bus_status_t receive(uint32_t *id)
{
    brace_bus_frame_t frame = {.id = 0u};
    const brace_bus_status_t status = brace_socketcan_receive(&bus, &frame, 0);
    *id = frame.id;
    return status;
}

static void test_frames_of_other_kinds_do_not_hide_those_behind_them(void)
{
    uint32_t id;
    gives(0x181u, 0u, 0u);
    for (int i = 0; i < MORE_THAN_ONE_CALL_SKIPS; i++) {
        gives(0x12345u | CAN_EFF_FLAG, 0u, 0u);
    }
    gives(0x181u | CAN_RTR_FLAG, 0u, 0u);
    gives(0x281u, 0u, 0u);
    TEST_ASSERT_EQUAL_INT(BRACE_BUS_OK, receive(&id));
    TEST_ASSERT_EQUAL_HEX32(0x181u, id);
    TEST_ASSERT_EQUAL_INT(BRACE_BUS_OK, receive(&id));
    TEST_ASSERT_EQUAL_HEX32(0x281u, id);
    TEST_ASSERT_EQUAL_INT(BRACE_BUS_E_TIMEOUT, receive(&id)); /* the queue is empty */
}

static void test_a_missing_acknowledgement_is_no_wrong_bit_rate(void)
{
    static const struct {
        canid_t id;
        uint8_t data1, data3;
        bool is_unheard;
    } errors[] = {{CAN_ERR_ACK, 0u, 0u, true},
                  {CAN_ERR_ACK | CAN_ERR_BUSERROR, 0u, 0u, true},
                  {CAN_ERR_CRTL, CAN_ERR_CRTL_TX_PASSIVE, 0u, true},
                  {CAN_ERR_CRTL, CAN_ERR_CRTL_TX_WARNING, 0u, true},
                  {CAN_ERR_PROT | CAN_ERR_BUSERROR, 0u, CAN_ERR_PROT_LOC_ACK, true},
                  {CAN_ERR_PROT | CAN_ERR_BUSERROR, 0u, CAN_ERR_PROT_LOC_CRC_SEQ, false},
                  {CAN_ERR_CRTL, CAN_ERR_CRTL_RX_PASSIVE, 0u, false},
                  {CAN_ERR_CRTL, CAN_ERR_CRTL_TX_PASSIVE | CAN_ERR_CRTL_RX_PASSIVE, 0u, false},
                  {CAN_ERR_BUSERROR, 0u, 0u, false},
                  {CAN_ERR_BUSOFF, 0u, 0u, false},
                  {CAN_ERR_BUSOFF | CAN_ERR_ACK, 0u, 0u, false}};
    uint32_t id, unheard = 0u, wrong = 0u;
    for (size_t i = 0u; i < sizeof errors / sizeof errors[0]; i++) {
        gives(errors[i].id | CAN_ERR_FLAG, errors[i].data1, errors[i].data3);
        TEST_ASSERT_EQUAL_INT(BRACE_BUS_E_TIMEOUT, receive(&id));
        unheard += errors[i].is_unheard;
        wrong += !errors[i].is_unheard;
        TEST_ASSERT_EQUAL_UINT32(unheard, bus.unacknowledged);
        TEST_ASSERT_EQUAL_UINT32(wrong, bus.errors);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_frames_of_other_kinds_do_not_hide_those_behind_them);
    RUN_TEST(test_a_missing_acknowledgement_is_no_wrong_bit_rate);
    return UNITY_END();
}
