/* A door for an emulated Cortex-M4F, made from hal/blank: time by SysTick, two joints that stand still, and memory that
 * lasts as long as the power. It has no CAN, no console and no watchdog: what a board does not have stays null or says
 * so. */
#include "board.h"

#include <math.h>
#include <string.h>

#define CPACR (*(volatile uint32_t *)0xE000ED88u)
#define SYST_CSR (*(volatile uint32_t *)0xE000E010u)
#define SYST_RVR (*(volatile uint32_t *)0xE000E014u)
#define SYST_CVR (*(volatile uint32_t *)0xE000E018u)

enum { CORE_HZ = 25000000, PER_US = CORE_HZ / 1000000, PER_MS = 1000 * PER_US };
enum { SLOT_BYTES = 16384 };

static volatile uint32_t milliseconds;
static uint8_t slots[BRACE_NVM_SLOT_COUNT][SLOT_BYTES];

/* --- start-up ------------------------------------------------------------------------------------------------ */

extern void _start(void); /* the C library's: clears memory, calls main */

static void reset(void)
{
    CPACR |= 0xFu << 20; /* the FPU on */
    __asm__ volatile("dsb\n\tisb");
    _start();
}

static void fault(void)
{
    for (;;) {
    }
}

static void systick(void)
{
    milliseconds++;
}

extern void (*const vectors[16])(void);
__attribute__((section(".vectors"))) void (*const vectors[16])(void) = {
    (void (*)(void))0x20400000u, /* the stack: the end of RAM */
    reset,
    fault,
    fault,
    fault,
    fault,
    fault,
    [15] = systick,
};

/* --- time ------------------------------------------------------------------------------------------------------ */

static uint32_t now_us(void *context)
{
    (void)context;
    uint32_t whole, left;
    do { /* again where the interrupt came between the two */
        whole = milliseconds;
        left = SYST_CVR;
    } while (whole != milliseconds);
    return 1000u * whole + (PER_MS - 1u - left) / PER_US;
}

/* --- joints: yours read encoders and motor currents -------------------------------------------------------------- */

static int32_t joint_read(void *context, int32_t joint_index, brace_hal_joint_t *joint)
{
    if (joint_index != 1 && joint_index != 2) {
        return BRACE_HAL_E_UNSUPPORTED; /* no coxa joint: a limb in its plane */
    }
    *joint = (brace_hal_joint_t){
        .motor_rad = joint_index == 1 ? 1.0f : 1.4f,
        .torque_n_mm = 0.0f,
        .link_rad = NAN,
        .temp_degc = NAN,
        .taken_us = now_us(context),
    };
    return BRACE_HAL_OK;
}

/* --- memory: yours is flash -------------------------------------------------------------------------------------- */

static bool is_inside(uint32_t slot, uint32_t offset, uint32_t count)
{
    return slot < BRACE_NVM_SLOT_COUNT && offset <= SLOT_BYTES && count <= SLOT_BYTES - offset;
}

static int32_t nvm_read(void *context, uint32_t slot, uint32_t offset, uint8_t *bytes, uint32_t count)
{
    (void)context;
    if (!is_inside(slot, offset, count)) {
        return BRACE_HAL_E_RANGE;
    }
    memcpy(bytes, slots[slot] + offset, count);
    return BRACE_HAL_OK;
}

static int32_t nvm_write(void *context, uint32_t slot, uint32_t offset, const uint8_t *bytes, uint32_t count)
{
    (void)context;
    if (!is_inside(slot, offset, count)) {
        return BRACE_HAL_E_RANGE;
    }
    memcpy(slots[slot] + offset, bytes, count);
    return BRACE_HAL_OK;
}

static int32_t nvm_erase(void *context, uint32_t slot)
{
    (void)context;
    if (slot >= BRACE_NVM_SLOT_COUNT) {
        return BRACE_HAL_E_RANGE;
    }
    memset(slots[slot], 0xff, SLOT_BYTES);
    return BRACE_HAL_OK;
}

/* --- what this board does not have ------------------------------------------------------------------------------ */

static int32_t serial_setup(void *context, brace_serial_port_t port, uint32_t baud, brace_parity_t parity)
{
    (void)context, (void)port, (void)baud, (void)parity;
    return BRACE_HAL_E_UNSUPPORTED;
}

static int32_t serial_write(void *context, brace_serial_port_t port, const uint8_t *bytes, uint32_t count)
{
    (void)context, (void)port, (void)bytes, (void)count;
    return BRACE_HAL_E_UNSUPPORTED;
}

static int32_t serial_read(void *context, brace_serial_port_t port, uint8_t *bytes, uint32_t room)
{
    (void)context, (void)port, (void)bytes, (void)room;
    return BRACE_HAL_E_UNSUPPORTED;
}

static void nothing(void *context)
{
    (void)context;
}

static brace_reset_cause_t reset_cause(void *context)
{
    (void)context;
    return BRACE_RESET_POWER;
}

static int32_t crash_read(void *context, brace_crash_record_t *record)
{
    (void)context, (void)record;
    return 0;
}

static uint32_t stack_unused_bytes(void *context)
{
    (void)context;
    return 0u; /* not known */
}

const brace_hal_t *board_start(void)
{
    static const brace_hal_t hal = {
        .board = "own board",
        .now_us = now_us,
        .joint_read = joint_read,
        .nvm_shape = {.slot_bytes = SLOT_BYTES, .write_bytes = 4u},
        .nvm_read = nvm_read,
        .nvm_write = nvm_write,
        .nvm_erase = nvm_erase,
        .serial_setup = serial_setup,
        .serial_write = serial_write,
        .serial_read = serial_read,
        .watchdog_feed = nothing,
        .reset_cause = reset_cause,
        .crash_read = crash_read,
        .crash_clear = nothing,
        .stack_unused_bytes = stack_unused_bytes,
        .restart = nothing,
    };
    memset(slots, 0xff, sizeof slots);
    SYST_RVR = PER_MS - 1u;
    SYST_CVR = 0u;
    SYST_CSR = 7u; /* the core's clock, interrupt, on */
    return &hal;
}
