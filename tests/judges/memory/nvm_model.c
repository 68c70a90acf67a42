#include "nvm_model.h"

#include <string.h>

static uint8_t lot(nvm_t *nvm)
{
    nvm->random = nvm->random * 1664525u + 1013904223u;
    return (uint8_t)(nvm->random >> 23);
}

void nvm_init(nvm_t *nvm, uint32_t unit)
{
    memset(nvm, 0, sizeof *nvm);
    memset(nvm->bytes, 0xff, sizeof nvm->bytes);
    nvm->unit = unit;
    nvm->random = 12345u;
    nvm_power(nvm, NVM_FOREVER, CUT_AFTER);
}

void nvm_power(nvm_t *nvm, int32_t steps, cut_manner_t manner)
{
    nvm->steps_left = steps;
    nvm->manner = manner;
    nvm->dead = false;
    nvm->steps_done = 0;
    nvm->erases_begun = 0;
}

/* Bits of byte i of `count` that are as after the step. */
static uint8_t share_done(nvm_t *nvm, uint32_t i, uint32_t count)
{
    switch (nvm->manner) {
    case CUT_BEFORE: return 0x00;
    case CUT_FIRST_HALF: return count == 1u ? 0x0f : i < count / 2u ? 0xff : 0x00;
    case CUT_SECOND_HALF: return count == 1u ? 0xf0 : i < count / 2u ? 0x00 : 0xff;
    case CUT_EVEN_BITS: return 0x55;
    case CUT_ODD_BITS: return 0xaa;
    case CUT_RANDOM_BITS: return lot(nvm);
    default: return 0xff;
    }
}

/* The step that power fails in, on bytes [offset, offset + count): as before in nvm->bytes, `after` wanted. */
static void interrupt(nvm_t *nvm, uint32_t slot, uint32_t offset, const uint8_t *after, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        uint8_t *byte = &nvm->bytes[slot][offset + i];
        const uint32_t at = offset + i;
        if (nvm->manner >= CUT_UNSTABLE) {
            nvm->after[slot][at] = after[i];
            nvm->unstable[slot][at] = (uint8_t)nvm->manner;
        } else if (nvm->manner == CUT_ZEROS) {
            *byte = 0;
        } else if (nvm->manner == CUT_NOISE) {
            *byte = lot(nvm);
        } else {
            const uint8_t done = share_done(nvm, i, count);
            *byte = (uint8_t)((*byte & ~done) | (after[i] & done));
        }
    }
    nvm->dead = true;
}

/* Is this step the last one? */
static bool fails_now(nvm_t *nvm)
{
    nvm->steps_done++;
    if (nvm->steps_left == NVM_FOREVER) {
        return false;
    }
    return --nvm->steps_left == 0;
}

static const uint8_t all_stable[NVM_SLOT_BYTES];

static int32_t nvm_read(void *context, uint32_t slot, uint32_t offset, uint8_t *bytes, uint32_t count)
{
    nvm_t *nvm = context;
    if (nvm->dead || nvm->reading_fails) {
        return BRACE_HAL_E_DEVICE;
    }
    if (slot >= BRACE_NVM_SLOT_COUNT || offset + count > NVM_SLOT_BYTES) {
        nvm->misuse++;
        return BRACE_HAL_E_RANGE;
    }
    const uint8_t all = (lot(nvm) & 1u) != 0 ? 0xff : 0x00; /* of CUT_UNSTABLE_WHOLE: one lot a read */
    if (memcmp(&nvm->unstable[slot][offset], all_stable, count) == 0) {
        memcpy(bytes, &nvm->bytes[slot][offset], count);
        return BRACE_HAL_OK;
    }
    for (uint32_t i = 0; i < count; i++) {
        const uint8_t before = nvm->bytes[slot][offset + i], after = nvm->after[slot][offset + i];
        const uint8_t manner = nvm->unstable[slot][offset + i];
        const uint8_t chosen = manner == CUT_UNSTABLE_WHOLE ? all : manner != 0 ? lot(nvm) : 0;
        bytes[i] = manner == CUT_UNSTABLE_NOISE ? chosen : (uint8_t)((before & ~chosen) | (after & chosen));
    }
    return BRACE_HAL_OK;
}

static bool is_zero(const uint8_t *bytes, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        if (bytes[i] != 0) {
            return false;
        }
    }
    return true;
}

/* returns false when power fails in it */
static bool write_unit(nvm_t *nvm, uint32_t slot, uint32_t offset, const uint8_t *bytes)
{
    const bool again = nvm->written[slot][offset] != 0;
    const bool zeros = is_zero(bytes, nvm->unit);
    nvm->misuse += again && !zeros && !nvm->half_erased[slot];
    memset(&nvm->written[slot][offset], 1, nvm->unit);
    if (fails_now(nvm)) {
        interrupt(nvm, slot, offset, bytes, nvm->unit);
        return false;
    }
    for (uint32_t i = 0; i < nvm->unit; i++) {
        const uint8_t kept = (uint8_t)(bytes[i] | nvm->stuck_mask[slot][offset + i]);
        nvm->bytes[slot][offset + i] &= kept;
        nvm->after[slot][offset + i] &= kept;
        if (zeros && !nvm->half_erased[slot]) { /* every cell driven to the end; otherwise what was unstable stays so */
            nvm->unstable[slot][offset + i] = 0;
        }
    }
    return true;
}

static int32_t nvm_write(void *context, uint32_t slot, uint32_t offset, const uint8_t *bytes, uint32_t count)
{
    nvm_t *nvm = context;
    if (nvm->dead || nvm->writing_fails) {
        return BRACE_HAL_E_DEVICE;
    }
    if (slot >= BRACE_NVM_SLOT_COUNT || offset + count > NVM_SLOT_BYTES || offset % nvm->unit != 0u ||
        count % nvm->unit != 0u) {
        nvm->misuse++;
        return BRACE_HAL_E_RANGE;
    }
    for (uint32_t at = 0; at < count; at += nvm->unit) {
        if (!write_unit(nvm, slot, offset + at, bytes + at)) {
            return BRACE_HAL_E_DEVICE;
        }
    }
    return BRACE_HAL_OK;
}

static int32_t nvm_erase(void *context, uint32_t slot)
{
    static uint8_t erased[NVM_SLOT_BYTES];
    nvm_t *nvm = context;
    if (nvm->dead || nvm->erasing_fails) {
        return BRACE_HAL_E_DEVICE;
    }
    if (slot >= BRACE_NVM_SLOT_COUNT) {
        nvm->misuse++;
        return BRACE_HAL_E_RANGE;
    }
    memset(erased, 0xff, sizeof erased);
    nvm->erases_begun++;
    if (fails_now(nvm)) {
        interrupt(nvm, slot, 0, erased, NVM_SLOT_BYTES);
        nvm->half_erased[slot] = true;
        return BRACE_HAL_E_DEVICE;
    }
    if (!nvm->erasing_forgets) {
        nvm->half_erased[slot] = false;
        memset(nvm->bytes[slot], 0xff, NVM_SLOT_BYTES);
        memset(nvm->unstable[slot], 0, NVM_SLOT_BYTES);
        memset(nvm->written[slot], 0, NVM_SLOT_BYTES);
    }
    return BRACE_HAL_OK;
}

brace_hal_t nvm_hal(nvm_t *nvm)
{
    return (brace_hal_t){.context = nvm,
                         .board = "power-cut model",
                         .nvm_shape = {.slot_bytes = NVM_SLOT_BYTES, .write_bytes = nvm->unit},
                         .nvm_read = nvm_read,
                         .nvm_write = nvm_write,
                         .nvm_erase = nvm_erase};
}
