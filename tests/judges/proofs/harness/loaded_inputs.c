/* The inputs of K under load in fixed point, any floats: the units, and the load in them. */
#include "proof.h"
#include "loaded_sizes.h"
#include "loaded/fixed_inputs.h"
#include "loaded/fixed_units.h"

#define REFUSED_EXPONENT 100 /* as loaded/fixed_quantise.h */

#include "fixed/fixed_table.c"

static int64_t size_of(int32_t number)
{
    return number < 0 ? -(int64_t)number : number;
}

static bool is_in(int64_t number, int64_t most)
{
    return number <= most && number >= -most;
}

/* What the collapse makes (loaded_collapse). */
static void is_collapsed(const brace_loaded_fixed_t *limb)
{
    ASSUME(unit_are_exponents(limb) && unit_are_weights(limb) && limb->base_rotation_q31 >= 0);
}

/* What it makes of a limb that does not keep its units. */
static void the_refused(void)
{
    const brace_loaded_fixed_t limb = {.bend_exponent = REFUSED_EXPONENT};
    brace_load_t load;
    fixed_inputs_t in;
    PROVE(inputs_of(&limb, any_float(), any_float(), &load, &in) != BRACE_OK, "no load is taken");
}

int main(void)
{
    the_refused();
    brace_loaded_fixed_t limb;
    brace_load_t load;
    fixed_inputs_t in;
    is_collapsed(&limb);
    if (inputs_of(&limb, any_float(), any_float(), &load, &in) != BRACE_OK) {
        return 0;
    }
    PROVE(in.hip >= 0 && in.hip_yields >= 0 && in.knee >= 0 && in.knee_yields >= 0, "compliances are not negative");
    PROVE(in.bend_shift <= 31u, "curvatures' shift");
    PROVE(in.coarser == 0u || in.coarser == 2u, "by how many bits C is coarser");
    PROVE(in.spring_shift >= 3u && in.spring_shift <= 31u, "springs' shift: they move by a quarter");
    PROVE(in.root_shift >= 2u && in.root_shift <= 31u, "and their roots'");
    PROVE(in.weight_shift >= 1u && in.weight_shift <= 31u && in.parity <= 1u, "weights' shift");
    PROVE(is_in(in.tip_q30.x, 1 << 30) && is_in(in.tip_q30.z, 1 << 30), "the force is below its unit");
    PROVE(is_in(in.down_q30.x, DOWN_MOST_Q30) && is_in(in.down_q30.z, DOWN_MOST_Q30), "the weight's direction");
    PROVE(in.force_exponent >= FORCE_EXPONENT_LEAST && in.force_exponent <= FORCE_MOST_EXPONENT, "the unit of force");
    const int64_t x = size_of(in.tip_q30.x), z = size_of(in.tip_q30.z), weight = limb.weight_q31 >> in.weight_shift;
    const int64_t force = x > z ? x + z / 2 : z + x / 2; /* at least the length */
    PROVE(force + weight * DOWN_MOST_64THS / 64 <= FORCE_UNIT, "force and weight together are below it");
    return 0;
}
