/* The inputs of K under load in fixed point, any floats: the units, and the load in them. */
#include "proof.h"
#include "loaded_sizes.h"
#include "loaded/loaded_fixed.c"

#include "fixed/fixed_table.c"

static bool is_in(int64_t number, int64_t most)
{
    return number <= most && number >= -most;
}

/* What the collapse makes, as far as the units go: exponents of floats and their sums. */
static void is_collapsed(const brace_loaded_fixed_t *limb)
{
    ASSUME(is_in(limb->length_exponent, 128) && is_in(limb->bend_exponent, 256) && is_in(limb->spring_exponent, 256));
    ASSUME(is_in(limb->weight_exponent, 128) && limb->weight_q8 <= 1u << 30 && limb->base_rotation_q31 >= 0);
    /* one and a half times the weight is above the power of two below it */
    ASSUME(limb->weight_exponent <= 24 - (int32_t)leading_zeros(limb->weight_q8 + 2u));
}

int main(void)
{
    brace_loaded_fixed_t limb;
    brace_load_t load;
    fixed_inputs_t in;
    is_collapsed(&limb);
    if (inputs_of(&limb, any_float(), any_float(), &load, &in) != BRACE_OK) {
        return 0;
    }
    PROVE(in.hip >= 0 && in.hip_yields >= 0 && in.knee >= 0 && in.knee_yields >= 0, "compliances are not negative");
    PROVE(in.bend_shift >= 1u && in.bend_shift <= 31u, "curvatures' shift");
    PROVE(in.spring_shift >= 3u && in.spring_shift <= 31u, "springs' shift: they move by a quarter");
    PROVE(in.root_shift >= 2u && in.root_shift <= 31u, "and their roots'");
    PROVE(in.weight_shift >= 1u && in.weight_shift <= 31u && in.parity <= 1u, "weights' shift");
    PROVE(is_in(in.tip_q30.x, 1 << 30) && is_in(in.tip_q30.z, 1 << 30), "the force is below its unit");
    PROVE(is_in(in.down_q30.x, DOWN_MOST_Q30) && is_in(in.down_q30.z, DOWN_MOST_Q30), "the weight's direction");
    PROVE(is_in(in.force_exponent, 60), "the unit of force is a float's");
    return 0;
}
