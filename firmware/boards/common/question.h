/* A question before something is changed: whoever wants it types the four digits that the console spells in words.
 *
 * No line that the console prints holds these digits, so none of its lines that comes back is the answer. Each question
 * has other digits, so a recording of an earlier answer is none. */
#ifndef BRACE_BOARDS_QUESTION_H
#define BRACE_BOARDS_QUESTION_H

#include "text.h"
#include "typed.h"

enum { QUESTION_DIGITS = 4, QUESTION_PATIENCE_US = 30000000 };

typedef struct {
    bool is_open;
    uint32_t asked_us;
    uint32_t count; /* of questions since start */
    char digits[QUESTION_DIGITS + 1];
} question_t;

/* Opens the question, and prints its end: the digits in words. What will happen has been printed before. */
void question_ask(question_t *question, text_t *text);

/* Ends it. true: `typed` holds its digits. */
bool question_take(question_t *question, const typed_t *typed);

/* Ends a question that nobody has answered in time, and says so. */
void question_serve(question_t *question, text_t *text);

#endif
