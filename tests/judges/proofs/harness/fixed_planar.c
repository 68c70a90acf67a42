/* K in the plane at no load in integers: any structure that the collapse's last look lets through, any two angles. */
#include "fixed/fixed_inverse.h"
#include "fixed/fixed_harmonic.h"
#include "fixed/fixed_kept.h"
#include "proof.h"

#include "fixed/fixed_table.c"

static const brace_planar_fixed_t *structure;
static int32_t zeros_of_weight, trace, minus_dev_x, dev_z;

static int32_t any_between(int32_t least, int32_t most)
{
    const int32_t value = any_i32();
    ASSUME(value >= least && value <= most);
    return value;
}

/* Any value in the harmonic's range. */
static int32_t any_harmonic(const brace_fixed_harmonic_t *h, brace_sincos_t knee)
{
    (void)knee;
    if (h == &structure->cross) {
        return any_between(-CROSS_MOST, CROSS_MOST);
    }
    if (h == &structure->rest) {
        const int32_t rest = any_between(1, REST_MOST);
        ASSUME((int64_t)rest << zeros_of_weight > 1LL << 33);
        return rest;
    }
    PROVE(h == &structure->mean || h == &structure->minus_dev_x || h == &structure->dev_z, "one of the structure");
    return h == &structure->mean ? trace : h == &structure->minus_dev_x ? minus_dev_x : dev_z;
}

/* A square of any size that a word's can have, and a product with a power of two. */
static int64_t det_stand_in(int32_t a, int32_t b, int32_t c, int32_t d)
{
    PROVE(a == b && a >= -CROSS_MOST, "a square");
    PROVE(d == structure->rest_weight, "and a weight");
    const int64_t square = any_i64();
    ASSUME(square >= 0 && square <= 1LL << 62);
    return square + ((int64_t)c << zeros_of_weight);
}

static bool is_float(uint32_t exponent_field)
{
    return exponent_field >= 59u << 23 && exponent_field <= 231u << 23 && exponent_field % (1u << 23) == 0u;
}

/* What is handed on is what the circle's proof takes (fixed_circle), with no bit lost. */
static void circle_stand_in(const fixed_circle_t *c, brace_stiffness_t *stiffness)
{
    const uint32_t up = (uint32_t)__builtin_clz((uint32_t)trace);
    PROVE(c->trace >= 0x80000000u && c->trace >> up == (uint32_t)trace, "the trace fills its word, whole");
    PROVE(c->minus_dev_x >> up == minus_dev_x && c->dev_z >> up == dev_z, "no bit of the deviator is lost");
    PROVE(c->det_leading >= 0x80000000u, "det C fills its word");
    PROVE(is_float(c->exponent_k) && is_float(c->exponent_min), "exponents are those of floats");
    brace_stiffness_t any;
    *stiffness = any;
}

#define harmonic any_harmonic
#define whole_sum det_stand_in
#define stiffness_of_circle circle_stand_in
#include "fixed/planar_fixed.c"

int main(void)
{
    brace_planar_fixed_t fixed;
    brace_stiffness_t k;
    structure = &fixed;
    zeros_of_weight = any_between(0, 30);
    fixed.rest_weight = 1 << zeros_of_weight;
    ASSUME(is_weight(fixed.rest_weight) && is_exponent(fixed.exponent_k) && is_exponent(fixed.exponent_min));
    ASSUME(fixed.exponent_k % (1u << 23) == 0u && fixed.exponent_min % (1u << 23) == 0u);
    trace = any_between(TRACE_LEAST, TRACE_MOST);
    /* is_definite: the deviator is shorter than half the trace, so each component is */
    minus_dev_x = any_between(1 - trace / 2, trace / 2 - 1), dev_z = any_between(1 - trace / 2, trace / 2 - 1);
    PROVE(brace_planar_fixed_stiffness(&fixed, any_i32(), any_i32(), &k) == BRACE_OK, "K at any angles");
    PROVE(k.flags == fixed.flags, "its flags are the structure's");
    return 0;
}
