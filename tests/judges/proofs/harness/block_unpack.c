#include "brace/parameters.h"
#include "proof.h"
#include "brace/words.h"

#include <stdlib.h>

/* Any number: right for whatever the true one is. */
uint32_t brace_crc32(uint32_t crc, const uint8_t *bytes, uint32_t count)
{
    (void)crc;
    PROVE(__CPROVER_r_ok(bytes, count), "the CRC is of bytes that were given");
    return any_u32();
}

static brace_status_t judgement;

brace_status_t brace_parameters_check(const brace_parameters_t *parameters, uint32_t *wrong_index)
{
    PROVE(__CPROVER_r_ok(parameters, sizeof *parameters), "a whole set is judged");
    if (judgement != BRACE_OK && wrong_index != NULL) {
        *wrong_index = BRACE_PARAMETER_COUNT;
    }
    return judgement;
}

int main(void)
{
    brace_parameters_t parameters;
    const uint32_t length = any_u32(), before = any_u32(), member = any_u32();
    uint32_t sequence = any_u32(), wrong_index = any_u32();
    const uint32_t sequence_before = sequence, wrong_before = wrong_index;
    ASSUME(length <= BRACE_BLOCK_BYTES + 4);
    ASSUME(member < BRACE_PARAMETER_COUNT); /* any one of them, so all */
    judgement = (brace_status_t)any_i32();
    ASSUME(judgement == BRACE_OK || judgement == BRACE_E_PARAMETER || judgement == BRACE_E_NOT_FINITE);
    const uint8_t *block = malloc(length); /* of any content; the byte behind the last is nobody's */
    ASSUME(block != NULL);
    brace_member_put(&parameters, member, before);

    const brace_status_t status = brace_parameters_unpack(block, length, &parameters, &sequence, &wrong_index);

    const uint32_t after = brace_member_get(&parameters, member);
    if (status == BRACE_OK) {
        PROVE(length == BRACE_BLOCK_BYTES, "only a whole block is taken");
        PROVE(judgement == BRACE_OK, "only what the check accepts is taken");
        PROVE(after == brace_get_u32(block + BRACE_BLOCK_HEADER_BYTES + 4u * member), "the members are the block's");
        PROVE(sequence == brace_get_u32(block + 16), "the sequence is the block's");
    } else {
        PROVE(after == before, "refused: the parameters are untouched");
        PROVE(sequence == sequence_before, "refused: the sequence is untouched");
    }
    const bool names_member = status == BRACE_E_PARAMETER || status == BRACE_E_NOT_FINITE;
    PROVE(names_member || wrong_index == wrong_before, "a member at fault is named only where one is");
    return 0;
}
