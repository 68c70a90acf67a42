/* The inputs of K under a load in space, in fixed point, any floats: the units, and the load in them. And by how much
 * the second step to the rest is prolonged, from any products of steps. */
#include "proof.h"
#include "loaded_sizes.h"
#include "fixed_space/space_kept.h"
#include "fixed_space/loaded_space_fixed.c"

#include "fixed/fixed_table.c"

static bool is_in(int64_t number, int64_t most)
{
    return number <= most && number >= -most;
}

/* What the collapse makes, as far as the units go: exponents of floats and their sums, and its last look. */
static void is_collapsed(const brace_loaded_space_fixed_t *limb)
{
    ASSUME(is_in(limb->length_exponent, 128) && is_in(limb->turn_exponent, 512) && is_in(limb->spring_exponent, 256));
    ASSUME(is_in(limb->weight_exponent, 128));
    ASSUME(limb->beyond_coxa_q31 >= 0 && limb->beyond_femur_q31 >= 0 && limb->base_rotation_q31 >= 0);
    ASSUME(limb->femur.weight_q31 >= 0 && limb->tibia.weight_q31 >= 0 && is_weight_kept(limb));
}

static void inputs(void)
{
    brace_loaded_space_fixed_t limb;
    brace_space_load_t load;
    fixed_inputs3_t in;
    fixed_rest3_t rest;
    is_collapsed(&limb);
    if (inputs_of(&limb, any_float(), any_float(), &load, &in, &rest) != BRACE_OK) {
        return;
    }
    const fixed_yields_t *const yields = &in.yields;
    PROVE(yields->base_q26 >= 0 && yields->yaw_q26 >= 0 && yields->hip_q26 >= 0 && yields->knee_q26 >= 0,
          "compliances are not negative");
    PROVE(rest.base_q26 == yields->base_q26 && rest.yaw_q26 >= 0 && rest.hip_q26 >= 0 && rest.knee_q26 >= 0,
          "nor are slopes");
    PROVE(rest.turn_shift <= 31u && rest.spring_shift <= 31u && yields->turn_shift == rest.turn_shift, "shifts");
    PROVE(is_in(in.down_q30.x, DOWN_MOST_Q30) && is_in(in.down_q30.y, DOWN_MOST_Q30) &&
              is_in(in.down_q30.z, DOWN_MOST_Q30), "the weight's direction");
    PROVE(is_in(in.tip_q30.x, 1 << 30) && is_in(in.tip_q30.y, 1 << 30) && is_in(in.tip_q30.z, 1 << 30),
          "the force is below its unit");
    PROVE(in.weights.beyond_coxa_q30 >= 0 && in.weights.beyond_femur_q30 >= 0 && in.weights.femur_q30 >= 0 &&
              in.weights.tibia_q30 >= 0, "weights pull");
    PROVE(is_in(rest.force_exponent, 60), "the unit of force is a float's");
}

static void step(void)
{
    const int32_t second_by_first = any_i32();
    ASSUME(is_in(second_by_first, 1 << 30));
    const int32_t over = over_second_step(second_by_first, any_u32());
    PROVE(over >= PART_OF(29, 0.5) && over <= PART_OF(29, 2.001), "the second step is prolonged, up to twice");
}

int main(void)
{
    inputs();
    step();
    return 0;
}
