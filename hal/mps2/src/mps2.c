/* The door on the MPS2 board: time, memory, watchdog, and the entries that the board gives. */
#include "brace_hal_mps2.h"

#include "mps2_registers.h"
#include "mps2_serial.h"

enum { US_PER_S = 1000000, WATCHDOG_PATIENCE_S = 3, NVM_WRITE_BYTES = 4 };

static const mps2_board_t *mps2_board;

uint32_t mps2_now_us(void)
{
    return FPGAIO_COUNTER;
}

static uint32_t now_us(void *context)
{
    (void)context;
    return mps2_now_us();
}

static int32_t no_joint(void *context, int32_t joint_index, brace_hal_joint_t *joint)
{
    (void)context;
    (void)joint_index;
    (void)joint;
    return BRACE_HAL_E_UNSUPPORTED;
}

static bool within_slot(uint32_t slot, uint32_t offset, uint32_t count)
{
    return slot < BRACE_NVM_SLOT_COUNT && offset <= MPS2_NVM_SLOT_BYTES && count <= MPS2_NVM_SLOT_BYTES - offset;
}

static int32_t nvm_read(void *context, uint32_t slot, uint32_t offset, uint8_t *bytes, uint32_t count)
{
    (void)context;
    if (!within_slot(slot, offset, count)) {
        return BRACE_HAL_E_RANGE;
    }
    const uint8_t *const from = mps2_board->nvm + slot * MPS2_NVM_SLOT_BYTES + offset;
    for (uint32_t i = 0u; i < count; i++) {
        bytes[i] = from[i];
    }
    return BRACE_HAL_OK;
}

static int32_t nvm_write(void *context, uint32_t slot, uint32_t offset, const uint8_t *bytes, uint32_t count)
{
    (void)context;
    if (!within_slot(slot, offset, count) || offset % NVM_WRITE_BYTES != 0u || count % NVM_WRITE_BYTES != 0u) {
        return BRACE_HAL_E_RANGE;
    }
    uint8_t *const to = mps2_board->nvm + slot * MPS2_NVM_SLOT_BYTES + offset;
    for (uint32_t i = 0u; i < count; i++) {
        to[i] &= bytes[i]; /* as in flash: a write clears bits, an erase sets them */
    }
    return BRACE_HAL_OK;
}

static int32_t nvm_erase(void *context, uint32_t slot)
{
    (void)context;
    if (slot >= BRACE_NVM_SLOT_COUNT) {
        return BRACE_HAL_E_RANGE;
    }
    uint8_t *const to = mps2_board->nvm + slot * MPS2_NVM_SLOT_BYTES;
    for (uint32_t i = 0u; i < MPS2_NVM_SLOT_BYTES; i++) {
        to[i] = 0xffu;
    }
    return BRACE_HAL_OK;
}

static void watchdog_feed(void *context)
{
    (void)context;
    WATCHDOG->clear = 1u; /* reloads the counter, and forgets a first time-out */
}

static void watchdog_start(void)
{
    WATCHDOG->load = (uint32_t)WATCHDOG_PATIENCE_S * MPS2_CORE_HZ;
    WATCHDOG->control = WATCHDOG_CONTROL_INTERRUPT | WATCHDOG_CONTROL_RESET;
}

const brace_hal_t *brace_hal_mps2(const mps2_board_t *board)
{
    static brace_hal_t hal;
    mps2_board = board;
    hal = (brace_hal_t){
        .board = board->name,
        .now_us = now_us,
        .joint_read = board->joint_read != 0 ? board->joint_read : no_joint,
        .nvm_shape = {.slot_bytes = MPS2_NVM_SLOT_BYTES, .write_bytes = NVM_WRITE_BYTES},
        .nvm_read = nvm_read,
        .nvm_write = nvm_write,
        .nvm_erase = nvm_erase,
        .serial_setup = mps2_serial_setup,
        .serial_write = mps2_serial_write,
        .serial_read = mps2_serial_read,
        .watchdog_feed = watchdog_feed,
        .reset_cause = board->reset_cause,
        .crash_read = board->crash_read,
        .crash_clear = board->crash_clear,
        .stack_unused_bytes = board->stack_unused_bytes,
        .restart = board->restart,
    };
    FPGAIO_PRESCALE = FPGAIO_HZ / US_PER_S - 1u;
    FPGAIO_COUNTER = 0u;
    if (board->watchdog) {
        watchdog_start();
    }
    return &hal;
}
