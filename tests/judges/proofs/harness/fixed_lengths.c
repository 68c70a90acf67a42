/* Lengths of vectors in fixed point: every angle, every number whose root is taken, every product that is inverted. */
#include "fixed/fixed_roots.h"
#include "fixed/fixed_sincos.h"
#include "counted.h"

#include "fixed/fixed_table.c"

static uint64_t square_of(brace_sincos_t at)
{
    return (uint64_t)((int64_t)at.sin_q31 * at.sin_q31) + (uint64_t)((int64_t)at.cos_q31 * at.cos_q31);
}

static void directions_are_no_longer_than_one(uint32_t angle_turn)
{
    PROVE(square_of(sincos_of(angle_turn)) <= 1ull << 62, "sine and cosine are no longer than one");
    PROVE(square_of(direction_of(angle_turn)) <= 1ull << 62, "nor is a direction");
}

/* The largest whole number whose square is at most this. */
static uint64_t root_of(uint64_t square)
{
    uint64_t root = (uint64_t)__builtin_sqrt((double)square);
    while (root > 0xffffffffu || root * root > square) {
        root--;
    }
    while (root < 0xffffffffu && (root + 1u) * (root + 1u) <= square) {
        root++;
    }
    return root;
}

/* number: the leading 32 bits of a vector's square. The longest component that such a vector can have is the root of
 * all that the number was cut from. */
static void roots_fit(uint32_t number)
{
    const uint32_t per_root = fixed_per_root_q27(number);
    PROVE(high_unsigned(number, per_root) < 1u << 27, "the length fits its word");
    PROVE(per_root >> 26 != 0u && per_root >> 31 == 0u, "one over it fits its word");
    const unsigned __int128 one = (unsigned __int128)1 << 86, square = (unsigned __int128)per_root * per_root;
    PROVE(number < 1u << 30 || square * ((uint64_t)number + 1u) >= one - (one >> 20), "one over a root");
    /* For most numbers the squares (at most 2^118) show that no component is too long. The others need the root. */
    if (square * ((uint64_t)number + 1u) > one) {
        const uint64_t longest = root_of(((uint64_t)number << 32) | 0xffffffffu);
        PROVE(longest * per_root < 1ull << 59, "no component is longer than one");
    }
}

static void products_invert(uint32_t number)
{
    const uint64_t whole = (uint64_t)fixed_per_product(number) * number, one = 1ull << 59;
    PROVE(whole <= one + (one >> 24) && whole >= one - (one >> 22), "one over a product");
    PROVE(fixed_per_product(number) >= 1u << 27 && fixed_per_product(number) <= 1u << 30, "is in its range");
}

/* Along each component the sine grows or falls, so that it is largest at a corner of the entry's cell. */
static void entries_are_near(void)
{
    for (int32_t cell = 0; cell < 1024; cell++) {
        const int32_t cosine = ((cell & 15) - 8) * (1 << 23) + ((cell & 256) != 0 ? (1 << 23) - 1 : 0);
        const int32_t sine = ((cell >> 4 & 15) - 8) * (1 << 23) + ((cell & 512) != 0 ? (1 << 23) - 1 : 0);
        uint32_t entry;
        const int32_t off = fixed_off_entry_q32(cosine, sine, &entry);
        PROVE(entry < 64u, "the entry is in the table");
        PROVE(off / 128 == high_sum(sine, brace_fixed_sincos[entry].cos_q31, cosine, brace_fixed_sincos[entry].sin_q31),
              "no bit of the sine is lost");
    }
}

static void go_through(uint32_t step)
{
    for (uint64_t i = 0; i < 1ull << 32; i += step) {
        roots_fit((uint32_t)i);
        directions_are_no_longer_than_one((uint32_t)i);
        products_invert((uint32_t)i | 1u << 29);
    }
}

int main(void)
{
    entries_are_near();
    go_through(4099u); /* finds most mistakes within a second */
    go_through(1u);
    return 0;
}
