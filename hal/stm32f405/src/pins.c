#include "pins.h"

#include "stm32f405_registers.h"

enum { MODE_OUTPUT = 1, MODE_FUNCTION = 2, SPEED_FAST = 2, PULL_UP = 1 };

bool pin_is_connected(stm32f405_pin_t pin)
{
    return pin.port >= 'A' && pin.port <= 'I' && pin.number < 16u;
}

static uint32_t port_index(stm32f405_pin_t pin)
{
    return (uint32_t)(pin.port - 'A');
}

static uint32_t port_base(stm32f405_pin_t pin)
{
    return GPIOA_BASE + port_index(pin) * (GPIOB_BASE - GPIOA_BASE);
}

static void set_two_bits(stm32f405_pin_t pin, uint32_t offset, uint32_t value)
{
    const uint32_t shift = 2u * pin.number;
    REGISTER(port_base(pin), offset) = (REGISTER(port_base(pin), offset) & ~(3u << shift)) | (value << shift);
}

static void clock_port(stm32f405_pin_t pin)
{
    REGISTER(RCC_BASE, RCC_AHB1ENR) |= RCC_AHB1ENR_GPIOAEN << port_index(pin);
    (void)REGISTER(RCC_BASE, RCC_AHB1ENR);
}

void pin_give(stm32f405_pin_t pin, uint32_t function)
{
    if (!pin_is_connected(pin)) {
        return;
    }
    clock_port(pin);
    const uint32_t offset = pin.number < 8u ? GPIO_AFRL : GPIO_AFRH;
    const uint32_t shift = 4u * (pin.number % 8u);
    const uint32_t others = REGISTER(port_base(pin), offset) & ~(0xfu << shift);
    REGISTER(port_base(pin), offset) = others | (function << shift);
    set_two_bits(pin, GPIO_OSPEEDR, SPEED_FAST);
    set_two_bits(pin, GPIO_PUPDR, PULL_UP);
    set_two_bits(pin, GPIO_MODER, MODE_FUNCTION);
}

void pin_drive_low(stm32f405_pin_t pin)
{
    if (!pin_is_connected(pin)) {
        return;
    }
    clock_port(pin);
    const pin_switch_t output = pin_switch(pin);
    *output.place = output.low;
    set_two_bits(pin, GPIO_MODER, MODE_OUTPUT);
}

pin_switch_t pin_switch(stm32f405_pin_t pin)
{
    pin_switch_t output = {0, 0u, 0u};
    if (pin_is_connected(pin)) {
        output.place = &REGISTER(port_base(pin), GPIO_BSRR);
        output.high = 1u << pin.number;
        output.low = 1u << (pin.number + 16u);
    }
    return output;
}
