#include "serial.h"

#include "byte_ring.h"
#include "clock.h"
#include "interrupts.h"
#include "pins.h"
#include "stm32f405_registers.h"

enum { USART_COUNT = 3, PIN_FUNCTION = 7 };
enum { BAUD_MIN = 1200, BAUD_MAX = 2000000, BRR_MIN = 16, BRR_MAX = 0xffff };

typedef struct {
    uint32_t base, irq;
    uint32_t clock_enable_offset, clock_enable;
} usart_place_t;

static const usart_place_t places[USART_COUNT] = {
    {USART1_BASE, USART1_IRQ, RCC_APB2ENR, RCC_APB2ENR_USART1EN},
    {USART2_BASE, USART2_IRQ, RCC_APB1ENR, RCC_APB1ENR_USART2EN},
    {USART3_BASE, USART3_IRQ, RCC_APB1ENR, RCC_APB1ENR_USART3EN},
};

typedef struct {
    byte_ring_t sent, received;
    pin_switch_t drive_enable;
    bool ready;
} usart_t;

static usart_t usarts[USART_COUNT];
static const stm32f405_board_t *wiring;

void serial_use(const stm32f405_board_t *board)
{
    wiring = board;
    for (uint32_t index = 0; index < USART_COUNT; index++) {
        usarts[index].ready = false;
    }
    for (uint32_t port = 0; port < BRACE_SERIAL_PORT_COUNT; port++) {
        pin_drive_low(board->serial[port].drive_enable); /* keeps the transmitter off the RS-485 line from the start */
    }
}

/* Index of a port's USART; -1: the board has no such port. */
static int32_t usart_of(brace_serial_port_t port)
{
    if ((uint32_t)port >= BRACE_SERIAL_PORT_COUNT) {
        return -1;
    }
    const uint8_t usart = wiring->serial[port].usart;
    return usart >= 1u && usart <= USART_COUNT ? (int32_t)usart - 1 : -1;
}

static uint32_t control_bits(brace_parity_t parity)
{
    const uint32_t plain = USART_CR1_UE | USART_CR1_TE | USART_CR1_RE | USART_CR1_RXNEIE;
    if (parity == BRACE_PARITY_NONE) {
        return plain;
    }
    /* The parity bit counts as a data bit: a word of 9. */
    return plain | USART_CR1_M | USART_CR1_PCE | (parity == BRACE_PARITY_ODD ? USART_CR1_PS : 0u);
}

int32_t serial_setup(void *context, brace_serial_port_t port, uint32_t baud, brace_parity_t parity)
{
    (void)context;
    const int32_t index = usart_of(port);
    if (index < 0) {
        return BRACE_HAL_E_UNSUPPORTED;
    }
    if (baud < BAUD_MIN || baud > BAUD_MAX || (uint32_t)parity > BRACE_PARITY_ODD) {
        return BRACE_HAL_E_RANGE;
    }
    const usart_place_t *place = &places[index];
    const stm32f405_clocks_t *clocks = &clock_report()->clocks;
    const uint32_t clock_hz = place->base == USART1_BASE ? clocks->apb2_hz : clocks->apb1_hz;
    const uint32_t divider = (clock_hz + baud / 2u) / baud; /* sixteenths of the manual's USARTDIV */
    const uint32_t made = divider * baud;
    const uint32_t off = made > clock_hz ? made - clock_hz : clock_hz - made;
    if (divider < BRR_MIN || divider > BRR_MAX || off > clock_hz / 50u) {
        return BRACE_HAL_E_RANGE;
    }

    usart_t *usart = &usarts[index];
    const stm32f405_serial_t *wires = &wiring->serial[port];
    REGISTER(RCC_BASE, place->clock_enable_offset) |= place->clock_enable;
    (void)REGISTER(RCC_BASE, place->clock_enable_offset);
    REGISTER(place->base, USART_CR1) = 0u; /* off, so no interrupt comes until the set-up ends */
    processor_barrier();
    usart->sent.taken = usart->sent.written;
    usart->received.taken = usart->received.written;
    usart->drive_enable = pin_switch(wires->drive_enable);
    pin_drive_low(wires->drive_enable);
    pin_give(wires->tx, PIN_FUNCTION);
    pin_give(wires->rx, PIN_FUNCTION);
    REGISTER(place->base, USART_CR2) = 0u; /* one stop bit */
    REGISTER(place->base, USART_CR3) = 0u;
    REGISTER(place->base, USART_BRR) = divider;
    REGISTER(place->base, USART_CR1) = control_bits(parity);
    usart->ready = true;
    interrupt_enable(place->irq);
    return BRACE_HAL_OK;
}

/* The port's USART if it is set up; else the reason why not. */
static int32_t ready_usart(brace_serial_port_t port)
{
    const int32_t index = usart_of(port);
    if (index < 0) {
        return BRACE_HAL_E_UNSUPPORTED;
    }
    return usarts[index].ready ? index : BRACE_HAL_E_DEVICE;
}

int32_t serial_write(void *context, brace_serial_port_t port, const uint8_t *bytes, uint32_t count)
{
    (void)context;
    const int32_t index = ready_usart(port);
    if (index < 0) {
        return index;
    }
    usart_t *usart = &usarts[index];
    uint32_t done = 0;
    while (done < count && byte_ring_put(&usart->sent, bytes[done])) { /* at most BYTE_RING_BYTES */
        done++;
    }
    if (done > 0u) {
        /* The handler may clear TXEIE or TCIE between this read and write; setting them again calls it once more. */
        REGISTER(places[index].base, USART_CR1) |= USART_CR1_TXEIE;
        interrupt_request(places[index].irq); /* for emulators without transmit interrupts */
    }
    return (int32_t)done;
}

int32_t serial_read(void *context, brace_serial_port_t port, uint8_t *bytes, uint32_t room)
{
    (void)context;
    const int32_t index = ready_usart(port);
    if (index < 0) {
        return index;
    }
    usart_t *usart = &usarts[index];
    uint32_t done = 0;
    while (done < room && byte_ring_take(&usart->received, &bytes[done])) { /* at most BYTE_RING_BYTES */
        done++;
    }
    return (int32_t)done;
}

void serial_finish(uint32_t at_most_us)
{
    const uint32_t start_us = clock_now_us();
    for (uint32_t index = 0; index < USART_COUNT; index++) {
        const uint32_t passed_us = clock_now_us() - start_us;
        if (usarts[index].ready && passed_us < at_most_us) {
            (void)clock_poll_until(&REGISTER(places[index].base, USART_CR1), USART_CR1_TXEIE | USART_CR1_TCIE, 0u,
                                   at_most_us - passed_us);
        }
    }
}

/* ------------------------------------------------------------------------------------------ interrupt -- */

static void receive(usart_t *usart, uint32_t base, uint32_t status)
{
    if ((status & (USART_SR_RXNE | USART_SR_ORE)) != 0u) {
        const uint8_t byte = (uint8_t)REGISTER(base, USART_DR); /* status, then data: clears the errors too */
        if ((status & USART_SR_RXNE) != 0u && (status & (USART_SR_PE | USART_SR_FE)) == 0u) {
            (void)byte_ring_put(&usart->received, byte); /* full: dropped; the frame's check fails */
        }
    }
}

static void set_switch(pin_switch_t output, uint32_t level)
{
    if (output.place != 0) {
        *output.place = level;
    }
}

/* Sends as many bytes as the transmitter takes: at most two on the chip, all of them on an emulator. */
static void send(usart_t *usart, uint32_t base)
{
    for (uint32_t i = 0; i < BYTE_RING_BYTES && (REGISTER(base, USART_SR) & USART_SR_TXE) != 0u; i++) {
        uint8_t byte;
        if (!byte_ring_take(&usart->sent, &byte)) {
            /* The last bit is still on its way. */
            REGISTER(base, USART_CR1) = (REGISTER(base, USART_CR1) & ~USART_CR1_TXEIE) | USART_CR1_TCIE;
            return;
        }
        set_switch(usart->drive_enable, usart->drive_enable.high);
        REGISTER(base, USART_DR) = byte;
    }
}

static void end_sending(usart_t *usart, uint32_t base)
{
    if ((REGISTER(base, USART_SR) & USART_SR_TC) != 0u) {
        set_switch(usart->drive_enable, usart->drive_enable.low);
        REGISTER(base, USART_CR1) &= ~USART_CR1_TCIE;
    }
}

static void serve(uint32_t index)
{
    usart_t *usart = &usarts[index];
    const uint32_t base = places[index].base;
    receive(usart, base, REGISTER(base, USART_SR));
    if ((REGISTER(base, USART_CR1) & USART_CR1_TXEIE) != 0u) {
        send(usart, base);
    } else if ((REGISTER(base, USART_CR1) & USART_CR1_TCIE) != 0u) {
        end_sending(usart, base);
    }
}

void usart1_handler(void)
{
    serve(0u);
}

void usart2_handler(void)
{
    serve(1u);
}

void usart3_handler(void)
{
    serve(2u);
}
