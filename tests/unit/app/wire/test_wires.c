/* How much the ports have done in a tick (wire/wire.h): the controller's other work heeds it, so that no tick is too
 * long. Frames of process data go out where nobody is answered. */
#include <stdio.h>

#include "brace/can_frames.h"
#include "can_bench.h"
#include "modbus_master.h"
#include "wire/wire.h"
#include "wire/wires.h"

enum { LINE_SILENT_TICKS = 2, DATA_WAIT_MOST_TICKS = 8 };

static void start_at(uint32_t stiffness_hz, uint32_t posture_hz, uint32_t load_hz)
{
    brace_parameters_t p = bench_parameters();
    p.controller.modbus_address = UNIT;
    p.controller.stiffness_hz = stiffness_hz;
    p.controller.posture_hz = posture_hz;
    p.controller.load_hz = load_hz;
    p.controller.sigma_hz = load_hz / 8u;
    if (stiffness_hz < 1000u) {
        /* Every frame comes at its own rate only where the bus has room, for one that is added too. */
        p.controller.bus_load_ratio = 0.5f;
    }
    p.controller.heartbeat_hz = 1;
    bench_start(&p);
    const uint8_t opens[] = {'O', '\r'};
    TEST_ASSERT_EQUAL(2, brace_fake_bytes_arrive(&fake, BRACE_SERIAL_SLCAN, opens, 2));
    ticks(50);
}

static void start(uint32_t data_hz)
{
    start_at(data_hz, data_hz, 0);
}

void setUp(void)
{
    start(0);
}

void tearDown(void) {}

/* The frames that the ports send, those as text too, beside answers. */
static uint32_t data_sent(void)
{
    brace_can_frame_t frame;
    uint8_t text[BRACE_FAKE_SERIAL_BYTES];
    uint32_t count = 0;
    while (brace_fake_frame_take(&fake, &frame)) {
        count += frame.id != 0x580u + NODE;
    }
    const uint32_t length = brace_fake_bytes_take(&fake, BRACE_SERIAL_SLCAN, text, sizeof text);
    for (uint32_t i = 0; i + 3u < length; i++) {
        count += text[i] == 't' && memcmp(text + i, "t585", 4) != 0;
    }
    return count;
}

static void empty_the_ports(void)
{
    uint8_t bytes[BRACE_FAKE_SERIAL_BYTES];
    (void)data_sent();
    (void)brace_fake_bytes_take(&fake, BRACE_SERIAL_MODBUS, bytes, sizeof bytes);
    (void)brace_fake_bytes_take(&fake, BRACE_SERIAL_MODBUS_TCP, bytes, sizeof bytes);
}

/* A tick of the wires alone. */
static uint32_t done(void)
{
    empty_the_ports();
    fake.now_us += TICK_US;
    wires_hear(&app.wires, &fake.hal, &app, &app.controller.counters, fake.now_us);
    return wires_tick(&app.wires, &fake.hal, &app, &app.controller.counters, fake.now_us);
}

static void work_on_question(void)
{
    controller_t *controller = &app.controller;
    const question_inputs_t inputs = {.model = &controller->model,
                                      .parameters = &controller->parameters.in_force,
                                      .is_calibrated = parameter_job_is_calibrated(&controller->parameters),
                                      .joints = &controller->joints,
                                      .down = controller->gravity.down};
    TEST_ASSERT_TRUE(question_job_work(&controller->question, &inputs, 2));
}

/* ------------------------------------------------------------------------------------------ requests -- */

typedef enum { CAN, TEXT, LINE, TCP, PORTS } port_t;

static void arrives_as_text(const uint8_t data[8])
{
    char line[32];
    int at = snprintf(line, sizeof line, "t6058");
    for (int i = 0; i < 8; i++) {
        at += snprintf(line + at, sizeof line - (size_t)at, "%02X", data[i]);
    }
    line[at++] = '\r';
    TEST_ASSERT_EQUAL(at, brace_fake_bytes_arrive(&fake, BRACE_SERIAL_SLCAN, (const uint8_t *)line, (uint32_t)at));
}

static void arrives_over_modbus(port_t port, const uint8_t *pdu, uint32_t count)
{
    uint8_t bytes[64] = {0, 1, 0, 0, 0, (uint8_t)(count + 1u), UNIT};
    memcpy(bytes + 7, pdu, count);
    if (port == TCP) {
        TEST_ASSERT_EQUAL(count + 7u, brace_fake_bytes_arrive(&fake, BRACE_SERIAL_MODBUS_TCP, bytes, count + 7u));
        return;
    }
    const uint32_t crc = crc_by_bits(bytes + 6, count + 1u);
    bytes[count + 7u] = (uint8_t)crc, bytes[count + 8u] = (uint8_t)(crc >> 8);
    line_says(bytes + 6, count + 3u);
}

/* Asks who this is, or for K. */
static void is_asked(port_t port, bool for_k)
{
    uint8_t data[8] = {BRACE_REQUEST_IDENTIFY, 1}, pdu[14] = {3, 0, 0, 0, 2};
    const uint32_t angles[] = {bits(0.8f), bits(1.2f)}, place = offsetof(brace_commands_t, asked_theta1_rad);
    const uint32_t at = BRACE_REGISTER_COMMANDS + (uint32_t)place / 2u;
    if (for_k) {
        const uint8_t head[] = {16, (uint8_t)(at >> 8), (uint8_t)at, 0, 4, 8};
        brace_can_pack_k_at_posture_request(&(brace_can_k_at_posture_request_t){1, 0.8f, 1.2f}, data);
        memcpy(pdu, head, sizeof head);
        for (uint32_t i = 0; i < 8u; i++) {
            pdu[6u + i] = (uint8_t)(angles[i / 4u] >> (24u - 8u * (i % 4u)));
        }
    }
    switch (port) {
    case CAN: arrives(0x600u + NODE, data, 8); break;
    case TEXT: arrives_as_text(data); break;
    default: arrives_over_modbus(port, pdu, for_k ? 14 : 5); break;
    }
}

/* So that a request on the line is whole in the next tick. */
static void line_is_silent(port_t port)
{
    for (int i = 0; i < LINE_SILENT_TICKS && port == LINE; i++) {
        TEST_ASSERT_EQUAL(WIRE_NOTHING, done());
    }
}

static void test_a_request_is_done_once_at_each_port(void)
{
    for (port_t port = CAN; port < PORTS; port++) {
        TEST_ASSERT_EQUAL(WIRE_NOTHING, done());
        is_asked(port, false);
        line_is_silent(port);
        TEST_ASSERT_EQUAL(WIRE_TAKEN, done());
        for (int i = 0; i < 8; i++) {
            TEST_ASSERT_EQUAL(WIRE_NOTHING, done());
        }
    }
}

static void test_what_all_ports_do_adds_up(void)
{
    is_asked(LINE, false);
    line_is_silent(LINE);
    is_asked(CAN, false);
    is_asked(TEXT, false);
    is_asked(TCP, false);
    TEST_ASSERT_EQUAL(PORTS * WIRE_TAKEN, done());
    TEST_ASSERT_EQUAL(WIRE_NOTHING, done());
}

/* A K that has been waited for costs more to send. While it is on its way nothing is done, and what comes behind it has
 * a tick of its own. */
static void test_an_answer_that_is_late(void)
{
    for (port_t port = CAN; port < PORTS; port++) {
        is_asked(port, true);
        line_is_silent(port);
        TEST_ASSERT_EQUAL(WIRE_TAKEN, done());
        TEST_ASSERT_EQUAL(WIRE_NOTHING, done());
        if (port != LINE) {
            is_asked(port, false);
        }
        TEST_ASSERT_EQUAL(WIRE_NOTHING, done());
        work_on_question();
        TEST_ASSERT_EQUAL(WIRE_K_ANSWERED, done());
        TEST_ASSERT_EQUAL(port != LINE ? WIRE_TAKEN : WIRE_NOTHING, done());
        for (int i = 0; i < 8; i++) {
            TEST_ASSERT_EQUAL(WIRE_NOTHING, done());
        }
    }
}

/* -------------------------------------------------------------------------------------- process data -- */

static bool is_taken_now(const can_port_t *port)
{
    return port->process.taken_us == fake.now_us;
}

/* Two frames in a tick at most, of both ports together, and one snapshot. */
static void test_process_data_count(void)
{
    uint32_t snapshots = 0, most = 0;
    start(100);
    TEST_ASSERT_EQUAL_UINT32(10000, app.wires.can.bus_port.process.period_us);
    (void)done(); /* text that waited while nobody emptied the port leaves first, and is no frame of this tick */
    for (int i = 0; i < 200; i++) {
        const uint32_t sent = done(), frames = data_sent();
        const bool on_bus = is_taken_now(&app.wires.can.bus_port), as_text = is_taken_now(&app.wires.can.text_port);
        const bool is_taken = on_bus || as_text;
        TEST_ASSERT_EQUAL((is_taken ? WIRE_DATA_ARE_TAKEN : WIRE_NOTHING) + frames, sent);
        snapshots += is_taken;
        most = frames > most ? frames : most;
    }
    TEST_ASSERT_EQUAL(2, most);
    TEST_ASSERT_INT_WITHIN(4, 2 * 200 / 10, snapshots);
}

/* In a second each frame leaves as often as its rate says, whatever the others' rates are. */
static void test_each_frame_at_its_rate(void)
{
    enum {
        STIFFNESS_HZ = 10,
        POSTURE_HZ = 20,
        LOAD_HZ = 40,
        SIGMA_HZ = 5,
        IDS = 0x800
    }; /* the first is not the most
                                                                                            frequent */
    static const struct {
        uint32_t id;
        int hz;
        bool needs_coxa;
    } frames[] = {
#define stiffness_hz STIFFNESS_HZ
#define posture_hz POSTURE_HZ
#define load_hz LOAD_HZ
#define sigma_hz SIGMA_HZ
#define ROW(ID, name, rate, coxa) {ID, rate, coxa},
        BRACE_CAN_PROCESS(ROW)
#undef ROW
#undef sigma_hz
#undef load_hz
#undef posture_hz
#undef stiffness_hz
    };
    static uint32_t count[IDS];
    int with_each[4] = {0}, in_space = 0;
    memset(count, 0, sizeof count);
    start_at(STIFFNESS_HZ, POSTURE_HZ, LOAD_HZ);
    empty_the_ports();
    for (int i = 0; i < 1000; i++) {
        brace_can_frame_t frame;
        ticks(1);
        while (brace_fake_frame_take(&fake, &frame)) {
            TEST_ASSERT_LESS_THAN(IDS, frame.id);
            count[frame.id]++;
        }
        empty_the_ports();
    }
    for (uint32_t i = 0; i < sizeof frames / sizeof *frames; i++) {
        const int is = (int)count[frames[i].id + NODE];
        int wanted = 0, parts = 0; /* the parts of a message have one identifier; this limb has no coxa joint */
        for (uint32_t part = 0; part < sizeof frames / sizeof *frames; part++) {
            const bool is_one = frames[part].id == frames[i].id && !frames[part].needs_coxa;
            wanted += is_one ? frames[part].hz : 0;
            parts += is_one;
        }
        TEST_ASSERT_INT_WITHIN(parts + 2, wanted, is); /* a condition follows each heartbeat */
        in_space += frames[i].needs_coxa;
        const int hz = frames[i].hz;
        with_each[hz == STIFFNESS_HZ ? 0 : hz == POSTURE_HZ ? 1 : hz == LOAD_HZ ? 2 : 3]++;
    }
    TEST_ASSERT_TRUE(with_each[0] > 0 && with_each[1] > 0 && with_each[2] > 0 && with_each[3] > 0 && in_space > 0);
}

/* Their periods are worked out anew for another set, at one port in a tick. */
static void test_another_set_counts_once_at_each_port(void)
{
    app.controller.snapshot[app.controller.newest].parameter_crc ^= 1u;
    TEST_ASSERT_EQUAL(WIRE_DATA_ARE_SET_UP, done());
    TEST_ASSERT_EQUAL(WIRE_DATA_ARE_SET_UP, done());
    TEST_ASSERT_EQUAL(WIRE_NOTHING, done());
}

/* Over CAN FD no frame follows the posture's rate. It neither makes the controller take snapshots that nobody gets nor
 * moves the rate of those that leave. */
static void test_a_rate_that_no_frame_follows(void)
{
    static const struct {
        uint32_t stiffness_hz, posture_hz, period_us;
    } row[] = {{0, 50, 0}, {30, 100, 33333}, {20, 0, 50000}};
    for (uint32_t i = 0; i < sizeof row / sizeof *row; i++) {
        brace_parameters_t p = bench_parameters();
        p.controller.can_fd_bit_rate = 2000000;
        p.controller.stiffness_hz = row[i].stiffness_hz;
        p.controller.posture_hz = row[i].posture_hz;
        p.controller.load_hz = p.controller.sigma_hz = 0;
        bench_board();
        fake.can_takes_fd = true;
        bench_store(&p);
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
        ticks(50);
        TEST_ASSERT_EQUAL_UINT32(2000000, app.wires.can.bus.setup.fd_bit_rate);
        TEST_ASSERT_EQUAL_UINT32(row[i].period_us, app.wires.can.bus_port.process.period_us);
    }
}

/* A set without rates ends what the set before it sent. */
static void test_a_set_without_rates_sends_no_values(void)
{
    brace_controller_t *rates = &app.controller.parameters.in_force.controller;
    start(100);
    rates->stiffness_hz = rates->posture_hz = rates->load_hz = rates->sigma_hz = 0;
    app.controller.snapshot[app.controller.newest].parameter_crc ^= 1u;
    for (int i = 0; i < 5; i++) { /* each port sees it, and frames that had been due leave */
        (void)done();
    }
    for (int i = 0; i < 50; i++) {
        TEST_ASSERT_EQUAL(WIRE_NOTHING, done());
    }
}

/* Frames of measured values that a tick sends on the bus, beside heartbeat and emergency. */
static uint32_t values_sent_on_bus(void)
{
    brace_can_frame_t frame;
    uint32_t count = 0;
    while (brace_fake_frame_take(&fake, &frame)) {
        const bool is_condition =
            frame.id == BRACE_CAN_ID_DETAILS + NODE && brace_can_details_part(frame.data) == BRACE_CAN_PART_CONDITION;
        count +=
            frame.id != BRACE_CAN_ID_HEARTBEAT + NODE && frame.id != BRACE_CAN_ID_EMERGENCY + NODE && !is_condition;
    }
    return count;
}

/* What has not left before the bus goes off is not sent when it is back: it would be old by then. */
static void test_a_snapshot_is_not_sent_after_the_bus_was_off(void)
{
    const process_t *process = &app.wires.can.bus_port.process;
    start_at(1, 1, 0);
    const uint32_t room = fake.can_room, taken_us = process->taken_us;
    empty_the_ports();
    fake.can_room = 0;
    for (int i = 0; i < 1100 && process->taken_us == taken_us; i++) {
        ticks(1);
    }
    TEST_ASSERT_NOT_EQUAL(0, process->due);
    fake.can_health.bus_off = true;
    ticks(20);
    fake.can_health.bus_off = false;
    fake.can_room = room;
    for (int i = 0; i < 200; i++) { /* the next snapshot is due much later */
        ticks(1);
        TEST_ASSERT_EQUAL_UINT32(0, values_sent_on_bus());
    }
    TEST_ASSERT_FALSE(app.wires.can.bus.is_off);
}

/* In a tick with an answer no process data leave; after eight such ticks, one frame does. */
static void test_answers_go_first_for_a_while(void)
{
    uint32_t without = 0;
    start(1000);
    for (int i = 0; i < 100; i++) {
        is_asked(TCP, false);
        TEST_ASSERT_TRUE(done() >= WIRE_TAKEN);
        const uint32_t frames = data_sent();
        TEST_ASSERT_EQUAL(i % (DATA_WAIT_MOST_TICKS + 1) == DATA_WAIT_MOST_TICKS, frames);
        without += frames == 0u;
    }
    TEST_ASSERT_EQUAL(100 - 100 / (DATA_WAIT_MOST_TICKS + 1), without);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_request_is_done_once_at_each_port);
    RUN_TEST(test_what_all_ports_do_adds_up);
    RUN_TEST(test_an_answer_that_is_late);
    RUN_TEST(test_process_data_count);
    RUN_TEST(test_each_frame_at_its_rate);
    RUN_TEST(test_a_rate_that_no_frame_follows);
    RUN_TEST(test_a_set_without_rates_sends_no_values);
    RUN_TEST(test_a_snapshot_is_not_sent_after_the_bus_was_off);
    RUN_TEST(test_another_set_counts_once_at_each_port);
    RUN_TEST(test_answers_go_first_for_a_while);
    return UNITY_END();
}
