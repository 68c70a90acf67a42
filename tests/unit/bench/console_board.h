/* A console on the fake board, and what may be at the other end of its line. It stands in for the rest of an image. */
#ifndef CONSOLE_BOARD_H
#define CONSOLE_BOARD_H

#include <string.h>

#include "app_bench.h"
#include "banner.h"
#include "board.h"
#include "console.h"
#include "image_info.h"
#include "second_clock.h"
#include "stack.h"

const image_info_t image_info = {.magic = "BRACEIM", .version = "9.9.9", .hash = "0123456789ab", .build = "Test"};

const char *board_remark(void)
{
    return "a console without a board";
}

uint32_t board_core_hz(void)
{
    return 1000000u;
}

void board_serve(void) {}

uint32_t stack_bytes(void)
{
    return 8192u;
}

uint32_t stack_limit_address(void)
{
    return 0x20000000u;
}

void second_clock_start(void) {}

uint32_t second_clock_count(void *context)
{
    (void)context;
    return 0u - fake.now_us;
}

/* Who is at the other end. */
typedef enum {
    SILENT = 0,      /* a person who types, at a terminal that does not echo */
    LINUX_TERMINAL,  /* as Linux opens a serial port: ECHO, ICRNL, ONLCR, ECHOCTL */
    WITHOUT_ICRNL,   /* the same, but an end of line comes back as it was sent, or as ^M */
    PLAIN_ECHO,      /* each byte comes back: receiver and sender are joined */
    LATE_ECHO,       /* the same, 3 s later */
    LOSSY_ECHO,      /* a byte in ten is lost on the way */
    LOGIN,           /* a machine that takes each line for a name, and asks for another */
    FAR_ENDS
} far_end_t;

enum { SAID_BYTES = 1 << 17, WIRE_BYTES = 1 << 13, BYTES_A_MS = 12, LATE_MS = 3000 };

static console_t console;
static far_end_t far_end;
static char said[SAID_BYTES]; /* all that the console has sent; ends with a zero */
static uint32_t said_count;
static uint8_t wire[WIRE_BYTES]; /* on its way from the far end to the console; each with the ms at which it is there */
static uint32_t wire_due_ms[WIRE_BYTES], wire_first, wire_count;
static uint32_t ms, draw = 1u;

static inline uint32_t any(uint32_t below)
{
    draw = draw * 1664525u + 1013904223u;
    return (draw >> 8) % below;
}

static inline void comes_back(uint8_t byte, uint32_t after_ms)
{
    if (wire_count < WIRE_BYTES && !(far_end == LOSSY_ECHO && any(10u) == 0u)) {
        const uint32_t at = (wire_first + wire_count) % WIRE_BYTES;
        wire[at] = byte;
        wire_due_ms[at] = ms + after_ms;
        wire_count++;
    }
}

static inline void far_end_types(const char *words)
{
    for (; *words != '\0'; words++) {
        comes_back((uint8_t)*words, 0u);
    }
}

static inline void echo_control(uint8_t byte)
{
    comes_back('^', 0u);
    comes_back(byte ^ 0x40u, 0u);
}

/* Linux's line discipline, n_tty.c: what it sends back of a byte that has come. */
static inline void terminal_hears(uint8_t byte, bool maps_cr)
{
    byte = byte == '\r' && maps_cr ? (uint8_t)'\n' : byte;
    if (byte == '\n') {
        comes_back('\r', 0u);
        comes_back('\n', 0u);
    } else if (byte < 0x20u && byte != '\t') {
        echo_control(byte);
    } else {
        comes_back(byte, 0u);
    }
}

static inline void far_end_hears(uint8_t byte)
{
    switch (far_end) {
    case LINUX_TERMINAL: terminal_hears(byte, true); break;
    case WITHOUT_ICRNL: terminal_hears(byte, false); break;
    case PLAIN_ECHO:
    case LOSSY_ECHO: comes_back(byte, 0u); break;
    case LATE_ECHO: comes_back(byte, LATE_MS); break;
    case LOGIN:
        comes_back(byte, 0u);
        if (byte == '\n') {
            far_end_types("Password: \r\nLogin incorrect\r\nlimb login: ");
        }
        break;
    default: break;
    }
}

static inline int32_t console_writes(void *context, brace_serial_port_t port, const uint8_t *bytes, uint32_t count)
{
    (void)context;
    if (port == BRACE_SERIAL_CONSOLE) {
        TEST_ASSERT_LESS_THAN_UINT32(SAID_BYTES - count, said_count);
        memcpy(&said[said_count], bytes, count);
        said_count += count;
        said[said_count] = '\0';
        for (uint32_t i = 0; i < count; i++) {
            far_end_hears(bytes[i]);
        }
    }
    return (int32_t)count;
}

static inline void line_works(void)
{
    for (uint32_t i = 0; i < BYTES_A_MS && wire_count > 0u && (int32_t)(ms - wire_due_ms[wire_first]) >= 0; i++) {
        brace_fake_bytes_arrive(&fake, BRACE_SERIAL_CONSOLE, &wire[wire_first], 1u);
        wire_first = (wire_first + 1u) % WIRE_BYTES;
        wire_count--;
    }
}

/* Time passes; a tick in every so many ms. */
static inline void passes_ms(uint32_t count, uint32_t tick_every_ms)
{
    for (uint32_t i = 0; i < count; i++) {
        ms++;
        fake.now_us += 1000u;
        line_works();
        if (ms % tick_every_ms == 0u) {
            brace_app_tick(&app, fake.now_us);
        }
        console_serve(&console, &app);
    }
}

static inline void forget_said(void)
{
    said_count = 0u;
    said[0] = '\0';
}

/* The board starts: banner, and its application. */
static inline void board_starts(void)
{
    console = (console_t){.text = {.hal = &fake.hal}};
    banner_image(&console.text);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    banner_application(&console.text, &app, BRACE_OK);
    text_keep(&console.text);
}

/* A board that is switched off, with parameters in its memory, and its line. */
static inline void console_board(const brace_parameters_t *p, far_end_t at_the_end)
{
    bench_board();
    bench_store(p);
    fake.hal.serial_write = console_writes;
    wire_count = 0u;
    far_end = at_the_end;
    forget_said();
}

/* A person types, and the console has time to answer. */
static inline void person_types(const char *words)
{
    far_end_types(words);
    passes_ms(400u, 10u);
}

static inline const char *last_line_with(const char *words)
{
    const char *found = NULL;
    for (const char *at = strstr(said, words); at != NULL; at = strstr(at + 1, words)) {
        found = at;
    }
    TEST_ASSERT_NOT_NULL_MESSAGE(found, said);
    return found;
}

/* What a person reads out of the last question: its digits. */
static inline void read_digits(char digits[6])
{
    static const char *const names[] = {"zero", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine"};
    const char *at = last_line_with("within 30 s:") + strlen("within 30 s:");
    for (uint32_t i = 0; i < 4u; i++) {
        at++;
        for (uint32_t digit = 0; digit < 10u; digit++) {
            const size_t length = strlen(names[digit]);
            if (strncmp(at, names[digit], length) == 0) {
                digits[i] = (char)('0' + digit);
                at += length;
                break;
            }
        }
    }
    digits[4] = '\r';
    digits[5] = '\0';
}

static inline void person_confirms(void)
{
    char digits[6];
    read_digits(digits);
    person_types(digits);
}

static inline uint32_t count_of(const char *words)
{
    uint32_t count = 0u;
    for (const char *at = strstr(said, words); at != NULL; at = strstr(at + 1, words)) {
        count++;
    }
    return count;
}

#endif
