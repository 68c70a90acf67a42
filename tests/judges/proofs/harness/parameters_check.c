#include "brace/parameters.h"
#include "parameter_table.h"
#include "proof.h"
#include "brace/words.h"

static brace_status_t judgement;

brace_status_t brace_limb_check_together(const brace_limb_t *limb)
{
    PROVE(__CPROVER_r_ok(limb, sizeof *limb), "a whole limb is judged");
    return judgement;
}

int main(void)
{
    brace_parameters_t parameters; /* of any content */
    uint32_t wrong_index = any_u32();
    const uint32_t member = any_u32(), before = wrong_index;
    ASSUME(member < BRACE_PARAMETER_COUNT); /* any one of them, so all */
    judgement = (brace_status_t)any_i32();
    ASSUME(judgement == BRACE_OK || judgement == BRACE_E_PARAMETER || judgement == BRACE_E_NOT_FINITE);

    const brace_status_t status = brace_parameters_check(&parameters, &wrong_index);

    const uint32_t word = brace_member_get(&parameters, member), rule = brace_parameter_rule[member];
    float value;
    memcpy(&value, &word, sizeof value);
    if (status == BRACE_OK) {
        PROVE(judgement == BRACE_OK, "accepted: the limb can exist");
        PROVE(parameters.controller.age_limit_us >= parameters.controller.tick_us,
              "accepted: the age limit is a tick or more");
    }
    if (status == BRACE_OK && rule < BRACE_F32_RANGES) {
        PROVE(value >= brace_f32_range[rule][0] && value <= brace_f32_range[rule][1],
              "accepted: every number is in its range");
    }
    if (status == BRACE_OK && rule >= BRACE_F32_RANGES && rule < BRACE_F32_RANGES + BRACE_U32_RANGES) {
        const uint32_t *range = brace_u32_range[rule - BRACE_F32_RANGES];
        PROVE(word >= range[0] && word <= range[1], "accepted: every whole number is in its range");
    }
    const bool names_member = status == BRACE_E_PARAMETER || status == BRACE_E_NOT_FINITE;
    PROVE(names_member || status == BRACE_OK, "accepted, or why not");
    PROVE(names_member ? wrong_index <= BRACE_PARAMETER_COUNT : wrong_index == before,
          "the member at fault is named, and only then");
    return 0;
}
