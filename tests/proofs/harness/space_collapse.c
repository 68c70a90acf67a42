/* From floats to the integers of a limb under load in space, in fixed point, whatever the floats are. */
#include "proof.h"
#include "fixed_space/space_kept.h"

#include <math.h>

ANY_OF(double, any_double)

/* A number times a power of two: any. The exponent of a number above 1e-30: any that it may have. */
static double any_scaled(int32_t exponent)
{
    PROVE(exponent > -1000 && exponent < 1000, "a power of two that there is");
    return any_double();
}

static float any_mantissa(float value, int *exponent)
{
    PROVE(value - value == 0.0f && (value > 1e-30f || value < -1e-30f), "an exponent of a number that is not tiny");
    *exponent = any_i32();
    ASSUME(*exponent >= -99 && *exponent <= 128);
    return any_float();
}

/* The last look: what it is shown, and any answer. */
static brace_loaded_space_fixed_t shown;
static bool is_kept;
static int look_count;

static bool any_look(const brace_loaded_space_fixed_t *fixed)
{
    shown = *fixed, is_kept = any_bool(), look_count++;
    return is_kept;
}

#define ldexp(value, exponent) any_scaled(exponent)
#define frexpf any_mantissa
#define fmaxf(a, b) any_float()
#define is_space_kept any_look
#include "fixed_space/loaded_space_fixed_collapse.c"
#undef is_space_kept

static bool is_in(int32_t number, int32_t most)
{
    return number <= most && number >= -most;
}

/* As space_inputs takes them. */
#define ARE_EXPONENTS(fixed)                                                                                           \
    (is_in((fixed)->length_exponent, 128) && is_in((fixed)->turn_exponent, 512) &&                                     \
     is_in((fixed)->spring_exponent, 256) && is_in((fixed)->weight_exponent, 128))

/* No sum of the look itself overflows. */
static void looks(void)
{
    brace_loaded_space_fixed_t fixed;
    ASSUME(ARE_EXPONENTS(&fixed));
    if (any_bool()) {
        (void)is_link_kept(&fixed.coxa);
    } else {
        (void)is_weight_kept(&fixed);
    }
}

static void collapses(void)
{
    brace_loaded_space_t loaded;
    brace_loaded_space_fixed_t fixed, refused = {.turn_exponent = REFUSED_EXPONENT};
    brace_loaded_space_fixed_collapse(&loaded, &fixed);
    PROVE(look_count == 1, "a last look");
    PROVE(ARE_EXPONENTS(&shown), "exponents of floats, and of products of two");
    PROVE(same(&fixed, is_kept ? &shown : &refused, sizeof fixed),
          "what it lets through, or a limb that takes no load");
}

int main(void)
{
    looks();
    collapses();
    return 0;
}
