/* What a start finds in a slot, whatever the memory holds and refuses. */
#include "memory.h"
#include "src/store_slot.h"

uint32_t brace_crc32(uint32_t crc, const uint8_t *bytes, uint32_t count)
{
    (void)crc;
    PROVE(__CPROVER_r_ok(bytes, count), "the CRC is of bytes that are there");
    return any_u32();
}

/* As block_unpack proves it: any header, and a length that the block itself states. */
brace_status_t brace_block_header(const uint8_t *block, uint32_t length, brace_block_header_t *header)
{
    PROVE(__CPROVER_r_ok(block, length), "a whole block");
    const int32_t status = any_i32();
    ASSUME(status <= 0 && status >= BRACE_E_MODE);
    header->schema_hash = any_u32();
    header->sequence = any_u32();
    header->block_bytes = any_u32();
    ASSUME(status != BRACE_OK || header->block_bytes >= BRACE_BLOCK_HEADER_BYTES + 4u);
    return (brace_status_t)status;
}

brace_status_t brace_parameters_unpack(const uint8_t *block, uint32_t length, brace_parameters_t *parameters,
                                       uint32_t *sequence, uint32_t *wrong_index)
{
    (void)parameters;
    (void)sequence;
    PROVE(__CPROVER_r_ok(block, length) && length == BRACE_BLOCK_BYTES, "a whole block");
    *wrong_index = any_u32();
    const int32_t status = any_i32();
    ASSUME(status <= 0 && status >= BRACE_E_MODE);
    return (brace_status_t)status;
}

int main(void)
{
    brace_store_t store; /* of any content, as all of these */
    brace_parameters_t set;
    memory_from = 0;
    memory_end = 4096;
    memory_writes = memory_erases = 0;
    store.hal = &any_memory;
    const uint32_t slot = any_bool() ? 1u : 0u, other = 1u - slot;
    const uint8_t other_mark = store.next_mark[other];
    ASSUME(store.next_mark[slot] <= BRACE_STORE_MARK_COUNT); /* a start sets it to 0 first */
    store_claim_t claim;
    store_look(&store, slot, &set, &claim);
    PROVE(!claim.is_past || store.slot[slot].condition == BRACE_SLOT_COUNTS, "what another set has followed counts");
    PROVE(!claim.is_rotten || store.slot[slot].condition == BRACE_SLOT_DAMAGED ||
              store.slot[slot].condition == BRACE_SLOT_REFUSED,
          "what has rotted does not");
    PROVE(store.next_mark[slot] <= BRACE_STORE_MARK_COUNT, "the next mark goes within their places");
    PROVE((uint32_t)store.slot[slot].condition <= (uint32_t)BRACE_SLOT_UNREADABLE, "a condition that there is");
    PROVE(!store.clean[slot] && !store.affirmed[slot], "nothing is taken for untouched or affirmed");
    PROVE(store.next_mark[other] == other_mark, "the other slot is left alone");
    PROVE(memory_writes == 0u && memory_erases == 0u, "the memory is only read");
    return 0;
}
