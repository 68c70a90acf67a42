/* From floats to the integers of a limb under load in fixed point, whatever the floats are. */
#include "proof.h"
#include "loaded/fixed_units.h"

#include <math.h>

ANY_OF(double, any_double)

/* A number times a power of two, and its exponent: any. (The standard leaves open what the exponent of an infinity
 * is.) */
static double any_scaled(int32_t exponent)
{
    PROVE(exponent > -1000 && exponent < 1000, "a power of two that there is");
    return any_double();
}

static float any_mantissa(float value, int *exponent)
{
    PROVE(value - value == 0.0f, "an exponent of a number");
    *exponent = any_i32();
    ASSUME(*exponent >= -148 && *exponent <= 128);
    return any_float();
}

/* The last look: what it is shown, and any answer. */
static brace_loaded_fixed_t shown;
static bool is_within;
static int look_count;

static bool any_look(const brace_loaded_fixed_t *fixed)
{
    shown = *fixed, is_within = any_bool(), look_count++;
    return is_within;
}

#define ldexp(value, exponent) any_scaled(exponent)
#define frexpf any_mantissa
#define is_within_units any_look
#include "loaded/loaded_fixed_collapse.c"

/* No sum of the look itself overflows. */
static void looks(void)
{
    brace_loaded_fixed_t fixed;
    ASSUME(unit_are_exponents(&fixed)); /* asked first */
    (void)unit_are_weights(&fixed);
    (void)unit_is_link(&fixed.femur);
    (void)unit_are_roots(fixed.base_root_q31);
}

static void collapses(void)
{
    brace_loaded_t loaded;
    brace_loaded_fixed_t fixed, refused = {.bend_exponent = REFUSED_EXPONENT};
    brace_loaded_fixed_collapse(&loaded, &fixed);
    PROVE(look_count == 1, "a last look");
    PROVE(same(&fixed, is_within ? &shown : &refused, sizeof fixed),
          "what it lets through, or a limb that takes no load");
}

int main(void)
{
    looks();
    collapses();
    return 0;
}
