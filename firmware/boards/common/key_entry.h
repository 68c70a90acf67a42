/* The key of a guarded board, typed at its console in two lines. A board keeps its key for ever, so the key is typed
 * twice. */
#ifndef BRACE_BOARDS_KEY_ENTRY_H
#define BRACE_BOARDS_KEY_ENTRY_H

#include "text.h"

enum { KEY_ENTRY_PATIENCE_US = 120000000 }; /* for each of the two lines */

typedef struct {
    bool is_open;
    uint32_t lines;     /* that were taken */
    uint32_t asked_us;  /* when the line that is awaited was asked for */
    uint8_t key[2][BRACE_HAL_KEY_BYTES];
} key_entry_t;

/* What a board says of its key: "kept and locked", ...; constant storage. An empty string: it keeps none, a bench. */
const char *key_entry_words(const brace_hal_t *hal);

/* May this board be given a key? If not, says why. */
bool key_entry_is_possible(text_t *text);

/* Asks for the key's digits. */
void key_entry_begin(key_entry_t *entry, text_t *text);

/* Takes a line while the entry is open: 32 hexadecimal digits, with blanks between them as you like. The second line
 * keeps the key; another line ends the entry without a key. The digits are not shown, and are forgotten when the
 * entry ends. */
void key_entry_take(key_entry_t *entry, text_t *text, const char *line);

/* Ends an open entry without a key, and says that the console heard itself. */
void key_entry_refuse_echo(key_entry_t *entry, text_t *text);

/* Ends an entry that nobody goes on with. */
void key_entry_serve(key_entry_t *entry, text_t *text);

#endif
