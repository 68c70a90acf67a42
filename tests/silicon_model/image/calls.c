/* What the test calls in the image: the door's entries, by name. */
#include "brace_hal_stm32f405.h"

#define PINS_AND_SLOTS \
    .name = "register model", \
    .serial = {[BRACE_SERIAL_CONSOLE] = {1, {'A', 9}, {'A', 10}, {0, 0}}, \
               [BRACE_SERIAL_MODBUS] = {2, {'D', 5}, {'D', 6}, {'D', 4}}}, \
    .can_rx = {'B', 8}, .can_tx = {'B', 9}, .nvm_sector = {10, 11}, .watchdog = true, .guards_supply = true

const stm32f405_board_t board_8_mhz = {PINS_AND_SLOTS, .hse_hz = 8000000};
const stm32f405_board_t board_25_mhz = {PINS_AND_SLOTS, .hse_hz = 25000000};
const stm32f405_board_t board_without_crystal = {PINS_AND_SLOTS};
const stm32f405_board_t board_without_can = {.name = "no CAN", .hse_hz = 8000000, .nvm_sector = {1, 2}};

const stm32f405_board_t board_with_key = {PINS_AND_SLOTS, .hse_hz = 8000000, .keeps_key = true};

static const brace_hal_t *door;
uint32_t random_word;
stm32f405_clock_report_t clock_reported;
uint8_t buffer[1024];
brace_can_frame_t frame;
brace_can_health_t health;

void report_clock(void)
{
    clock_reported = stm32f405_clock_report();
}

void start(const stm32f405_board_t *board)
{
    door = brace_hal_stm32f405(board);
    clock_reported = stm32f405_clock_report();
}

uint32_t now(void)
{
    return door->now_us(door->context);
}

int32_t has_can(void)
{
    return door->can_setup != 0;
}

int32_t setup_can(uint32_t bit_rate, uint32_t fd_bit_rate, uint32_t listen_only, uint32_t loopback)
{
    const brace_can_setup_t setup = {
        .bit_rate = bit_rate, .fd_bit_rate = fd_bit_rate, .listen_only = listen_only != 0u, .loopback = loopback != 0u};
    return door->can_setup(door->context, &setup);
}

int32_t setup_can_for(uint32_t bit_rate, uint32_t filter_id, uint32_t filter_mask)
{
    const brace_can_setup_t setup = {.bit_rate = bit_rate, .filter_id = filter_id, .filter_mask = filter_mask};
    return door->can_setup(door->context, &setup);
}

int32_t setup_can_urgent(uint32_t filter_id, uint32_t filter_mask, uint32_t urgent_id)
{
    const brace_can_setup_t setup = {
        .bit_rate = 500000, .filter_id = filter_id, .filter_mask = filter_mask, .urgent_id = urgent_id};
    return door->can_setup(door->context, &setup);
}

int32_t send_frame(void)
{
    return door->can_send(door->context, &frame);
}

int32_t receive_frame(void)
{
    return door->can_receive(door->context, &frame);
}

int32_t read_health(void)
{
    return door->can_health(door->context, &health);
}

int32_t recover(void)
{
    return door->can_recover(door->context);
}

uint32_t slot_bytes(void)
{
    return door->nvm_shape.slot_bytes;
}

int32_t nvm_read(uint32_t slot, uint32_t offset, uint32_t count)
{
    return door->nvm_read(door->context, slot, offset, buffer, count);
}

int32_t nvm_write(uint32_t slot, uint32_t offset, uint32_t count)
{
    return door->nvm_write(door->context, slot, offset, buffer, count);
}

int32_t nvm_erase(uint32_t slot)
{
    return door->nvm_erase(door->context, slot);
}

int32_t is_guarded(void)
{
    return door->key_read != 0 && door->key_write != 0 && door->random_read != 0;
}

int32_t key_read(void)
{
    return door->key_read(door->context, buffer);
}

int32_t key_write(void)
{
    return door->key_write(door->context, buffer);
}

int32_t random_word_read(void)
{
    return door->random_read(door->context, &random_word);
}

void feed(void)
{
    door->watchdog_feed(door->context);
}

int32_t reset_cause(void)
{
    return (int32_t)door->reset_cause(door->context);
}

int32_t serial_setup_port(uint32_t port, uint32_t baud, uint32_t parity)
{
    return door->serial_setup(door->context, (brace_serial_port_t)port, baud, (brace_parity_t)parity);
}

int32_t serial_write_port(uint32_t port, uint32_t count)
{
    return door->serial_write(door->context, (brace_serial_port_t)port, buffer, count);
}

int32_t serial_read_port(uint32_t port, uint32_t room)
{
    return door->serial_read(door->context, (brace_serial_port_t)port, buffer, room);
}

int32_t restart(void)
{
    door->restart(door->context);
    return 0;
}

int32_t setup_servos(uint32_t baud)
{
    const stm32f405_servo_line_t wires = {{'C', 6}, {'C', 7}, {'C', 8}, baud, false};
    return stm32f405_servo_line(&wires);
}

int32_t send_to_servos(uint32_t count)
{
    return stm32f405_servo_send(0, buffer, count);
}

int32_t receive_from_servos(uint32_t room)
{
    return stm32f405_servo_receive(0, buffer, room);
}
