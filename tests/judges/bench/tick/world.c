#include "world.h"

/* Silence ends a frame on the Modbus line: a request without a pause behind it would never be answered. So the master
 * that floods the line sends in every third tick: bytes, a silent tick, and the tick that answers. */
enum { SLOT_BYTES = 12288, LINE_REQUEST_TICKS = 3 };

/* Requests of a full bus at 1 Mbit/s in a millisecond, and what a ring holds after a late tick. */
enum { REQUESTS_PER_MS = 8, RING_FRAMES = 64, REQUEST_CODES = 36 };

uint32_t world_now_us;

static world_manner_t manner;
static brace_hal_joint_t sample[BRACE_LINK_COUNT];
static int32_t answer[BRACE_LINK_COUNT];
static brace_hal_joint_command_t command[BRACE_LINK_COUNT];
static float rest_rad[BRACE_LINK_COUNT], load_n_mm[BRACE_LINK_COUNT], force_n[2], force_rest_n[2];
static int32_t force_answer, command_answer, send_answer;
static uint32_t frames_waiting;
static uint8_t request[8];
static bool request_waits;
static uint32_t request_id;
static bool bus_off, fresh_bus_off;
typedef struct {
    uint32_t first, count;
    uint8_t byte[300];
} world_serial_t;

static world_serial_t line, tcp, text;
static uint32_t serial_room;
static uint8_t nvm[BRACE_NVM_SLOT_COUNT][SLOT_BYTES];

/* --------------------------------------------------------------------------------------------- the door -- */

static uint32_t door_now_us(void *context)
{
    (void)context;
    return world_now_us;
}

static int32_t door_joint_read(void *context, int32_t joint, brace_hal_joint_t *read)
{
    (void)context;
    if (answer[joint] == BRACE_HAL_OK || answer[joint] == BRACE_HAL_AGAIN) {
        read->motor_rad = sample[joint].motor_rad;
        read->torque_n_mm = sample[joint].torque_n_mm;
        read->link_rad = sample[joint].link_rad;
        read->temp_degc = sample[joint].temp_degc;
        read->taken_us = sample[joint].taken_us;
    }
    return answer[joint];
}

static int32_t door_joint_command(void *context, int32_t joint, const brace_hal_joint_command_t *wanted)
{
    (void)context;
    command[joint].offset_rad = wanted->offset_rad;
    command[joint].torque_limit_n_mm = wanted->torque_limit_n_mm;
    return command_answer;
}

static int32_t door_tip_force_read(void *context, float *x_n, float *z_n)
{
    (void)context;
    *x_n = force_n[0];
    *z_n = force_n[1];
    return force_answer;
}

static int32_t door_nvm_read(void *context, uint32_t slot, uint32_t offset, uint8_t *bytes, uint32_t count)
{
    (void)context;
    for (uint32_t i = 0; i < count; i++) {
        bytes[i] = nvm[slot][offset + i];
    }
    return BRACE_HAL_OK;
}

static int32_t door_nvm_write(void *context, uint32_t slot, uint32_t offset, const uint8_t *bytes, uint32_t count)
{
    (void)context;
    for (uint32_t i = 0; i < count; i++) {
        nvm[slot][offset + i] = bytes[i];
    }
    return BRACE_HAL_OK;
}

static int32_t door_nvm_erase(void *context, uint32_t slot)
{
    (void)context;
    for (uint32_t i = 0; i < SLOT_BYTES; i++) {
        nvm[slot][i] = 0xff;
    }
    return BRACE_HAL_OK;
}

static int32_t door_can_setup(void *context, const brace_can_setup_t *setup)
{
    (void)context;
    (void)setup;
    return BRACE_HAL_OK;
}

static int32_t door_can_send(void *context, const brace_can_frame_t *frame)
{
    (void)context;
    (void)frame;
    return bus_off ? BRACE_HAL_E_BUS_OFF : send_answer;
}

static int32_t door_can_receive(void *context, brace_can_frame_t *frame)
{
    (void)context;
    frame->length = 8;
    frame->fd = false;
    if (request_waits && (frames_waiting & 1u) == 0u) {
        request_waits = false;
        frame->id = request_id;
        for (int i = 0; i < 8; i++) {
            frame->data[i] = request[i];
        }
        return 1;
    }
    if (frames_waiting == 0u) {
        return 0;
    }
    static uint32_t noise = 1;
    frames_waiting--;
    frame->id = request_id; /* the controller's filter lets in no others */
    for (int i = 0; i < 8; i++) {
        noise = 1664525u * noise + 1013904223u;
        frame->data[i] = (uint8_t)(noise >> 24);
    }
    frame->data[0] = (uint8_t)(frame->data[0] % REQUEST_CODES);
    return 1;
}

static int32_t door_can_health(void *context, brace_can_health_t *health)
{
    (void)context;
    health->tx_errors = health->rx_errors = 0;
    health->error_passive = false;
    health->bus_off = bus_off;
    health->frames_lost = 0;
    return BRACE_HAL_OK;
}

static int32_t door_can_recover(void *context)
{
    (void)context;
    fresh_bus_off = false;
    return BRACE_HAL_OK;
}

static int32_t door_serial_setup(void *context, brace_serial_port_t port, uint32_t baud, brace_parity_t parity)
{
    (void)context;
    (void)baud;
    (void)parity;
    const bool modbus = port == BRACE_SERIAL_MODBUS || port == BRACE_SERIAL_MODBUS_TCP;
    return modbus || (port == BRACE_SERIAL_SLCAN && manner.slcan) ? BRACE_HAL_OK : BRACE_HAL_E_UNSUPPORTED;
}

static int32_t door_serial_write(void *context, brace_serial_port_t port, const uint8_t *bytes, uint32_t count)
{
    (void)context;
    (void)port;
    (void)bytes;
    return count < serial_room ? (int32_t)count : (int32_t)serial_room;
}

static int32_t door_serial_read(void *context, brace_serial_port_t port, uint8_t *bytes, uint32_t room)
{
    (void)context;
    world_serial_t *serial = port == BRACE_SERIAL_MODBUS ? &line : port == BRACE_SERIAL_SLCAN ? &text : &tcp;
    uint32_t count = 0;
    while (count < room && serial->first < serial->count) {
        bytes[count++] = serial->byte[serial->first++];
    }
    return (int32_t)count;
}

static void door_nothing(void *context)
{
    (void)context;
}

static brace_reset_cause_t door_reset_cause(void *context)
{
    (void)context;
    return BRACE_RESET_POWER;
}

static int32_t door_crash_read(void *context, brace_crash_record_t *record)
{
    (void)context;
    (void)record;
    return 0;
}

static uint32_t door_stack_unused_bytes(void *context)
{
    (void)context;
    return 0;
}

brace_hal_t world_door = {.board = "bench",
                          .now_us = door_now_us,
                          .joint_read = door_joint_read,
                          .joint_command = door_joint_command,
                          .tip_force_read = door_tip_force_read,
                          .nvm_shape = {SLOT_BYTES, 4},
                          .nvm_read = door_nvm_read,
                          .nvm_write = door_nvm_write,
                          .nvm_erase = door_nvm_erase,
                          .can_setup = door_can_setup,
                          .can_send = door_can_send,
                          .can_receive = door_can_receive,
                          .can_health = door_can_health,
                          .can_recover = door_can_recover,
                          .serial_setup = door_serial_setup,
                          .serial_write = door_serial_write,
                          .serial_read = door_serial_read,
                          .watchdog_feed = door_nothing,
                          .reset_cause = door_reset_cause,
                          .crash_read = door_crash_read,
                          .crash_clear = door_nothing,
                          .stack_unused_bytes = door_stack_unused_bytes,
                          .restart = door_nothing};

/* --------------------------------------------------------------------------------------------- the dice -- */

static uint32_t roll(dice_t *dice)
{
    dice->state ^= dice->state << 13;
    dice->state ^= dice->state >> 7;
    dice->state ^= dice->state << 17;
    return (uint32_t)(dice->state >> 32);
}

uint32_t dice_below(dice_t *dice, uint32_t n)
{
    return (uint32_t)(((uint64_t)roll(dice) * n) >> 32);
}

float dice_between(dice_t *dice, float low, float high)
{
    return low + (high - low) * (float)(roll(dice) >> 8) * (1.0f / 16777216.0f);
}

bool dice_in(dice_t *dice, uint32_t n)
{
    return n > 0u && dice_below(dice, n) == 0u;
}

/* --------------------------------------------------------------------------------------------- the limb -- */

/* What comes over the serial port at once: the line, and mostly all of it. */
static void asks_in_text(uint32_t node_id, const uint8_t data[8])
{
    static const char digit[] = "0123456789abcdef";
    const uint32_t id = 0x600u + node_id;
    text.first = text.count = 0;
    text.byte[text.count++] = 't';
    for (int i = 2; i >= 0; i--) {
        text.byte[text.count++] = (uint8_t)digit[id >> (4 * i) & 15u];
    }
    text.byte[text.count++] = '8';
    for (int i = 0; i < 8; i++) {
        text.byte[text.count++] = (uint8_t)digit[data[i] >> 4];
        text.byte[text.count++] = (uint8_t)digit[data[i] & 15u];
    }
    text.byte[text.count++] = '\r';
}

/* The channel is open, most of the time; and what else may come. */
static void random_text(dice_t *dice)
{
    static const char *const words[] = {"\rO\r", "O\r", "V\r", "C\rO\r",
                                        "t12",   "x\r", "F\r", "rubbish that is no line of any kind and too long\r"};
    const char *word = words[dice_below(dice, 8)];
    if (text.first < text.count || !dice_in(dice, 40)) {
        return;
    }
    for (text.first = text.count = 0; word[text.count] != '\0'; text.count++) {
        text.byte[text.count] = (uint8_t)word[text.count];
    }
}

void world_asks(uint32_t node_id, const uint8_t data[8])
{
    if (manner.slcan && text.first == text.count) {
        asks_in_text(node_id, data);
        return;
    }
    request_id = 0x600u + node_id;
    for (int i = 0; i < 8; i++) {
        request[i] = data[i];
    }
    request_waits = true;
}

void world_erase(void)
{
    for (uint32_t slot = 0; slot < BRACE_NVM_SLOT_COUNT; slot++) {
        (void)door_nvm_erase(NULL, slot);
    }
}

void world_begin(dice_t *dice, const world_manner_t *wanted)
{
    manner = *wanted;
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        rest_rad[i] = dice_between(dice, 0.2f, 1.6f);
        load_n_mm[i] = 0.0f;
        command[i] = (brace_hal_joint_command_t){0.0f, __builtin_inff()};
        answer[i] = i == BRACE_COXA && !manner.coxa ? BRACE_HAL_E_UNSUPPORTED : BRACE_HAL_OK;
    }
    force_rest_n[0] = dice_between(dice, -3.0f, 3.0f);
    force_rest_n[1] = dice_between(dice, 0.0f, 10.0f);
    bus_off = fresh_bus_off = request_waits = false;
    text = (world_serial_t){.count = manner.slcan ? 2 : 0, .byte = "O\r"};
}

/* A held link: what the motor is commanded beyond the gap winds its spring. */
static float wound(int joint, float off_rad)
{
    const float half = 0.5f * manner.gap_rad[joint];
    const float beyond = off_rad > half ? off_rad - half : off_rad < -half ? off_rad + half : 0.0f;
    return beyond * manner.spring_n_mm_per_rad;
}

static void spoil(dice_t *dice, int joint)
{
    static const float bad[] = {1e30f, -1e30f, 200.0f, 0.0f};
    const uint32_t kind = dice_below(dice, 8);
    if (kind < 4u) {
        sample[joint].motor_rad = bad[kind] != 0.0f ? bad[kind] : __builtin_nanf("");
    } else if (kind == 4u) {
        sample[joint].torque_n_mm = __builtin_nanf("");
    } else if (kind == 5u) {
        answer[joint] = BRACE_HAL_E_DEVICE;
    } else if (kind == 6u) {
        answer[joint] = BRACE_HAL_AGAIN;
    } else {
        sample[joint].motor_rad = dice_between(dice, -8.0f, 8.0f);
    }
}

/* A request of every function, mostly of registers that are there, behind `head` bytes. */
static uint32_t random_pdu(dice_t *dice, uint8_t *pdu)
{
    static const uint8_t functions[] = {3, 4, 4, 4, 6, 8, 16, 16, 17, 43, 99};
    static const uint16_t starts[] = {0,     0,     2,     100,   4096,  16384, 16386, 16390, 16392,
                                      16394, 16396, 16400, 16406, 16410, 16414, 16418, 16422, 16430};
    const uint32_t start = starts[dice_below(dice, 18)], function = functions[dice_below(dice, 11)];
    const uint32_t count = dice_in(dice, 2) ? 1u + dice_below(dice, 120)
                           : start == 16400 ? 6
                           : start == 16422 ? 8
                           : start == 16430 ? 10
                           : start >= 16396 ? 4
                                            : 2;
    const uint32_t tip = start == 16400 ? 0u : 8u; /* place of the tip's x; its knee stands behind z */
    const bool is_tip = start == 16400 || start == 16430;
    pdu[0] = (uint8_t)function;
    pdu[1] = (uint8_t)(start >> 8);
    pdu[2] = (uint8_t)start;
    pdu[3] = 0;
    pdu[4] = (uint8_t)count;
    pdu[5] = (uint8_t)(2u * count);
    for (uint32_t i = 0; i < 2u * count; i++) {
        const float angle = is_tip && i >= tip ? dice_between(dice, 100.0f, 300.0f) : dice_between(dice, 0.2f, 1.5f);
        pdu[6u + i] = is_tip && i >= tip + 8u ? (uint8_t)(i == tip + 11u) /* the knee */
                      : start >= 16396        ? ((const uint8_t *)&angle)[3u - i % 4u]
                                              : (uint8_t)dice_below(dice, 256);
    }
    if (start == 16384 && function == 16) {
        pdu[6] = 0xc0;
        pdu[7] = 0xde;
        pdu[8] = 0;
        pdu[9] = (uint8_t)(1u + dice_below(dice, 2));
    }
    return function == 16 ? 6u + 2u * count : function == 17 ? 1u : function == 43 ? 4u : 5u;
}

static void random_traffic(dice_t *dice)
{
    static uint8_t pdu[300];
    static uint32_t ticks_until_next; /* of the line's next request, while every port is flooded */
    serial_room = dice_in(dice, 4) ? dice_below(dice, 4) : 300u;
    ticks_until_next -= ticks_until_next > 0u;
    if (line.first == line.count && (manner.flooded ? ticks_until_next == 0u : dice_in(dice, 12))) {
        ticks_until_next = LINE_REQUEST_TICKS;
        const uint32_t length = random_pdu(dice, pdu);
        line.first = 0;
        line.count = length + 3u;
        line.byte[0] = 1;
        uint32_t crc = 0xffff ^ 1u;
        for (uint32_t i = 0; i <= length; i++) {
            for (int bit = 0; bit < 8; bit++) {
                crc = (crc & 1u) != 0u ? crc >> 1 ^ 0xa001u : crc >> 1;
            }
            if (i < length) {
                line.byte[1u + i] = pdu[i];
                crc ^= pdu[i];
            }
        }
        line.byte[1u + length] = (uint8_t)crc;
        line.byte[2u + length] = (uint8_t)(crc >> 8);
        if (dice_in(dice, 10)) {
            line.count -= dice_below(dice, line.count);
        }
    }
    if (tcp.first == tcp.count && (manner.flooded || dice_in(dice, 12))) {
        const uint32_t length = random_pdu(dice, tcp.byte + 7);
        tcp.first = 0;
        tcp.count = 7u + length;
        for (uint32_t i = 0; i < 6u; i++) {
            tcp.byte[i] = 0;
        }
        tcp.byte[4] = (uint8_t)((length + 1u) >> 8);
        tcp.byte[5] = (uint8_t)(length + 1u);
        tcp.byte[6] = 1;
    }
}

void world_step(dice_t *dice)
{
    random_traffic(dice);
    random_text(dice);
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        if (!manner.cooperative) {
            rest_rad[i] = manner.restless && dice_in(dice, 50) ? dice_between(dice, -3.2f, 3.2f)
                                                               : rest_rad[i] + dice_between(dice, -2e-3f, 2e-3f);
            load_n_mm[i] = dice_in(dice, 100) ? dice_between(dice, -9000.0f, 9000.0f)
                                              : 0.99f * load_n_mm[i] + dice_between(dice, -200.0f, 200.0f);
        }
        const float off_rad = command[i].offset_rad;
        sample[i].motor_rad = rest_rad[i] + off_rad;
        sample[i].torque_n_mm = load_n_mm[i] + wound(i, off_rad) + dice_between(dice, -30.0f, 30.0f);
        sample[i].link_rad = dice_in(dice, 2) ? __builtin_nanf("") : rest_rad[i];
        sample[i].temp_degc = dice_between(dice, 15.0f, 40.0f);
        sample[i].taken_us = world_now_us - dice_below(dice, 300);
        answer[i] = i == BRACE_COXA && !manner.coxa ? BRACE_HAL_E_UNSUPPORTED : BRACE_HAL_OK;
        if (answer[i] == BRACE_HAL_OK && dice_in(dice, manner.bad_in)) {
            spoil(dice, i);
        }
    }
    force_n[0] = force_rest_n[0] + 40.0f * command[1].offset_rad - 20.0f * command[2].offset_rad +
                 dice_between(dice, -0.05f, 0.05f);
    force_n[1] = force_rest_n[1] - 60.0f * command[1].offset_rad + 30.0f * command[2].offset_rad +
                 dice_between(dice, -0.05f, 0.05f);
    force_answer = !manner.cooperative && dice_in(dice, 100) ? BRACE_HAL_E_DEVICE : BRACE_HAL_OK;
    command_answer = manner.drives_fail && dice_in(dice, 20) ? BRACE_HAL_E_DEVICE : BRACE_HAL_OK;
    send_answer = dice_in(dice, 10) ? BRACE_HAL_AGAIN : BRACE_HAL_OK;
    frames_waiting = manner.flooded     ? (dice_in(dice, 2000) ? RING_FRAMES : REQUESTS_PER_MS)
                     : dice_in(dice, 4) ? dice_below(dice, 4)
                                        : 0u;
    fresh_bus_off = fresh_bus_off || dice_in(dice, 20000);
    bus_off = fresh_bus_off;
}
