#include "question.h"

/* Spreads the time of the question over all digits (Steele, Lea, Flood 2014: the finalizer of SplitMix, 32 bits).
 * Nobody has to guess them: they only have to be others each time. */
static uint32_t spread(uint32_t word)
{
    word = (word ^ word >> 16) * 0x7feb352du;
    word = (word ^ word >> 15) * 0x846ca68bu;
    return word ^ word >> 16;
}

void question_ask(question_t *question, text_t *text)
{
    static const char *const names[] = {"zero", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine"};
    const uint32_t now_us = text->hal->now_us(text->hal->context);
    question->count++;
    uint32_t left = spread(now_us ^ question->count << 20);
    text_string(text, "sure? type these four digits and Enter within 30 s:");
    for (uint32_t i = 0u; i < (uint32_t)QUESTION_DIGITS; i++) {
        question->digits[i] = (char)('0' + left % 10u);
        text_string(text, " ");
        text_string(text, names[left % 10u]);
        left /= 10u;
    }
    question->digits[QUESTION_DIGITS] = '\0';
    text_line(text);
    question->asked_us = now_us;
    question->is_open = true;
}

bool question_take(question_t *question, const typed_t *typed)
{
    question->is_open = false;
    return typed_is(typed, question->digits);
}

void question_serve(question_t *question, text_t *text)
{
    const uint32_t now_us = text->hal->now_us(text->hal->context);
    if (question->is_open && now_us - question->asked_us >= (uint32_t)QUESTION_PATIENCE_US) {
        question->is_open = false;
        text_string(text, "no answer in 30 s; nothing is changed");
        text_line(text);
    }
}
