#include "console.h"

#include <stddef.h>

#include "banner.h"
#include "port_test.h"
#include "stiffness_words.h"
#if defined(BRACE_PROVOKE_FAULTS)
#include "provoke.h"
#endif

enum { BYTES_AT_ONCE = 32 };

typedef enum { HELP, SHORT_HELP, K, BANNER, FORGET, RESTART, TEST, TEST_SLOT, TEST_DRIVES, KEY, BENCH, WORDS } word_t;

/* What changes nothing is done at once, and has no sentence here of what will happen. */
static const struct {
    const char *word, *what, *will_happen;
} words[WORDS] = {
    [HELP] = {"help", "this list", NULL},
    [SHORT_HELP] = {"?", "this list", NULL},
    [K] = {"k", "the limb's stiffness now, flags, faults, mode", NULL},
    [BANNER] = {"banner", "what runs here, and the last crash", NULL},
    [FORGET] = {"forget", "drops the record of the last crash", "the record of the last crash is dropped, for ever"},
    [RESTART] = {"restart", "starts the processor anew", "the processor starts anew; no tick for about a second"},
    [TEST] = {"test", "the port's self-test; moves nothing, memory is only read",
              "no tick for about a second, buses are set up anew; then a restart"},
    [TEST_SLOT] = {"test slot", "the same, and erases the parameter slot that is not in force", NULL},
    [TEST_DRIVES] =
        {"test drives", "the same, and commands the drives to no offset; bench only, limb free",
         "drives are asked for no offset and no bound of torque: the limb has to hang free; then a restart"},
    [KEY] = {"key", "gives this board its key, once",
             "this board gets a key, and keeps it for ever: nothing takes it back"},
    [BENCH] = {"bench", "everybody on its buses may move the limb, until the next start",
               "everybody on the board's buses may move the limb, with or without the key, until the next start"},
};

static void say(text_t *text, const char *sentence)
{
    text_string(text, sentence);
    text_line(text);
}

static void help(text_t *text)
{
    for (uint32_t i = 0u; i < (uint32_t)WORDS; i++) {
        text_string(text, words[i].word);
        text_string(text, ": ");
        say(text, words[i].what);
    }
#if defined(BRACE_PROVOKE_FAULTS)
    provoke_help(text);
#endif
}

/* The place of a typed word: in the table, or behind it of what the crash-test images have. */
static uint32_t find(const typed_t *typed)
{
    uint32_t at = 0u;
    while (at < (uint32_t)WORDS && !typed_is(typed, words[at].word)) {
        at++;
    }
#if defined(BRACE_PROVOKE_FAULTS)
    at += at == (uint32_t)WORDS ? provoke_find(typed) : 0u;
#endif
    return at;
}

static bool is_known(uint32_t word)
{
#if defined(BRACE_PROVOKE_FAULTS)
    return word < (uint32_t)WORDS + provoke_count();
#else
    return word < (uint32_t)WORDS;
#endif
}

static bool changes_something(uint32_t word)
{
    return word >= (uint32_t)FORGET;
}

static port_test_t test_of(uint32_t word)
{
    switch (word) {
    case TEST_SLOT: return PORT_TEST_SLOT;
    case TEST_DRIVES: return PORT_TEST_DRIVES;
    default: return PORT_TEST_PLAIN;
    }
}

/* Says why not, where that cannot be done now. */
static bool is_possible(console_t *console, const brace_app_t *app, uint32_t word)
{
    const char *obstacle = NULL;
    switch (word) {
    case RESTART:
        obstacle = brace_app_is_storing(app) ? "a set of parameters is being stored; try again in 2 s" : NULL;
        break;
    case TEST:
    case TEST_SLOT:
    case TEST_DRIVES: obstacle = port_test_obstacle(app, test_of(word)); break;
    case KEY: return key_entry_is_possible(&console->text);
    case BENCH:
        obstacle = brace_app_setting(app) == BRACE_SETTING_BENCH ? "this board is a bench already" : NULL;
        break;
    default: break;
    }
    if (obstacle != NULL) {
        text_string(&console->text, "not now: ");
        say(&console->text, obstacle);
    }
    return obstacle == NULL;
}

static void say_what_will_happen(text_t *text, const brace_app_t *app, uint32_t word)
{
    if (word == (uint32_t)TEST_SLOT) {
        text_string(text, "parameter slot ");
        text_string(text, port_test_slot(app) == 0u ? "A" : "B");
        say(text, " is erased: the set before the one in force, and the way back to it; then a restart");
    } else if (word < (uint32_t)WORDS) {
        say(text, words[word].will_happen);
    } else {
        say(text, "the processor crashes on purpose");
    }
    if (word == (uint32_t)RESTART && brace_app_moves(app)) {
        say(text, "a joint moves or is held by this controller: "
                  "its drive gets no command meanwhile, and may let it go");
    }
}

static void act(console_t *console, brace_app_t *app, uint32_t word)
{
    text_t *const text = &console->text;
    const brace_hal_t *const hal = text->hal;
    switch (word) {
    case HELP:
    case SHORT_HELP: help(text); break;
    case K: stiffness_words(text, app); break;
    case BANNER:
        banner_image(text);
        banner_application(text, app, BRACE_OK);
        break;
    case FORGET:
        hal->crash_clear(hal->context);
        say(text, "forgotten");
        break;
    case RESTART: hal->restart(hal->context); break;
    case TEST:
    case TEST_SLOT:
    case TEST_DRIVES: port_test_run(text, app, test_of(word)); break;
    case KEY: key_entry_begin(&console->key_entry, text); break;
    case BENCH:
        brace_app_become_bench(app);
        say(text, "bench until the next start");
        break;
    default:
#if defined(BRACE_PROVOKE_FAULTS)
        provoke(word - (uint32_t)WORDS);
#endif
        break;
    }
}

static void take_word(console_t *console, brace_app_t *app, uint32_t word)
{
    console->has_reported_echo = false;
    console->strange_lines = 0u;
    if (!changes_something(word)) {
        act(console, app, word);
    } else if (is_possible(console, app, word)) {
        say_what_will_happen(&console->text, app, word);
        console->asked = word;
        question_ask(&console->question, &console->text);
    }
}

/* A line that is no word: at most CONSOLE_STRANGE_LINES are answered, so that two machines on one line fall silent. */
static void take_strange(console_t *console)
{
    if (console->strange_lines < (uint32_t)CONSOLE_STRANGE_LINES) {
        console->strange_lines++;
        say(&console->text, console->strange_lines < (uint32_t)CONSOLE_STRANGE_LINES
                                ? "no such word, or a line that is too long; try help"
                                : "no such word; from here on only words of the list are answered; try help");
    }
}

static void take_answer(console_t *console, brace_app_t *app)
{
    if (!question_take(&console->question, &console->typed)) {
        say(&console->text, "those are not the digits; nothing is changed");
    } else if (is_possible(console, app, console->asked)) { /* it may have changed since the question */
        act(console, app, console->asked);
    }
}

static void take_line(console_t *console, brace_app_t *app)
{
    const uint32_t word = find(&console->typed);
    text_again(&console->text); /* a person who has just typed listens */
    if (console->key_entry.is_open) {
        key_entry_take(&console->key_entry, &console->text, console->typed.line);
    } else if (console->question.is_open) {
        take_answer(console, app);
    } else if (is_known(word)) {
        take_word(console, app, word);
    } else {
        take_strange(console);
    }
    typed_forget(&console->typed); /* it may have been a key */
}

static void hear_itself(console_t *console)
{
    console->question.is_open = false;
    key_entry_refuse_echo(&console->key_entry, &console->text);
    if (!console->has_reported_echo) {
        console->has_reported_echo = true;
        text_again(&console->text); /* what sends it back listens */
        say(&console->text,
            "this terminal echoes: input is ignored until none has come for 2 s; try picocom, or stty -echo");
    }
}

/* Reads until a line is whole. A line that waits for room on the line keeps the bytes behind it waiting. */
static void read_bytes(console_t *console)
{
    const brace_hal_t *const hal = console->text.hal;
    const uint32_t now_us = hal->now_us(hal->context);
    typed_serve(&console->typed, now_us);
    uint8_t byte = 0u;
    for (uint32_t i = 0u; i < (uint32_t)BYTES_AT_ONCE && !console->has_line; i++) {
        if (hal->serial_read(hal->context, BRACE_SERIAL_CONSOLE, &byte, 1u) != 1) {
            return;
        }
        switch (typed_take(&console->typed, byte, now_us)) {
        case TYPED_ECHO: hear_itself(console); break;
        case TYPED_LINE: console->has_line = true; break;
        default: break;
        }
    }
}

void console_serve(console_t *console, brace_app_t *app)
{
    const bool has_room = text_serve(&console->text);
    read_bytes(console);
    if (!has_room) { /* one answer at a time */
        return;
    }
    if (console->has_line) {
        console->has_line = false;
        take_line(console, app);
    }
    question_serve(&console->question, &console->text);
    key_entry_serve(&console->key_entry, &console->text);
}
