/* A port's first file. The comment of each entry says what to write there. Until then the entry answers what is true of
 * a board without that hardware. Fill the entries in in this order: each step can be tried with the steps above it.
 *
 * A real port keeps its state in a struct of its own and gives it to every entry as `context`. It fills the door in an
 * init function, because some of the door (nvm_shape, a null for an absent group) may depend on what the board has. */
#include "brace_hal_blank.h"

/* --- 1. time: everything is measured by it ------------------------------------------------------------------ */

/* The firmware needs a free-running 32-bit counter at 1 MHz. A 16-bit timer can be extended in its overflow interrupt;
 * then read high part, low part, high part again until both high parts agree. */
static uint32_t now_us(void *context)
{
    (void)context;
    return 0u;
}

/* --- 2. serial: the console, so that the board can speak ----------------------------------------------------- */

/* Set baud, parity and pins; enable the receive interrupt. Start with BRACE_SERIAL_CONSOLE; the others can wait. */
static int32_t serial_setup(void *context, brace_serial_port_t port, uint32_t baud, brace_parity_t parity)
{
    (void)context;
    (void)port;
    (void)baud;
    (void)parity;
    return BRACE_HAL_E_UNSUPPORTED;
}

/* Copy into a ring that the transmit interrupt empties, and return how many bytes fitted. Never wait. */
static int32_t serial_write(void *context, brace_serial_port_t port, const uint8_t *bytes, uint32_t count)
{
    (void)context;
    (void)port;
    (void)bytes;
    (void)count;
    return BRACE_HAL_E_UNSUPPORTED;
}

/* Copy out of the ring that the receive interrupt fills. Drop bytes with a parity or framing error: the frame that they
 * belong to then fails its check. */
static int32_t serial_read(void *context, brace_serial_port_t port, uint8_t *bytes, uint32_t room)
{
    (void)context;
    (void)port;
    (void)bytes;
    (void)room;
    return BRACE_HAL_E_UNSUPPORTED;
}

/* --- 3. start, stop, crash: why it started, and starting anew ------------------------------------------------ */

/* Read the reset flags once at start, and clear them, so that the next start does not see old ones. */
static brace_reset_cause_t reset_cause(void *context)
{
    (void)context;
    return BRACE_RESET_POWER;
}

/* firmware/boards/common/kept.h keeps the record in memory that a reset leaves alone: call its functions here. */
static int32_t crash_read(void *context, brace_crash_record_t *record)
{
    (void)context;
    (void)record;
    return 0;
}

static void crash_clear(void *context)
{
    (void)context;
}

/* On a Cortex-M, firmware/boards/common/stack.h has this. */
static uint32_t stack_unused_bytes(void *context)
{
    (void)context;
    return 0u;
}

/* On a Cortex-M, set SYSRESETREQ. */
static void restart(void *context)
{
    (void)context;
}

/* --- 4. watchdog: last to be switched on, since it bites while you debug -------------------------------------- */

static void watchdog_feed(void *context)
{
    (void)context;
}

/* --- 5. joints: what the limb is about ------------------------------------------------------------------------- */

/* Return both angles in the joint's own sense, after the reduction, and the torque from the current. Sample in an
 * interrupt or by DMA, and copy the newest sample here. When no sample is newer, return AGAIN with the last one. What
 * the joint does not measure is NaN. */
static int32_t joint_read(void *context, int32_t joint_index, brace_hal_joint_t *joint)
{
    (void)context;
    (void)joint_index;
    (void)joint;
    return BRACE_HAL_E_UNSUPPORTED;
}

/* --- 6. non-volatile memory: two slots that can be erased apart from each other and from the image ------------- */

static int32_t nvm_read(void *context, uint32_t slot, uint32_t offset, uint8_t *bytes, uint32_t count)
{
    (void)context;
    (void)slot;
    (void)offset;
    (void)bytes;
    (void)count;
    return BRACE_HAL_E_UNSUPPORTED;
}

static int32_t nvm_write(void *context, uint32_t slot, uint32_t offset, const uint8_t *bytes, uint32_t count)
{
    (void)context;
    (void)slot;
    (void)offset;
    (void)bytes;
    (void)count;
    return BRACE_HAL_E_UNSUPPORTED;
}

static int32_t nvm_erase(void *context, uint32_t slot)
{
    (void)context;
    (void)slot;
    return BRACE_HAL_E_UNSUPPORTED;
}

/* --- 7. CAN: all five, or null for all five --------------------------------------------------------------------- */

static int32_t can_setup(void *context, const brace_can_setup_t *setup)
{
    (void)context;
    (void)setup;
    return BRACE_HAL_E_UNSUPPORTED;
}

/* Frames of one identifier have to leave in the order they came in; with several mailboxes this needs care. */
static int32_t can_send(void *context, const brace_can_frame_t *frame)
{
    (void)context;
    (void)frame;
    return BRACE_HAL_E_UNSUPPORTED;
}

static int32_t can_receive(void *context, brace_can_frame_t *frame)
{
    (void)context;
    (void)frame;
    return 0;
}

static int32_t can_health(void *context, brace_can_health_t *health)
{
    (void)context;
    (void)health;
    return BRACE_HAL_E_UNSUPPORTED;
}

static int32_t can_recover(void *context)
{
    (void)context;
    return BRACE_HAL_E_UNSUPPORTED;
}

/* --- 8. optional: moving the limb, feeling its tip -------------------------------------------------------------- */

/* Null in the door when the firmware cannot move the limb. Then it still watches the backlash, but cannot take it
 * up. */
static int32_t joint_command(void *context, int32_t joint_index, const brace_hal_joint_command_t *command)
{
    (void)context;
    (void)joint_index;
    (void)command;
    return BRACE_HAL_E_UNSUPPORTED;
}

/* Null in the door when there is no sensor. Then forces come from the joints' torques. */
static int32_t tip_force_read(void *context, float *force_x_n, float *force_z_n)
{
    (void)context;
    (void)force_x_n;
    (void)force_z_n;
    return BRACE_HAL_E_UNSUPPORTED;
}

const brace_hal_t *brace_hal_blank(void)
{
    static const brace_hal_t hal = {
        .context = 0, /* a port's own state */
        .board = "blank",
        .now_us = now_us,
        .joint_read = joint_read,
        .joint_command = joint_command,
        .tip_force_read = tip_force_read,
        .nvm_shape = {.slot_bytes = 0u, .write_bytes = 0u}, /* a port: at least 4096, and 1, 2, 4 or 8 */
        .nvm_read = nvm_read,
        .nvm_write = nvm_write,
        .nvm_erase = nvm_erase,
        .can_setup = can_setup,
        .can_send = can_send,
        .can_receive = can_receive,
        .can_health = can_health,
        .can_recover = can_recover,
        .serial_setup = serial_setup,
        .serial_write = serial_write,
        .serial_read = serial_read,
        .watchdog_feed = watchdog_feed,
        .reset_cause = reset_cause,
        .crash_read = crash_read,
        .crash_clear = crash_clear,
        .stack_unused_bytes = stack_unused_bytes,
        .restart = restart,
    };
    return &hal;
}
