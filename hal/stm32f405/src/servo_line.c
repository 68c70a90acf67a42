/* The servos' line. DMA moves the bytes; one interrupt a packet, behind the last bit, turns the line round. */
#include "brace_hal_stm32f405.h"
#include "clock.h"
#include "interrupts.h"
#include "pins.h"
#include "processor.h"
#include "servo_line.h"
#include "stm32f405_registers.h"

enum { PIN_FUNCTION = 8, CHANNEL = 5, FROM_MEMORY = 1, RECEIVED_BYTES = 256, BAUD_MIN = 9600, BAUD_MAX = 4500000 };
enum { STOP_POLLS = 1000 };

#define SENT_FLAGS (DMA2_HIFCR_CFEIF6 | DMA2_HIFCR_CDMEIF6 | DMA2_HIFCR_CTEIF6 | DMA2_HIFCR_CHTIF6 | DMA2_HIFCR_CTCIF6)
#define RECEIVED_FLAGS \
    (DMA2_LIFCR_CFEIF1 | DMA2_LIFCR_CDMEIF1 | DMA2_LIFCR_CTEIF1 | DMA2_LIFCR_CHTIF1 | DMA2_LIFCR_CTCIF1)

static struct {
    uint8_t sent[STM32F405_SERVO_LINE_BYTES];
    volatile uint8_t received[RECEIVED_BYTES]; /* a ring that DMA writes */
    uint32_t taken;                            /* place of the next byte to be taken */
    pin_switch_t drive_enable;
    volatile bool is_sending;
    bool is_polled;
} line;

static void turn(uint32_t level)
{
    if (line.drive_enable.place != 0) {
        *line.drive_enable.place = level;
    }
}

static void stop(uint32_t control, uint32_t enabled)
{
    REGISTER(DMA2_BASE, control) = 0u;
    (void)poll_until(&REGISTER(DMA2_BASE, control), enabled, 0u, STOP_POLLS); /* it ends the byte under way */
}

static void start_receiving(void)
{
    stop(DMA2_S1CR, DMA2_S1CR_EN);
    REGISTER(DMA2_BASE, DMA2_LIFCR) = RECEIVED_FLAGS;
    REGISTER(DMA2_BASE, DMA2_S1PAR) = USART6_BASE + USART_DR;
    REGISTER(DMA2_BASE, DMA2_S1M0AR) = (uint32_t)(uintptr_t)line.received;
    REGISTER(DMA2_BASE, DMA2_S1NDTR) = RECEIVED_BYTES;
    REGISTER(DMA2_BASE, DMA2_S1CR) = FIELD(DMA2_S1CR_CHSEL, CHANNEL) | DMA2_S1CR_MINC | DMA2_S1CR_CIRC | DMA2_S1CR_EN;
}

int32_t stm32f405_servo_line(const stm32f405_servo_line_t *wires)
{
    const uint32_t clock_hz = clock_report()->clocks.apb2_hz;
    if (wires->baud < BAUD_MIN || wires->baud > BAUD_MAX) {
        return BRACE_HAL_E_RANGE;
    }
    const uint32_t divider = (clock_hz + wires->baud / 2u) / wires->baud;
    const uint32_t made = divider * wires->baud;
    const uint32_t off = made > clock_hz ? made - clock_hz : clock_hz - made;
    if (divider < 16u || off > clock_hz / 50u) {
        return BRACE_HAL_E_RANGE;
    }
    line.is_polled = wires->is_polled;
    line.is_sending = false;
    line.taken = 0;
    line.drive_enable = pin_switch(wires->drive_enable);
    pin_drive_low(wires->drive_enable);
    pin_give(wires->tx, PIN_FUNCTION);
    pin_give(wires->rx, PIN_FUNCTION);
    REGISTER(RCC_BASE, RCC_APB2ENR) |= RCC_APB2ENR_USART6EN;
    REGISTER(RCC_BASE, RCC_AHB1ENR) |= RCC_AHB1ENR_DMA2EN;
    (void)REGISTER(RCC_BASE, RCC_AHB1ENR);
    REGISTER(USART6_BASE, USART_CR1) = 0u;
    REGISTER(USART6_BASE, USART_CR2) = 0u; /* one stop bit */
    REGISTER(USART6_BASE, USART_BRR) = divider;
    REGISTER(USART6_BASE, USART_CR3) = wires->is_polled ? 0u : USART_CR3_DMAR | USART_CR3_DMAT;
    if (!wires->is_polled) {
        start_receiving();
        interrupt_enable(USART6_IRQ);
    }
    REGISTER(USART6_BASE, USART_CR1) = USART_CR1_UE | USART_CR1_TE | USART_CR1_RE;
    return BRACE_HAL_OK;
}

int32_t stm32f405_servo_send(void *context, const uint8_t *bytes, uint32_t count)
{
    (void)context;
    if (count == 0u || count > STM32F405_SERVO_LINE_BYTES) {
        return BRACE_HAL_E_RANGE;
    }
    if (line.is_sending) {
        return BRACE_HAL_AGAIN;
    }
    if (line.is_polled) {
        for (uint32_t i = 0; i < count; i++) {
            REGISTER(USART6_BASE, USART_DR) = bytes[i]; /* an emulator's transmitter is always free */
        }
        return BRACE_HAL_OK;
    }
    for (uint32_t i = 0; i < count; i++) {
        line.sent[i] = bytes[i];
    }
    line.is_sending = true;
    turn(line.drive_enable.high);
    stop(DMA2_S6CR, DMA2_S6CR_EN);
    REGISTER(DMA2_BASE, DMA2_HIFCR) = SENT_FLAGS;
    REGISTER(DMA2_BASE, DMA2_S6PAR) = USART6_BASE + USART_DR;
    REGISTER(DMA2_BASE, DMA2_S6M0AR) = (uint32_t)(uintptr_t)line.sent;
    REGISTER(DMA2_BASE, DMA2_S6NDTR) = count;
    REGISTER(USART6_BASE, USART_SR) = ~USART_SR_TC; /* of the packet before; the other flags ignore a 1 */
    processor_barrier();
    REGISTER(DMA2_BASE, DMA2_S6CR) =
        FIELD(DMA2_S6CR_CHSEL, CHANNEL) | FIELD(DMA2_S6CR_DIR, FROM_MEMORY) | DMA2_S6CR_MINC | DMA2_S6CR_EN;
    REGISTER(USART6_BASE, USART_CR1) |= USART_CR1_TCIE;
    return BRACE_HAL_OK;
}

void servo_line_finish(uint32_t at_most_us)
{
    if (line.is_sending) {
        (void)clock_poll_until(&REGISTER(USART6_BASE, USART_CR1), USART_CR1_TCIE, 0u, at_most_us);
    }
}

/* Behind the last bit, but not where DMA was late by a byte: then more bytes are to come. */
void usart6_handler(void)
{
    if ((REGISTER(USART6_BASE, USART_SR) & USART_SR_TC) == 0u) {
        return;
    }
    if (REGISTER(DMA2_BASE, DMA2_S6NDTR) != 0u) {
        REGISTER(USART6_BASE, USART_SR) = ~USART_SR_TC;
        return;
    }
    turn(line.drive_enable.low);
    REGISTER(USART6_BASE, USART_CR1) &= ~USART_CR1_TCIE;
    line.is_sending = false;
}

int32_t stm32f405_servo_receive(void *context, uint8_t *bytes, uint32_t room)
{
    (void)context;
    uint32_t done = 0;
    if (line.is_polled) {
        while (done < room && (REGISTER(USART6_BASE, USART_SR) & USART_SR_RXNE) != 0u) { /* at most room */
            bytes[done++] = (uint8_t)REGISTER(USART6_BASE, USART_DR);
        }
        return (int32_t)done;
    }
    if ((REGISTER(USART6_BASE, USART_SR) & USART_SR_ORE) != 0u) {
        (void)REGISTER(USART6_BASE, USART_DR); /* an overrun stops DMA until it is read; the CRC shows the loss */
    }
    const uint32_t written = RECEIVED_BYTES - REGISTER(DMA2_BASE, DMA2_S1NDTR);
    while (done < room && line.taken != written % RECEIVED_BYTES) { /* at most room */
        bytes[done++] = line.received[line.taken];
        line.taken = (line.taken + 1u) % RECEIVED_BYTES;
    }
    return (int32_t)done;
}
