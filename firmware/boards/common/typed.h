/* What is typed at the console, as whole lines.
 *
 * A terminal that echoes sends the console's own lines back: Linux does so with every serial port that somebody opens
 * and leaves as it is. The console's lines begin with TEXT_PREFIX. When a line begins so, all input is ignored until
 * nothing has come for TYPED_QUIET_US. Nothing typed is ever sent back, so two ends that echo have nothing to echo. */
#ifndef BRACE_BOARDS_TYPED_H
#define BRACE_BOARDS_TYPED_H

#include <stdbool.h>
#include <stdint.h>

enum {
    TYPED_MOST = 72, /* characters of a line */
    TYPED_QUIET_US = 2000000
};

typedef enum {
    TYPED_NOTHING = 0, /* the line goes on, or was empty */
    TYPED_LINE,        /* `line` is whole; it is empty where it was too long or held what no key types */
    TYPED_ECHO         /* a line begins as the console's own do; reported once, until it has been quiet */
} typed_event_t;

typedef struct {
    bool is_deaf;
    uint32_t heard_us; /* when the last byte came, while deaf */
    bool is_spoilt;    /* the line is too long, or holds what no key types */
    uint32_t count;
    char line[TYPED_MOST + 1]; /* without blanks at its ends; valid until the next byte */
} typed_t;

/* Takes a byte. Lines end with CR, LF or both. BS and DEL take a character back, ^C and ^U the whole line. A line
 * that has not ended waits for ever. */
typed_event_t typed_take(typed_t *typed, uint8_t byte, uint32_t now_us);

/* Ends the deafness when it has been quiet for long enough. Call it at least every 1,000 s. */
void typed_serve(typed_t *typed, uint32_t now_us);

/* Is `line` that word? */
bool typed_is(const typed_t *typed, const char *word);

/* Overwrites what was typed: it may be a key. */
void typed_forget(typed_t *typed);

#endif
