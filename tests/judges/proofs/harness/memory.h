/* The non-volatile memory as any content and any answer: what is read is anything, differently each time, and each call
 * may be refused. What is asked of it is proven to be what brace_hal.h allows. */
#ifndef BRACE_PROOF_MEMORY_H
#define BRACE_PROOF_MEMORY_H

#include "brace_hal.h"
#include "proof.h"

/* The stretch of a slot that the code under proof may touch. */
static uint32_t memory_from, memory_end;
static uint32_t memory_writes, memory_erases; /* calls, refused ones too */
static uint32_t written_slot, written_at, erased_slot;

static bool within(uint32_t slot, uint32_t offset, uint32_t count)
{
    return slot < (uint32_t)BRACE_NVM_SLOT_COUNT && offset >= memory_from && offset <= memory_end &&
           count <= memory_end - offset;
}

static int32_t any_answer(void)
{
    return any_bool() ? BRACE_HAL_OK : BRACE_HAL_E_DEVICE;
}

static int32_t any_read(void *context, uint32_t slot, uint32_t offset, uint8_t *bytes, uint32_t count)
{
    (void)context;
    PROVE(within(slot, offset, count), "what is read is there");
    PROVE(__CPROVER_w_ok(bytes, count), "there is room for what is read");
    if (any_answer() != BRACE_HAL_OK) {
        return BRACE_HAL_E_DEVICE;
    }
    __CPROVER_havoc_slice(bytes, count);
    return BRACE_HAL_OK;
}

static int32_t any_write(void *context, uint32_t slot, uint32_t offset, const uint8_t *bytes, uint32_t count)
{
    (void)context;
    PROVE(within(slot, offset, count) && offset % 8u == 0u && count % 8u == 0u,
          "what is written are whole units of the slot");
    PROVE(__CPROVER_r_ok(bytes, count), "what is written is there");
    memory_writes++;
    written_slot = slot;
    written_at = offset;
    return any_answer();
}

static int32_t any_erase(void *context, uint32_t slot)
{
    (void)context;
    PROVE(slot < (uint32_t)BRACE_NVM_SLOT_COUNT, "a slot that there is");
    memory_erases++;
    erased_slot = slot;
    return any_answer();
}

/* Units of 1 to 8 bytes: code that writes eights suits all of them. */
static const brace_hal_t any_memory = {
    .nvm_shape = {8192, 8}, .nvm_read = any_read, .nvm_write = any_write, .nvm_erase = any_erase};

#endif
