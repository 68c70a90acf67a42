/* The same over every other port, and who is answered while others flood: SLCAN at 921,600 baud, Modbus RTU at 115,200
 * with the silence that the standard asks for, Modbus TCP with 15 connections.
 *
 *     build/host/tests/test_flood_ports [TRIALS]     default 400
 *
 * Bytes come as the line carries them. A stop is complete with its last byte; over RTU with the silence behind it. */
#include "flood.h"
#include "modbus_crc.h"

enum {
    SLCAN_BYTES_PER_MS = 92,
    RTU_BITS = 11,
    RTU_BAUD = 115200,
    RTU_SILENCE_US = 1750,
    RTU_SILENT_TICKS = 2, /* of a tick each, until that silence is over */
    CONNECTIONS = BRACE_FAKE_CONNECTIONS,
    LINE_BYTES = 4096
};

void setUp(void) {}
void tearDown(void) {}

/* Bytes on their way to a port, and when each is there. */
typedef struct {
    uint8_t byte[LINE_BYTES];
    uint32_t at_us[LINE_BYTES];
    uint32_t first, count;
    uint32_t free_us; /* when the line can carry the next one */
} line_t;

static line_t line;

static void line_says_at(const uint8_t *bytes, uint32_t count, uint32_t byte_ns, uint32_t silence_us)
{
    uint64_t ns = 1000ull * (line.free_us > fake.now_us ? line.free_us : fake.now_us);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t place = (line.first + line.count++) % LINE_BYTES;
        ns += byte_ns;
        line.byte[place] = bytes[i];
        line.at_us[place] = (uint32_t)(ns / 1000u) + 1u;
    }
    line.free_us = (uint32_t)(ns / 1000u) + 1u + silence_us;
}

/* Whatever is there by the next tick arrives. */
static void line_carries(brace_serial_port_t port)
{
    while (line.count > 0u && line.at_us[line.first] <= fake.now_us + TICK_US) {
        (void)brace_fake_bytes_arrive(&fake, port, &line.byte[line.first], 1);
        line.first = (line.first + 1u) % LINE_BYTES;
        line.count--;
    }
}

static void nobody_reads(void)
{
    uint8_t sink[600];
    (void)brace_fake_bytes_take(&fake, BRACE_SERIAL_SLCAN, sink, sizeof sink);
    (void)brace_fake_bytes_take(&fake, BRACE_SERIAL_MODBUS, sink, sizeof sink);
    for (uint32_t i = 0; i < CONNECTIONS; i += 1u + below(2)) { /* some connections read nothing for long */
        fake.connection[i].sent.count = 0;
    }
    empty_the_bus();
}

/* ----------------------------------------------------------------------------------------------- SLCAN -- */

static void text_of(uint32_t id, const uint8_t *data, uint32_t length)
{
    char text[40];
    uint32_t at = (uint32_t)snprintf(text, sizeof text, "t%03X%u", (unsigned)id, (unsigned)length);
    for (uint32_t i = 0; i < length; i++) {
        at += (uint32_t)snprintf(text + at, sizeof text - at, "%02X", data[i]);
    }
    text[at++] = '\r';
    line_says_at((const uint8_t *)text, at, 10u * 1000000000u / 921600u, 0);
}

static void slcan_noise(void)
{
    static const char *const words[] = {"\r", "V\r", "F\r", "S8\r", "t1238\r", "this is no line of text at all\r"};
    uint8_t data[8];
    if (below(8) == 0u) {
        const char *word = words[below(sizeof words / sizeof *words)];
        line_says_at((const uint8_t *)word, (uint32_t)strlen(word), 10u * 1000000000u / 921600u, 0);
        return;
    }
    make_noise((flood_t)below(OTHER_NODES), data);
    text_of(0x600u + NODE, data, 8);
}

static void slcan_stop(void)
{
    uint8_t data[8] = {BRACE_REQUEST_LOADING_TEST_STOP, (uint8_t)below(256)};
    if (below(2) == 0u) {
        text_of(1, data, below(2));
    } else {
        text_of(0x600u + NODE, data, 8);
    }
}

/* ------------------------------------------------------------------------------------------------- PDUs -- */

/* What a stranger asks or writes. returns its length */
static uint32_t pdu_noise(uint8_t pdu[64])
{
    static const uint16_t places[] = {0x4000, 0x4002, 0x4006, 0x4008, 0x400a, 0x4048, 0x404c, 0x0000, 0x0010};
    const uint16_t theta1 = (uint16_t)COMMAND_REGISTER(asked_theta1_rad), place = places[below(9)];
    const float angles[] = {0.8f, 1.1f};
    for (int i = 0; i < 64; i++) {
        pdu[i] = (uint8_t)below(256);
    }
    switch (below(5)) {
    case 0:
    case 1: {
        const uint8_t read[] = {(uint8_t)(3u + below(2)), 0, (uint8_t)below(100), 0, (uint8_t)(1u + below(100))};
        memcpy(pdu, read, sizeof read);
        return sizeof read;
    }
    case 2: {
        const uint8_t asks[] = {16, (uint8_t)(theta1 >> 8), (uint8_t)theta1, 0, 4, 8};
        memcpy(pdu, asks, sizeof asks);
        for (uint32_t i = 0; i < 8u; i++) {
            pdu[6u + i] = (uint8_t)(bits(angles[i / 4u]) >> (24u - 8u * (i % 4u)));
        }
        return 14;
    }
    case 3: {
        const uint8_t writes[] = {16, (uint8_t)(place >> 8), (uint8_t)place, 0, 2, 4};
        memcpy(pdu, writes, sizeof writes);
        return 10;
    }
    default:
        pdu[0] = (uint8_t)(8u + below(2) * 9u);
        memset(pdu + 1, 0, 2);
        return pdu[0] == 8u ? 7u : 1u;
    }
}

static uint32_t pdu_stop(uint8_t pdu[64])
{
    const uint32_t stop = COMMAND_REGISTER(stop);
    const uint8_t whole[] = {16, (uint8_t)(stop >> 8), (uint8_t)stop, 0, 2, 4, 0, 0, 0, (uint8_t)below(256)};
    const uint8_t half[] = {6, (uint8_t)(stop >> 8), (uint8_t)(stop + below(2)), 0, 1};
    const bool is_whole = below(2) == 0u;
    memcpy(pdu, is_whole ? whole : half, is_whole ? sizeof whole : sizeof half);
    return is_whole ? sizeof whole : sizeof half;
}

/* ------------------------------------------------------------------------------------------- Modbus RTU -- */

static bool without_silence; /* an adapter gathers bytes and hands them over without the silence between frames */

static void rtu_frame(uint8_t unit, const uint8_t *pdu, uint32_t count)
{
    uint8_t frame[80] = {unit};
    memcpy(frame + 1, pdu, count);
    const uint32_t crc = crc_by_bits(frame, count + 1u);
    frame[count + 1u] = (uint8_t)crc;
    frame[count + 2u] = (uint8_t)(crc >> 8);
    line_says_at(frame, count + 3u, (uint32_t)(RTU_BITS * 1000000000ull / RTU_BAUD),
                 without_silence ? 0u : RTU_SILENCE_US);
}

static void rtu_noise(void)
{
    uint8_t pdu[64];
    const uint32_t count = pdu_noise(pdu);
    rtu_frame(below(2) == 0u ? UNIT : (uint8_t)below(248), pdu, count);
}

static void rtu_stop(void)
{
    uint8_t pdu[64];
    const uint32_t count = pdu_stop(pdu);
    rtu_frame(below(4) == 0u ? 0u : UNIT, pdu, count);
}

/* ------------------------------------------------------------------------------------------- Modbus TCP -- */

static bool adu_arrives(uint32_t connection, const uint8_t *pdu, uint32_t count)
{
    uint8_t adu[80] = {0, (uint8_t)below(256), 0, 0, 0, (uint8_t)(count + 1u), UNIT};
    memcpy(adu + 7, pdu, count);
    return brace_fake_adu_arrives(&fake, connection, adu, count + 7u);
}

static void tcp_noise(void)
{
    uint8_t pdu[64];
    for (uint32_t connection = 0; connection < CONNECTIONS; connection++) {
        for (uint32_t i = below(40); i > 0u; i--) {
            const uint32_t count = pdu_noise(pdu);
            (void)adu_arrives(connection, pdu, count);
        }
    }
}

static void tcp_stop(void)
{
    uint8_t pdu[64];
    const uint32_t count = pdu_stop(pdu), connection = below(CONNECTIONS);
    if (!adu_arrives(connection, pdu, count)) { /* a full buffer: the byte before must have come in an earlier tick */
        fake.connection[connection].received.count = 0;
        TEST_ASSERT_TRUE(adu_arrives(connection, pdu, count));
    }
}

/* ----------------------------------------------------------------------------------------------- trials -- */

typedef enum { SLCAN, RTU, RTU_MERGED, TCP, PORTS } port_t;

static const char *const port_name[PORTS] = {"SLCAN", "Modbus RTU", "Modbus RTU without silence", "Modbus TCP"};

static void one_tick(port_t port, bool floods)
{
    static uint32_t since;
    if (++since >= 40u) {
        since = 0;
        sign_of_life();
    }
    while (floods && port == SLCAN && line.count < 200u) {
        slcan_noise();
    }
    while (floods && (port == RTU || port == RTU_MERGED) && line.count < 100u) {
        rtu_noise();
    }
    if (floods && port == TCP) {
        tcp_noise();
    }
    if (port != TCP) {
        line_carries(port == SLCAN ? BRACE_SERIAL_SLCAN : BRACE_SERIAL_MODBUS);
    }
    ticks(1);
    nobody_reads();
}

static void begin_on(port_t port)
{
    begin_trial(below(2) == 0u, below(2) == 0u);
    memset(&line, 0, sizeof line);
    line.free_us = fake.now_us;
    without_silence = port == RTU_MERGED;
    if (port == TCP) {
        brace_fake_with_connections(&fake);
    }
    if (port == SLCAN) {
        (void)brace_fake_bytes_arrive(&fake, BRACE_SERIAL_SLCAN, (const uint8_t *)"O\r", 2);
    }
}

/* returns whether the limb stands in time */
static bool stands(port_t port)
{
    const set_points_t before = set_points();
    for (uint32_t i = 10u + below(30); i > 0u; i--) {
        one_tick(port, true);
    }
    set_points_t commanded = set_points();
    TEST_ASSERT_FALSE_MESSAGE(are_equal(&before, &commanded), "the limb did not move before the stop");
    switch (port) {
    case SLCAN: slcan_stop(); break;
    case TCP: tcp_stop(); break;
    default: rtu_stop();
    }
    while (line.count > 0u && line.at_us[(line.first + line.count - 1u) % LINE_BYTES] > fake.now_us + TICK_US) {
        one_tick(port, false); /* the stop's last byte is still on its way */
    }
    uint32_t stood = 0;
    commanded = set_points();
    const uint32_t silence = port == RTU ? RTU_SILENT_TICKS : 0u;
    for (uint32_t i = 1; i <= TICKS_AFTER; i++) {
        one_tick(port, true);
        const set_points_t then = set_points();
        stood = are_equal(&commanded, &then) ? stood : i;
        commanded = then;
    }
    return stood <= STANDS_WITHIN + silence;
}

static void test_a_stop_is_heard_on_every_port(void)
{
    for (int port = 0; port < PORTS; port++) {
        uint32_t heard = 0;
        for (uint32_t i = 0; i < trials / PORTS; i++) {
            begin_on((port_t)port);
            heard += stands((port_t)port);
        }
        printf("stop on %s: heard in %u of %u\n", port_name[port], (unsigned)heard, (unsigned)(trials / PORTS));
        TEST_ASSERT_EQUAL(trials / PORTS, heard);
    }
}

/* -------------------------------------------------------------------------------------- who is answered -- */

static uint32_t answers_to(uint8_t token, uint32_t *to_others, uint32_t *refusals)
{
    brace_can_frame_t frame;
    uint32_t ours = 0;
    for (int i = 0; i < 8 && brace_fake_frame_take(&fake, &frame); i++) {
        if (frame.id != 0x580u + NODE) {
            continue;
        }
        const bool refused = frame.data[0] == BRACE_ANSWER_REFUSED;
        *refusals += refused;
        ours += !refused && frame.data[1] == token;
        *to_others += !refused && frame.data[1] != token;
    }
    return ours;
}

static void asks_for_entry(uint8_t token)
{
    uint8_t data[8];
    brace_can_pack_read_entry_request(&(brace_can_read_entry_request_t){token, ENTRY(owner)}, data);
    frame_arrives(0x600u + NODE, data, 8);
}

/* Fifteen masters of a bus ask as often as it carries; the sixteenth asks once, now and then. Nothing gets lost without
 * being counted: each question is answered, refused, or counted as lost. */
static void test_masters_of_a_bus_take_turns(void)
{
    enum { OURS = 0xf0, TURNS_MOST = 16 };
    uint32_t asked = 0, answered = 0, others = 0, refusals = 0, turns = 0, worst = 0;
    bool waits = false;
    has_coxa = false;
    start_limb(false, NULL);
    const uint32_t lost_before = counters().requests_lost;
    for (uint32_t i = 0; i < 4000u; i++) {
        for (uint32_t k = 0; k < REQUESTS_PER_MS - 1u; k++, asked++) {
            asks_for_entry((uint8_t)below(0xf0));
        }
        if (!waits && below(10) == 0u) {
            asks_for_entry(OURS);
            asked++;
            waits = true;
            turns = 0;
        }
        ticks(1);
        uint32_t now_others = 0;
        const uint32_t ours = answers_to(OURS, &now_others, &refusals);
        others += now_others;
        answered += ours;
        turns += waits ? now_others : 0u;
        worst = waits && turns > worst ? turns : worst;
        waits = waits && ours == 0u;
    }
    for (uint32_t i = 0; i < 400u; i++) {
        ticks(1);
        answered += answers_to(OURS, &others, &refusals);
    }
    TEST_ASSERT_GREATER_THAN(100, answered);
    TEST_ASSERT_LESS_OR_EQUAL(TURNS_MOST + CAN_ANSWERS_ROOM, worst); /* and answers that wait for the bus */
    TEST_ASSERT_EQUAL(0, counters().frames_lost);
    TEST_ASSERT_EQUAL(asked, answered + others + refusals + counters().requests_lost - lost_before);
    TEST_ASSERT_GREATER_THAN(refusals, counters().questions_busy + 1u);
    printf("%u questions of 15 masters: answered %u, refused as busy %u, counted %u; the sixteenth waited %u turns\n",
           (unsigned)asked, (unsigned)(answered + others), (unsigned)refusals,
           (unsigned)(counters().requests_lost - lost_before), (unsigned)worst);
}

/* While CAN is full of commands, whoever asks for K as text still gets it: of questions that are worked out in steps no
 * flood of commands takes every tick. */
/* Signs of life without a key, as often as every connection takes them. */
static void strangers_live_over_tcp(void)
{
    const uint32_t place = COMMAND_REGISTER(life_heard);
    const uint8_t life[14] = {16, (uint8_t)(place >> 8), (uint8_t)place, 0, 4, 8};
    for (uint32_t connection = 0; connection < CONNECTIONS; connection++) {
        (void)adu_arrives(connection, life, sizeof life);
        fake.connection[connection].sent.count = 0;
    }
}

static void k_is_answered(bool in_space, bool by_tcp, uint32_t each_ticks)
{
    enum { ASKED = 10 };
    uint32_t answered = 0;
    char part[16];
    uint8_t data[8], sink[600];
    has_coxa = in_space;
    start_limb(true, the_key);
    open_session();
    if (by_tcp) {
        brace_fake_with_connections(&fake);
    }
    (void)brace_fake_bytes_arrive(&fake, BRACE_SERIAL_SLCAN, (const uint8_t *)"O\r", 2);
    (void)snprintf(part, sizeof part, "t5858%02X31", (unsigned)BRACE_K_AT_POSTURE_ANSWER_0);
    memset(&line, 0, sizeof line);
    for (uint32_t i = 0; i < ASKED * each_ticks; i++) {
        if (i % each_ticks == 0u) {
            brace_can_pack_k_at_posture_request(&(brace_can_k_at_posture_request_t){0x31, 0.8f, 1.1f}, data);
            text_of(0x600u + NODE, data, 8);
        }
        line_carries(BRACE_SERIAL_SLCAN);
        if (by_tcp) {
            strangers_live_over_tcp();
        }
        flooded_tick(FORGED_SEALS, by_tcp ? 0u : REQUESTS_PER_MS);
        sink[brace_fake_bytes_take(&fake, BRACE_SERIAL_SLCAN, sink, sizeof sink - 1u)] = '\0';
        answered += strstr((const char *)sink, part) != NULL;
    }
    TEST_ASSERT_EQUAL(ASKED, answered);
    TEST_ASSERT_EQUAL(0, counters().frames_lost);
    brace_session_report_t report;
    brace_app_session(&app, &report);
    TEST_ASSERT_EQUAL(BRACE_OWNER_CAN, report.owner); /* its signs of life were among them */
    TEST_ASSERT_EQUAL(0, report.silences);
}

/* One tick in five has room, and K in the plane takes two steps, which others may take in turn. */
static void test_commands_leave_room_for_questions(void)
{
    for (int by_tcp = 0; by_tcp < 2; by_tcp++) {
        k_is_answered(false, by_tcp != 0, 60);
        k_is_answered(true, by_tcp != 0, 400);
    }
}

/* Fourteen connections ask without end, the fifteenth now and then: it waits for fourteen turns at most. */
static void test_connections_take_turns(void)
{
    const uint8_t read[] = {4, 0, 0, 0, 2};
    uint32_t asked = 0, ours = 0, turns = 0, worst = 0;
    bool waits = false;
    has_coxa = false;
    start_limb(false, NULL);
    brace_fake_with_connections(&fake);
    uint32_t answers = 0, busy = 0;
    for (uint32_t i = 0; i < 2000u; i++) {
        for (uint32_t connection = 0; connection < CONNECTIONS - 1u; connection++) {
            asked += adu_arrives(connection, read, sizeof read);
        }
        if (!waits && below(10) == 0u) {
            asked += adu_arrives(CONNECTIONS - 1u, read, sizeof read);
            waits = true;
            turns = 0;
        }
        ticks(1);
        for (uint32_t connection = 0; connection < CONNECTIONS; connection++) {
            uint8_t bytes[64];
            brace_fake_bytes_t *sent = &fake.connection[connection].sent;
            while (sent->count > 0u) {
                const uint32_t whole = 6u + sent->byte[(sent->first + 5u) % BRACE_FAKE_SERIAL_BYTES];
                for (uint32_t k = 0; k < whole; k++) {
                    bytes[k] = sent->byte[(sent->first + k) % BRACE_FAKE_SERIAL_BYTES];
                }
                sent->first = (sent->first + whole) % BRACE_FAKE_SERIAL_BYTES;
                sent->count -= whole;
                const bool refused = bytes[7] == 0x84u && bytes[8] == 6u, is_ours = connection == CONNECTIONS - 1u;
                busy += refused;
                answers += !refused;
                turns += waits && !refused && !is_ours;
                ours += is_ours && !refused;
                worst = waits && turns > worst ? turns : worst;
                waits = waits && !(is_ours && !refused);
            }
        }
    }
    TEST_ASSERT_GREATER_THAN(60, ours);
    TEST_ASSERT_LESS_OR_EQUAL(CONNECTIONS, worst);
    TEST_ASSERT_EQUAL(busy, counters().questions_busy);
    TEST_ASSERT_LESS_OR_EQUAL(CONNECTIONS * 4u, asked - answers - busy); /* that still wait */
}

int main(int count, char **arguments)
{
    read_trials(count, arguments);
    UNITY_BEGIN();
    RUN_TEST(test_a_stop_is_heard_on_every_port);
    RUN_TEST(test_masters_of_a_bus_take_turns);
    RUN_TEST(test_commands_leave_room_for_questions);
    RUN_TEST(test_connections_take_turns);
    return UNITY_END();
}
