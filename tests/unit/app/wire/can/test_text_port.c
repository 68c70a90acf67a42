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

/* The host asks to know who this is, reads nothing for a while, and then gets the answer to each of its requests. */
static void test_requests_of_a_host_that_does_not_read_wait(void)
{
    enum { ASKED = 40 };
    char line[32];
    uint32_t answered = 0;
    say("O\r");
    ticks(2);
    (void)heard();
    (void)snprintf(line, sizeof line, "t6058%02X01000000000000\r", (unsigned)BRACE_REQUEST_IDENTIFY);
    char part[16];
    (void)snprintf(part, sizeof part, "t5858%02X01", (unsigned)(BRACE_REQUEST_IDENTIFY + 96u));
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
    TEST_ASSERT_EQUAL(sent, answered);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_requests_of_a_host_that_does_not_read_wait);
    return UNITY_END();
}
