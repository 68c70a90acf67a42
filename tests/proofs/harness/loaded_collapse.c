/* From floats to the integers of a limb under load in fixed point, whatever the floats are. */
#include "proof.h"
#include "loaded/fixed_units.h"
#include "loaded_sizes.h"

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
#undef is_within_units

/* No sum of the look itself overflows, and what it lets through has the lengths that the other proofs take. */
static void looks(void)
{
    brace_loaded_fixed_t fixed;
    if (is_within_units(&fixed)) {
        PROVE(fixed.weight_q31 >= 0 && fixed.knee_q31 >= 0 && fixed.knee_q31 >= fixed.tibia.weight_q31, "weights");
    }
}

static void collapses(void)
{
    brace_loaded_t loaded;
    brace_loaded_fixed_t fixed, refused = {.bend_exponent = REFUSED_EXPONENT};
    brace_loaded_fixed_collapse(&loaded, &fixed);
    PROVE(look_count == 1, "a last look");
    PROVE(same(&fixed, is_within ? &shown : &refused, sizeof fixed), "what it lets through, or a limb that takes no load");
}

int main(void)
{
    looks();
    collapses();
    return 0;
}
