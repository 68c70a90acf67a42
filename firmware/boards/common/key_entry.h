/* The key of a guarded board, typed at its console. A board keeps its key for ever, so the key is typed twice. */
#ifndef BRACE_BOARDS_KEY_ENTRY_H
#define BRACE_BOARDS_KEY_ENTRY_H

#include "text.h"

typedef struct {
    bool is_open;
    uint32_t digits; /* that were taken: those of the first key, then those of the second */
    uint8_t key[2][BRACE_HAL_KEY_BYTES];
} key_entry_t;

/* Asks for the key's digits; or says that this board keeps no key, or has one already. */
void key_entry_begin(key_entry_t *entry, text_t *text);

/* Takes a typed character while the entry is open. The last digit keeps the key; whatever is no digit, blank or end of
 * line ends the entry without a key. The digits are not shown, and are forgotten when the entry ends. */
void key_entry_take(key_entry_t *entry, text_t *text, uint8_t typed);

#endif
