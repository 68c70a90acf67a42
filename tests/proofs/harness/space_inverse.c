/* From C in space to K in fixed point. A product is replaced by any number of its size. */
#include "proof.h"
#include "loaded_sizes.h"
#include "fixed_space/sum.h"
#include "loaded/fixed_units.h"

#include "fixed/fixed_table.c"

static int64_t magnitude(int64_t number)
{
    return number < 0 ? -number : number;
}

static int64_t any_within(int64_t most)
{
    const int64_t any = any_i64();
    ASSUME(any <= most && any >= -most);
    return any;
}

#define ENTRY_MOST (1LL << 30)

static int64_t any_minor_of(int32_t a, int32_t b, int32_t c, int32_t d)
{
    PROVE(magnitude(a) <= ENTRY_MOST && magnitude(b) <= ENTRY_MOST && magnitude(c) <= ENTRY_MOST &&
              magnitude(d) <= ENTRY_MOST, "entries of C in its unit");
    return any_within(2LL * ENTRY_MOST * ENTRY_MOST);
}

/* Of three products, each an entry times a cofactor in its unit. */
static int64_t any_sum3(int32_t a, int32_t b, int32_t c, int32_t d, int32_t e, int32_t f)
{
    PROVE(magnitude(a) <= ENTRY_MOST && magnitude(c) <= ENTRY_MOST && magnitude(e) <= ENTRY_MOST, "entries of C");
    (void)b, (void)d, (void)f;
    return any_within(3LL << 61);
}

/* loaded_turns */
static uint32_t any_over_q61(uint32_t leading)
{
    PROVE(leading >> 31 != 0u, "a determinant that fills its word");
    const uint32_t over = any_u32();
    ASSUME(over >= (1u << 29) - 8u && over <= 1u << 30);
    return over;
}

static uint32_t any_high_unsigned(uint32_t a, uint32_t b)
{
    PROVE(a <= 1u << 31 && b <= 1u << 30, "a cofactor, and one over the determinant");
    const uint32_t high_word = any_u32();
    ASSUME(high_word <= 1u << 29);
    return high_word;
}

static int32_t text_to_word(int64_t number, uint32_t zeros);

static int32_t sound_to_word(int64_t number, uint32_t zeros)
{
    PROVE((int64_t)((uint64_t)number << zeros) >> zeros == number, "no bit above is lost");
    return text_to_word(number, zeros);
}

#define SECOND(first, second, ...) second
#define PICK(...) SECOND(__VA_ARGS__)
#define minor_of(first, ...) PICK(MINOR_##first, any_minor_of, ~)(first, __VA_ARGS__)
#define MINOR_int32_t ~, text_minor_of,
#define to_word(first, ...) PICK(WORD_##first, sound_to_word, ~)(first, __VA_ARGS__)
#define WORD_int64_t ~, text_to_word,
#define sum3 any_sum3
#define over_q61 any_over_q61
#define high_unsigned any_high_unsigned
#include "fixed_space/invert.h"

static bool is_finite(float value)
{
    return (bits_of(value) & 0x7f800000u) != 0x7f800000u;
}

int main(void)
{
    fixed_tensor3_t c;
    brace_k3_t k;
    c.xx = any_within(SPACE_C_MOST), c.yy = any_within(SPACE_C_MOST), c.zz = any_within(SPACE_C_MOST);
    const int32_t exponent = any_i32();
    ASSUME(exponent >= -60 - UNIT_LENGTH_EXPONENT_MOST && exponent <= 60 - UNIT_LENGTH_EXPONENT_LEAST);
    if (!fixed_inverse3(&c, exponent, &k)) {
        return 0;
    }
    PROVE(is_finite(k.xx_n_per_mm) && is_finite(k.xy_n_per_mm) && is_finite(k.xz_n_per_mm) &&
              is_finite(k.yy_n_per_mm) && is_finite(k.yz_n_per_mm) && is_finite(k.zz_n_per_mm),
          "K is finite");
    PROVE((bits_of(k.xx_n_per_mm) | bits_of(k.yy_n_per_mm) | bits_of(k.zz_n_per_mm)) >> 31 == 0u, "its diagonal");
    return 0;
}
