#include "brace/parameters.h"
#include "proof.h"
#include "brace/words.h"

static uint32_t sum;
static brace_status_t judgement;

/* Any number, the same for both calls: they are of the same bytes, as is proven below for any one of them. */
uint32_t brace_crc32(uint32_t crc, const uint8_t *bytes, uint32_t count)
{
    PROVE(crc == 0u && count == BRACE_BLOCK_BYTES - 4 && __CPROVER_r_ok(bytes, count), "the CRC is of the whole block");
    return sum;
}

brace_status_t brace_parameters_check(const brace_parameters_t *parameters, uint32_t *wrong_index)
{
    (void)parameters;
    (void)wrong_index;
    return judgement;
}

int main(void)
{
    brace_parameters_t parameters, back; /* of any content */
    uint8_t block[BRACE_BLOCK_BYTES];
    uint32_t back_sequence = any_u32();
    const uint32_t sequence = any_u32(), room = any_u32(), member = any_u32(), at = any_u32();
    sum = any_u32();
    judgement = (brace_status_t)any_i32();
    ASSUME(judgement <= BRACE_OK && member < BRACE_PARAMETER_COUNT && at < BRACE_BLOCK_BYTES);
    const uint8_t before = block[at];

    const brace_status_t packed = brace_parameters_pack(&parameters, sequence, block, room);
    PROVE((packed == BRACE_OK) == (judgement == BRACE_OK && room >= BRACE_BLOCK_BYTES),
          "packed what may be, and only that");
    if (packed != BRACE_OK) {
        PROVE(block[at] == before, "refused: the block is untouched");
        return 0;
    }
    const uint8_t written = block[at];
    const brace_status_t unpacked = brace_parameters_unpack(block, BRACE_BLOCK_BYTES, &back, &back_sequence, NULL);
    PROVE(block[at] == written, "unpacking changes nothing");
    PROVE(unpacked == BRACE_OK, "what is packed is taken");
    PROVE(brace_member_get(&back, member) == brace_member_get(&parameters, member), "every member comes back");
    PROVE(back_sequence == sequence, "the sequence comes back");
    return 0;
}
