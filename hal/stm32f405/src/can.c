#include "can.h"

#include "can_timing.h"
#include "clock.h"
#include "interrupts.h"
#include "pins.h"
#include "processor.h"
#include "stm32f405_registers.h"

enum {
    PIN_FUNCTION = 9,
    ACKNOWLEDGE_US = 900, /* for entering initialisation after a reset, which waits for no bus */
    RELEASE_POLLS = 16,
    FIFO_FRAMES = 3,
    RING_FRAMES = 64, /* a power of two; 7 ms of a full bus at 1 Mbit/s */
    MAILBOXES = 3,
    STALE_US = 100000 /* a frame that nobody has taken by then describes a moment that is long over */
};

static const uint32_t mailbox_is_empty[MAILBOXES] = {CAN_TSR_TME0, CAN_TSR_TME1, CAN_TSR_TME2};
static const uint32_t mailbox_abort[MAILBOXES] = {CAN_TSR_ABRQ0, CAN_TSR_ABRQ1, CAN_TSR_ABRQ2};
static uint32_t asked_us[MAILBOXES]; /* when the frame in it was to be sent */

/* A frame as the registers hold it. */
typedef struct {
    uint32_t id_and_length; /* length above 16 bits of identifier */
    uint32_t data_low, data_high;
} stored_frame_t;

static stored_frame_t ring[RING_FRAMES];
static volatile uint32_t ring_written, ring_taken; /* counts since start */
static volatile uint32_t frames_lost;

static const stm32f405_board_t *wiring;
static bool running, listening_only;
static volatile bool silent; /* it disturbs no bus, whatever its clock */
static volatile bool stopped; /* the crystal was lost since it was set up */
static bool recovering; /* initialisation was requested, and ends as soon as it is acknowledged */

void can_use(const stm32f405_board_t *board)
{
    wiring = board;
    running = false;
}

static volatile uint32_t *can(uint32_t offset)
{
    return &REGISTER(CAN1_BASE, offset);
}

/* Accepts standard data frames with these bits of their identifier, and only these, into FIFO 0; and urgent ones into
 * FIFO 1. Where both filters fit, the one that lists an identifier wins over the one with a mask. */
static void open_filters(const brace_can_setup_t *setup)
{
    *can(CAN_FMR) |= CAN_FMR_FINIT;
    *can(CAN_FA1R) = 0u;
    *can(CAN_FM1R) = (*can(CAN_FM1R) & ~CAN_FM1R_FBM0) | CAN_FM1R_FBM1; /* 0: mask, 1: list */
    *can(CAN_FS1R) |= CAN_FS1R_FSC0 | CAN_FS1R_FSC1;                    /* of 32 bits */
    *can(CAN_FFA1R) = (*can(CAN_FFA1R) & ~CAN_FFA1R_FFA0) | CAN_FFA1R_FFA1;
    /* Filters have the bits of a receive identifier register. IDE and RTR must be 0. */
    *can(CAN_F0R1) = FIELD(CAN_RI0R_STID, setup->filter_id & setup->filter_mask);
    *can(CAN_F0R2) = FIELD(CAN_RI0R_STID, setup->filter_mask) | CAN_RI0R_IDE | CAN_RI0R_RTR;
    *can(CAN_F1R1) = FIELD(CAN_RI0R_STID, setup->urgent_id);
    *can(CAN_F1R2) = FIELD(CAN_RI0R_STID, setup->urgent_id);
    *can(CAN_FA1R) = setup->urgent_id != 0u ? CAN_FA1R_FACT0 | CAN_FA1R_FACT1 : CAN_FA1R_FACT0;
    *can(CAN_FMR) &= ~CAN_FMR_FINIT;
}

/* Loopback is the manual's silent one: the line stays recessive, and frames on it are not received. */
static uint32_t mode_bits(const brace_can_setup_t *setup)
{
    return setup->loopback ? CAN_BTR_LBKM | CAN_BTR_SILM : setup->listen_only ? CAN_BTR_SILM : 0u;
}

static uint32_t timing_bits(const can_timing_t *timing)
{
    return FIELD(CAN_BTR_BRP, timing->prescaler - 1u) | FIELD(CAN_BTR_TS1, timing->before - 1u) |
           FIELD(CAN_BTR_TS2, timing->after - 1u) | FIELD(CAN_BTR_SJW, timing->jump - 1u);
}

static void restart_controller(void)
{
    REGISTER(RCC_BASE, RCC_APB1ENR) |= RCC_APB1ENR_CAN1EN;
    REGISTER(RCC_BASE, RCC_APB1RSTR) |= RCC_APB1RSTR_CAN1RST;
    REGISTER(RCC_BASE, RCC_APB1RSTR) &= ~RCC_APB1RSTR_CAN1RST;
    (void)REGISTER(RCC_BASE, RCC_APB1RSTR);
    processor_barrier();
}

void can_leave_bus(void)
{
    if (!silent) {
        stopped = true;
        restart_controller(); /* it sleeps, and its line is recessive */
    }
}

/* Changes the mode, which wakes the controller. The crystal may have been lost since the mode was read or chosen: then
 * it sleeps again. */
static void set_mode(uint32_t mode)
{
    *can(CAN_MCR) = mode;
    if (stopped) {
        restart_controller();
    }
}

int32_t can_setup(void *context, const brace_can_setup_t *setup)
{
    (void)context;
    can_timing_t timing;
    if (setup->fd_bit_rate != 0u || !pin_is_connected(wiring->can_rx) || !pin_is_connected(wiring->can_tx)) {
        return BRACE_HAL_E_UNSUPPORTED;
    }
    if (!can_timing_find(clock_report()->clocks.apb1_hz, setup->bit_rate, &timing)) {
        return BRACE_HAL_E_RANGE;
    }
    if (!clock_report()->crystal && !setup->listen_only && !setup->loopback) { /* an inexact clock disturbs the bus */
        return BRACE_HAL_E_DEVICE;
    }
    running = false;
    recovering = false;
    silent = setup->listen_only || setup->loopback;
    stopped = false;
    restart_controller(); /* now it sleeps: no interrupt, empty mailboxes and FIFO */
    ring_taken = ring_written;
    frames_lost = 0u;
    pin_give(wiring->can_rx, PIN_FUNCTION);
    pin_give(wiring->can_tx, PIN_FUNCTION);

    /* It sends in the order of requests; a full FIFO keeps its frames. It retransmits, and stays in bus-off until
     * commanded. */
    const uint32_t manner = CAN_MCR_TXFP | CAN_MCR_RFLM;
    *can(CAN_MCR) = manner | CAN_MCR_INRQ;
    if (!clock_poll_until(can(CAN_MSR), CAN_MSR_INAK | CAN_MSR_SLAK, CAN_MSR_INAK, ACKNOWLEDGE_US)) {
        return BRACE_HAL_E_DEVICE;
    }
    *can(CAN_BTR) = timing_bits(&timing) | mode_bits(setup);
    open_filters(setup);
    *can(CAN_IER) = CAN_IER_FMPIE0 | CAN_IER_FOVIE0;
    listening_only = setup->listen_only && !setup->loopback;
    running = true;
    interrupt_enable(CAN1_RX0_IRQ);
    if (!clock_report()->crystal && !silent) { /* lost since it was looked at */
        can_leave_bus();
        return BRACE_HAL_E_DEVICE;
    }
    set_mode(manner); /* it leaves initialisation by itself after 11 recessive bits */
    return stopped ? BRACE_HAL_E_DEVICE : BRACE_HAL_OK;
}

/* Second half of can_recover, once the controller has acknowledged: leaving initialisation starts the 128 x 11
 * bits. */
static void finish_recovery(void)
{
    if (recovering && (*can(CAN_MSR) & CAN_MSR_INAK) != 0u) {
        set_mode(*can(CAN_MCR) & ~CAN_MCR_INRQ);
        recovering = false;
    }
}

static bool is_bus_off(void)
{
    return stopped || recovering || (*can(CAN_ESR) & CAN_ESR_BOFF) != 0u;
}

/* It has not seen 11 recessive bits since it was set up. */
static bool waits_for_the_bus(void)
{
    return (*can(CAN_MSR) & CAN_MSR_INAK) != 0u;
}

int32_t can_recover(void *context)
{
    (void)context;
    if (!running) {
        return BRACE_HAL_E_UNSUPPORTED;
    }
    if (stopped) {
        return BRACE_HAL_E_DEVICE;
    }
    if (!recovering && (*can(CAN_ESR) & CAN_ESR_BOFF) != 0u) {
        *can(CAN_TSR) = CAN_TSR_ABRQ0 | CAN_TSR_ABRQ1 | CAN_TSR_ABRQ2;
        set_mode(*can(CAN_MCR) | CAN_MCR_INRQ);
        recovering = true;
    }
    finish_recovery();
    return BRACE_HAL_OK;
}

static uint32_t word(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

int32_t can_send(void *context, const brace_can_frame_t *frame)
{
    (void)context;
    if (!running || listening_only || frame->fd) {
        return BRACE_HAL_E_UNSUPPORTED;
    }
    if (frame->id > 0x7ffu || frame->length > 8u) {
        return BRACE_HAL_E_RANGE;
    }
    finish_recovery();
    if (is_bus_off()) {
        return BRACE_HAL_E_BUS_OFF;
    }
    if (waits_for_the_bus()) {
        return BRACE_HAL_AGAIN;
    }
    const uint32_t status = *can(CAN_TSR);
    for (uint32_t mailbox = 0; mailbox < MAILBOXES; mailbox++) {
        if ((status & mailbox_is_empty[mailbox]) != 0u) {
            const uint32_t at = mailbox * (CAN_TI1R - CAN_TI0R);
            *can(CAN_TDT0R + at) = FIELD(CAN_TDT0R_DLC, frame->length);
            *can(CAN_TDL0R + at) = word(&frame->data[0]);
            *can(CAN_TDH0R + at) = word(&frame->data[4]);
            *can(CAN_TI0R + at) = FIELD(CAN_TI0R_STID, frame->id) | CAN_TI0R_TXRQ;
            asked_us[mailbox] = clock_now_us();
            return BRACE_HAL_OK;
        }
    }
    return BRACE_HAL_AGAIN;
}

/* The frame that a FIFO holds. at: of FIFO 1 behind the registers of FIFO 0 */
static stored_frame_t frame_of_fifo(uint32_t at)
{
    const uint32_t dlc = *can(CAN_RDT0R + at) & CAN_RDT0R_DLC; /* a sender may write up to 15 for 8 bytes */
    const uint32_t length = dlc < 8u ? dlc : 8u;
    return (stored_frame_t){.id_and_length =
                                (*can(CAN_RI0R + at) & CAN_RI0R_STID) / FIELD(CAN_RI0R_STID, 1u) | length << 16,
                            .data_low = *can(CAN_RDL0R + at),
                            .data_high = *can(CAN_RDH0R + at)};
}

static void give_frame(const stored_frame_t *stored, brace_can_frame_t *frame)
{
    frame->id = stored->id_and_length & 0xffffu;
    frame->length = (uint8_t)(stored->id_and_length >> 16);
    frame->fd = false;
    for (uint32_t i = 0; i < frame->length; i++) {
        const uint32_t half = i < 4u ? stored->data_low : stored->data_high;
        frame->data[i] = (uint8_t)(half >> (8u * (i % 4u)));
    }
}

/* Urgent frames wait in FIFO 1, which nothing else fills: it holds three, and drops what is more. */
static bool take_urgent(brace_can_frame_t *frame)
{
    if ((*can(CAN_RF1R) & CAN_RF1R_FMP1) == 0u) {
        return false;
    }
    const stored_frame_t stored = frame_of_fifo(CAN_RI1R - CAN_RI0R);
    *can(CAN_RF1R) = CAN_RF1R_RFOM1;
    (void)poll_until(can(CAN_RF1R), CAN_RF1R_RFOM1, 0u, RELEASE_POLLS); /* the count is old until then */
    give_frame(&stored, frame);
    return true;
}

int32_t can_receive(void *context, brace_can_frame_t *frame)
{
    (void)context;
    if (!running) {
        return BRACE_HAL_E_UNSUPPORTED;
    }
    finish_recovery();
    if (take_urgent(frame)) {
        return 1;
    }
    const uint32_t taken = ring_taken;
    if (ring_written == taken) {
        return 0;
    }
    compiler_barrier();
    give_frame(&ring[taken % RING_FRAMES], frame);
    compiler_barrier();
    ring_taken = taken + 1u;
    return 1;
}

/* Alone on the bus, the controller sends the same frame again and again, for hours, until somebody takes it. */
static void drop_stale_frames(void)
{
    const uint32_t status = *can(CAN_TSR), now_us = clock_now_us();
    for (uint32_t mailbox = 0; mailbox < MAILBOXES; mailbox++) {
        if ((status & mailbox_is_empty[mailbox]) == 0u && now_us - asked_us[mailbox] > STALE_US) {
            *can(CAN_TSR) = mailbox_abort[mailbox];
        }
    }
}

int32_t can_health(void *context, brace_can_health_t *health)
{
    (void)context;
    if (!running) {
        return BRACE_HAL_E_UNSUPPORTED;
    }
    finish_recovery();
    drop_stale_frames();
    const uint32_t errors = *can(CAN_ESR);
    health->tx_errors = (uint8_t)((errors & CAN_ESR_TEC) / FIELD(CAN_ESR_TEC, 1u));
    health->rx_errors = (uint8_t)((errors & CAN_ESR_REC) / FIELD(CAN_ESR_REC, 1u));
    health->error_passive = (errors & CAN_ESR_EPVF) != 0u;
    health->bus_off = is_bus_off() || waits_for_the_bus();
    health->frames_lost = frames_lost;
    return BRACE_HAL_OK;
}

/* ------------------------------------------------------------------------------------------ interrupt -- */

static void count_lost(void)
{
    if (frames_lost != UINT32_MAX) {
        frames_lost = frames_lost + 1u;
    }
}

static void store_frame(void)
{
    const uint32_t written = ring_written;
    if (written - ring_taken >= (uint32_t)RING_FRAMES) {
        count_lost();
        return;
    }
    ring[written % RING_FRAMES] = frame_of_fifo(0);
    compiler_barrier();
    ring_written = written + 1u;
}

void can1_rx0_handler(void)
{
    if ((*can(CAN_RF0R) & CAN_RF0R_FOVR0) != 0u) {
        *can(CAN_RF0R) = CAN_RF0R_FOVR0; /* at least one frame; the controller does not count them */
        count_lost();
    }
    for (uint32_t frame = 0; frame < FIFO_FRAMES && (*can(CAN_RF0R) & CAN_RF0R_FMP0) != 0u; frame++) {
        store_frame();
        *can(CAN_RF0R) = CAN_RF0R_RFOM0;
        /* The count is old until the controller has taken the release. */
        if (!poll_until(can(CAN_RF0R), CAN_RF0R_RFOM0, 0u, RELEASE_POLLS)) {
            break;
        }
    }
}
