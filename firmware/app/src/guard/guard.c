#include "guard/guard.h"

#include <string.h>

static uint32_t sum_of(const guard_span_t *span, uint32_t first, uint32_t count)
{
    const uint8_t *bytes = (const uint8_t *)span->start + 4u * first;
    uint32_t sum = 0;
    for (uint32_t i = 0; i < count; i++) { /* at most 1024: the words of the longest span */
        uint32_t word;
        memcpy(&word, bytes + 4u * i, sizeof word);
        sum ^= word;
    }
    return sum;
}

void guard_take(guard_t *guard, uint32_t index, const guard_span_t *span)
{
    guard->sum[index] = sum_of(span, 0, span->words);
    if (guard->span == index) {
        guard->so_far = guard->word = 0;
    }
}

bool guard_step(guard_t *guard, const guard_span_t *span, uint32_t span_count, uint32_t words_most)
{
    const uint32_t left = span->words - guard->word, count = left < words_most ? left : words_most;
    guard->so_far ^= sum_of(span, guard->word, count);
    guard->word += count;
    if (guard->word < span->words) {
        return true;
    }
    const bool is_right = guard->so_far == guard->sum[guard->span];
    guard->so_far = guard->word = 0;
    guard->span = guard->span + 1u < span_count ? guard->span + 1u : 0u;
    return is_right;
}
