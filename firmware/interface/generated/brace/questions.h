/* Written by tools/interface from dictionary.toml; do not edit. */
#ifndef BRACE_QUESTIONS_H
#define BRACE_QUESTIONS_H

/* Requests that are asked over Modbus by writing commands, and answered in registers. */
#include <stdbool.h>
#include <stdint.h>

#include "brace/measured.h"

typedef struct {
    uint8_t first, count;  /* the commands that are written in one request: place in brace_commands_t, how many */
    uint8_t fields;        /* so many of them are the request's fields; the next one's value picks one of `code` */
    uint8_t codes;         /* how many requests there are to pick from */
    uint8_t code[2];       /* BRACE_REQUEST_...: all with the same fields and the same answer */
    uint8_t answer_first, answer_count; /* the values that take the answer: place in brace_answered_t, how many */
    bool none_is_an_answer; /* values that are not known say that the limb has none */
    uint8_t begin_code, begin_fields; /* a request that is asked before, with the first of the commands; 0: none */
} brace_question_t;

enum { BRACE_QUESTION_COUNT = 9 };
extern const brace_question_t brace_questions[BRACE_QUESTION_COUNT];

/* Nothing has been asked: values of questions and answers are not known, all others are zero. */
extern const brace_commands_t brace_commands_unknown;
extern const brace_answered_t brace_answered_unknown;

#endif
