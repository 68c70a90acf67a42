/* CAN frames as text: of a host that does not read for a while no request is lost, and none is answered twice. */
#include <stdio.h>

#include "can_bench.h"

void setUp(void)
{
    const brace_parameters_t p = bench_parameters();
    bench_start(&p);
    ticks(10);
    drain();
}

void tearDown(void) {}

static void say(const char *text)
{
    const uint32_t length = (uint32_t)strlen(text);
    TEST_ASSERT_EQUAL(length, brace_fake_bytes_arrive(&fake, BRACE_SERIAL_SLCAN, (const uint8_t *)text, length));
}

/* What has been said, as text that is kept until the next call. */
static const char *heard(void)
{
    static char text[BRACE_FAKE_SERIAL_BYTES + 1];
    text[brace_fake_bytes_take(&fake, BRACE_SERIAL_SLCAN, (uint8_t *)text, BRACE_FAKE_SERIAL_BYTES)] = '\0';
    return text;
}

/* The host asks to know who this is, and reads nothing for a while. Questions that its queue holds are answered then;
 * all others were refused as busy, and counted. */
static void test_questions_of_a_host_that_does_not_read_wait(void)
{
    enum { ASKED = 40 };
    char line[32];
    uint32_t answered = 0;
    say("O\r");
    ticks(2);
    (void)heard();
    (void)snprintf(line, sizeof line, "t6058%02X01000000000000\r", (unsigned)BRACE_REQUEST_IDENTIFY);
    char part[16];
    (void)snprintf(part, sizeof part, "t5858%02X01", (unsigned)BRACE_IDENTIFY_ANSWER_4);
    uint32_t sent = 0;
    for (int i = 0; i < 400 && sent < ASKED; i++) {
        const uint32_t length = (uint32_t)strlen(line);
        if (brace_fake_bytes_arrive(&fake, BRACE_SERIAL_SLCAN, (const uint8_t *)line, length) == length) {
            sent++;
        }
        ticks(1);
    }
    TEST_ASSERT_GREATER_THAN(5, sent);
    for (int i = 0; i < 400; i++) {
        const char *text = heard();
        for (const char *at = strstr(text, part); at != NULL; at = strstr(at + 1, part)) {
            answered++;
        }
        ticks(1);
    }
    TEST_ASSERT_GREATER_OR_EQUAL(CAN_QUESTIONS_EACH, answered);
    TEST_ASSERT_GREATER_THAN(0, counters().questions_busy);
    TEST_ASSERT_EQUAL(sent, answered + counters().questions_busy);
}

static void asks_who(uint32_t token)
{
    char line[32];
    (void)snprintf(line, sizeof line, "t6058%02X%02X000000000000\r", (unsigned)BRACE_REQUEST_IDENTIFY, (unsigned)token);
    say(line);
}

/* A client that closes the channel and opens it again gets no answer and no news of a fault from the time before. If it
 * moved the limb over this channel, it is no longer the owner. */
static void test_a_channel_that_is_opened_again_begins_anew(void)
{
    say("O\r");
    ticks(2);
    (void)heard();
    asks_who(1);
    say("C\r");
    ticks(5);
    (void)heard();
    fake.joint[BRACE_FEMUR].not_newer = true;
    ticks(60);
    TEST_ASSERT_NOT_EQUAL(0, now()->faults);
    say("O\r");
    ticks(5);
    const char *text = heard();
    TEST_ASSERT_EQUAL_MEMORY("\r", text, 1);
    TEST_ASSERT_NULL(strstr(text, "t585")); /* no answer */
    TEST_ASSERT_NULL(strstr(text, "t085")); /* no emergency */
    asks_who(2);
    ticks(4);
    text = heard();
    char first[16];
    (void)snprintf(first, sizeof first, "t5858%02X01", (unsigned)BRACE_IDENTIFY_ANSWER_0);
    TEST_ASSERT_NOT_NULL(strstr(text, "t5858"));
    TEST_ASSERT_NULL(strstr(text, first));
    fake.joint[BRACE_FEMUR].not_newer = false;
    bool is_reported = false;
    for (int i = 0; i < 200; i++) {
        ticks(1);
        is_reported = strstr(heard(), "t085") != NULL || is_reported;
    }
    TEST_ASSERT_TRUE(is_reported); /* its end, now that somebody listens */
}

static void say_request(const uint8_t data[8])
{
    char line[32];
    int at = snprintf(line, sizeof line, "t6058");
    for (int i = 0; i < 8; i++) {
        at += snprintf(line + at, sizeof line - (size_t)at, "%02X", data[i]);
    }
    line[at++] = '\r';
    line[at] = '\0';
    say(line);
}

/* A host sends a force and closes the channel. The K that the next host asks for does not count that force. */
static void test_a_sent_force_ends_with_its_channel(void)
{
    char answer[16];
    uint8_t force[8], question[8];
    brace_can_pack_tip_force_request(&(brace_can_tip_force_request_t){7, 5.0f, -10.0f}, force);
    brace_can_pack_k_under_load_at_posture_request(&(brace_can_k_under_load_at_posture_request_t){8, 0.8f, 1.1f},
                                                   question);
    (void)snprintf(answer, sizeof answer, "t5858%02X08", (unsigned)BRACE_K_UNDER_LOAD_AT_POSTURE_ANSWER_3);
    for (int closes = 0; closes < 3; closes++) {
        say("C\rO\r");
        ticks(2);
        say_request(force);
        ticks(4);
        if (closes == 1) {
            say("C\r");
            ticks(2);
            say("O\r");
            ticks(2);
        } else if (closes == 2) { /* as slcand and python-can do, in one piece, and the request with it */
            say("C\rS8\rO\r");
        }
        (void)heard();
        say_request(question);
        ticks(10);
        TEST_ASSERT_EQUAL(closes == 0, strstr(heard(), answer) != NULL);
    }
}

/* A commit is answered when it has ended, by the way it came. */
static void test_a_commit_as_text_is_answered_as_text(void)
{
    char line[40];
    uint8_t data[8];
    say("O\r");
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_enter(&app));
    ticks(2);
    (void)heard();
    const uint32_t longer = 0x433e0000u; /* 190.0f */
    const uint32_t femur = brace_parameter_number(BRACE_PARAMETER_GEOMETRY_FEMUR_MM);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_parameters_stage(&app, femur, 1, &longer));
    brace_can_pack_commit_request(&(brace_can_commit_request_t){0x10, 0}, data);
    uint32_t at = (uint32_t)snprintf(line, sizeof line, "t6058");
    for (uint32_t i = 0; i < 8u; i++) {
        at += (uint32_t)snprintf(line + at, sizeof line - at, "%02X", data[i]);
    }
    (void)snprintf(line + at, sizeof line - at, "\r");
    say(line);
    char part[16];
    (void)snprintf(part, sizeof part, "t5858%02X10", (unsigned)BRACE_COMMIT_ANSWER_0);
    bool is_answered = false;
    for (int i = 0; i < 400; i++) {
        ticks(1);
        is_answered = strstr(heard(), part) != NULL || is_answered;
    }
    TEST_ASSERT_TRUE(is_answered);
    TEST_ASSERT_EQUAL_FLOAT(190.0f, brace_app_parameters(&app)->limb.femur_mm);
}

static void test_who_closes_the_channel_owns_the_limb_no_longer(void)
{
    brace_session_report_t report;
    brace_parameters_t p = bench_parameters();
    p.limb.joint[BRACE_TIBIA].gap_rad = 0.005f;
    bench_start(&p);
    ticks(50);
    say("O\r");
    ticks(2);
    (void)heard();
    char line[40];
    uint8_t data[8];
    brace_can_pack_take_up_request(&(brace_can_take_up_request_t){0x10, BRACE_TIBIA, 1}, data);
    uint32_t at = (uint32_t)snprintf(line, sizeof line, "t6058");
    for (uint32_t i = 0; i < 8u; i++) {
        at += (uint32_t)snprintf(line + at, sizeof line - at, "%02X", data[i]);
    }
    (void)snprintf(line + at, sizeof line - at, "\r");
    say(line);
    ticks(2);
    brace_app_session(&app, &report);
    TEST_ASSERT_EQUAL(BRACE_OWNER_SLCAN, report.owner);
    say("C\r");
    ticks(2);
    brace_app_session(&app, &report);
    TEST_ASSERT_EQUAL(BRACE_OWNER_NONE, report.owner);
    say("O\r");
    say(line);
    ticks(2);
    brace_app_session(&app, &report);
    TEST_ASSERT_EQUAL(BRACE_OWNER_SLCAN, report.owner);
    say("C\rS8\rO\r"); /* the next host comes in the same tick */
    ticks(2);
    brace_app_session(&app, &report);
    TEST_ASSERT_EQUAL(BRACE_OWNER_NONE, report.owner);
}

/* A snapshot is long: where both ports send process data, one takes its snapshot in a tick, and both get theirs. */
static void test_the_two_ports_take_their_snapshots_in_different_ticks(void)
{
    int on_bus = 0, as_text = 0;
    say("O\r");
    for (int i = 0; i < 400; i++) {
        ticks(1);
        (void)heard();
        drain();
        const bool bus_takes = app.wires.can.bus_port.process.taken_us == fake.now_us;
        const bool text_takes = app.wires.can.text_port.process.taken_us == fake.now_us;
        TEST_ASSERT_FALSE(bus_takes && text_takes);
        on_bus += bus_takes, as_text += text_takes;
    }
    TEST_ASSERT_GREATER_THAN(10, on_bus);
    TEST_ASSERT_GREATER_THAN(10, as_text);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_questions_of_a_host_that_does_not_read_wait);
    RUN_TEST(test_a_channel_that_is_opened_again_begins_anew);
    RUN_TEST(test_a_sent_force_ends_with_its_channel);
    RUN_TEST(test_a_commit_as_text_is_answered_as_text);
    RUN_TEST(test_who_closes_the_channel_owns_the_limb_no_longer);
    RUN_TEST(test_the_two_ports_take_their_snapshots_in_different_ticks);
    return UNITY_END();
}
