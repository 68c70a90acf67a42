/* Are the parameters in force, and the constants made from them, still what they were made? A bit of RAM that flips
 * would change K unseen, for ever. So a sum over their words is taken when they are made, and worked out anew in
 * slices.
 *
 * The sum is the exclusive or of all words: every single bit that flips changes it. */
#ifndef BRACE_GUARD_GUARD_H
#define BRACE_GUARD_GUARD_H

#include <stdbool.h>
#include <stdint.h>

enum { GUARD_SPANS_MOST = 8 };

/* A part of the memory, of whole words. */
typedef struct {
    const void *start;
    uint32_t words;
} guard_span_t;

typedef struct {
    uint32_t sum[GUARD_SPANS_MOST]; /* as taken */
    uint32_t so_far;                /* of the span that is being worked out */
    uint32_t word;                  /* of it, the next one */
    uint32_t span;
} guard_t;

/* Takes the sum of a span: it is right now. 4 instructions a word. */
void guard_take(guard_t *guard, uint32_t index, const guard_span_t *span);

/* Goes on in the span whose turn it is (guard->span), over at most so many words.
 *   span_count: after the last one, the first follows
 * returns whether nothing wrong was found. 30 instructions, and 5 a word */
bool guard_step(guard_t *guard, const guard_span_t *span, uint32_t span_count, uint32_t words_most);

#endif
