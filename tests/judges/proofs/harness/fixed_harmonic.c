/* The value of a harmonic, for any words that the collapse's last look lets through and any knee angle. */
#include "fixed/fixed_kept.h"
#include "fixed/fixed_sincos.h"
#include "proof.h"

static int64_t lowest, highest, so_far;
static uint32_t products;

/* First the cosine's part, then the sine's. Each and both together are at most the amplitude times 2^31. So the sum is
 * between these ends after the first and after both. */
static int64_t part_of_swing(int32_t a, int32_t b)
{
    (void)a, (void)b;
    const int64_t sum = any_i64(), part = (int64_t)((uint64_t)sum - (uint64_t)so_far);
    ASSUME(sum >= lowest && sum <= highest);
    ASSUME((part >= 0) == (sum >= so_far)); /* the difference itself */
    so_far = sum, products++;
    return part;
}

#define whole_product part_of_swing
#include "fixed/fixed_harmonic.h"

#define LEAST_OF(h, amplitude) ((h)->constant_q32 - (amplitude) * (1LL << 31))
#define MOST_OF(h, amplitude) ((h)->constant_q32 + (amplitude) * (1LL << 31))

static void room_is_within(void)
{
    brace_fixed_harmonic_t h;
    const int32_t least = any_i32(), most = any_i32();
    const int64_t room = room_of(&h, least, most);
    ASSUME(room >= 0);
    PROVE(room <= 0xffffffffLL, "the square of the room fits 64 bits");
    PROVE(LEAST_OF(&h, room) >= (int64_t)least * (1LL << 32), "an amplitude of the room's size goes down to the least");
    PROVE(MOST_OF(&h, room) - 1 <= (int64_t)most * (1LL << 32), "and up to the most");
}

static void stays_in_range(void)
{
    brace_fixed_harmonic_t h;
    brace_sincos_t any_knee;
    const int32_t least = any_i32(), most = any_i32();
    so_far = h.constant_q32, products = 0;
    /* room_is_within: what an amplitude of the room's size leads to */
    lowest = (int64_t)least * (1LL << 32), highest = (int64_t)most * (1LL << 32);
    ASSUME(so_far >= lowest && so_far <= highest);
    const int32_t value = harmonic(&h, any_knee);
    PROVE(products == 2u, "of a cosine and a sine");
    PROVE(value >= least && value <= most, "a harmonic stays in its range");
}

static void looks_at_any_words(void)
{
    brace_fixed_harmonic_t h;
    (void)stays_within(&h, any_i32(), any_i32());
}

static void rest_has_weight(void)
{
    const int32_t rest = any_i32();
    for (int32_t zeros = 3; zeros <= 30; zeros++) {
        brace_planar_fixed_t fixed;
        fixed.rest_weight = 1 << zeros;
        PROVE(is_weight(fixed.rest_weight), "a power of two");
        PROVE(rest_least(&fixed) >= 1, "the least rest is above zero");
        PROVE(rest < rest_least(&fixed) || (int64_t)rest << zeros > 1LL << 33, "a rest has weight");
    }
}

int main(void)
{
    room_is_within();
    stays_in_range();
    looks_at_any_words();
    rest_has_weight();
    return 0;
}
