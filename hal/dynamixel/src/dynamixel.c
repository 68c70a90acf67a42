/* One request at a time is under way. A sync read asks all servos that are ready for current, velocity and position;
 * the goals leave in front of it, in the same piece. Every eighth request is for one servo alone: who it is, whether it
 * has its torque, how warm it is. */
#include "brace_dynamixel.h"

#include <math.h>
#include <stddef.h>

#include "dxl_models.h"

enum { NOTHING = 0, SAMPLES = 1, CARE = 2 }; /* what is pending */

/* What a servo is asked alone. A servo that has been silent goes through all steps up to READ_STATE_AGAIN. */
enum { IDENTIFY, READ_LIMIT, READ_STATE, READ_PLACE, WRITE_PLACE, WRITE_TORQUE, READ_STATE_AGAIN, READ_TEMPERATURE };

enum {
    CARE_EVERY = 8,
    SILENT_MISSES = 10,     /* in a row: the servo is silent */
    PLAIN_MISSES = 4,       /* sync reads that nobody answered: try the other kind */
    ASK_SILENT_US = 50000,
    REFRESH_US = 20000,     /* goals are sent again, because nobody answers a sync write */
    COMMAND_HOLDS_US = 100000,
    SERVE_BYTES = 64,
    SERVE_READS = 2
};

#define COUNTS_PER_TURN 4096
#define COUNTS_PER_RAD 651.898647f /* 4096 / 2 pi */
#define MIDDLE 2048
#define VELOCITY_RAD_PER_S 0.0239809f /* of a count: 0.229 turns a minute */
#define FADE_RAD_PER_US 0.1e-6f
#define TURNS_MOST 256

/* The CRC misses some bursts on the line. Each of them makes a sample impossible, or makes it jump by more than this. A
 * servo that really jumps is believed one sample later. */
#define POSITION_JUMP 100
#define CURRENT_JUMP 100
#define CURRENT_MOST 2047
#define VELOCITY_MOST 2047 /* twice what any of these servos reaches */

static void count_up(uint32_t *counter)
{
    *counter += *counter < UINT32_MAX ? 1u : 0u;
}

static float magnitude(float value)
{
    return value < 0.0f ? -value : value;
}

/* ------------------------------------------------------------------------------------------- units -- */

static float angle_of(const brace_servo_joint_t *joint, int32_t position)
{
    const float turned_rad = (float)(position - MIDDLE) / COUNTS_PER_RAD;
    return joint->zero_rad + (joint->is_reversed ? -turned_rad : turned_rad);
}

static int32_t rounded(float value)
{
    return (int32_t)(value < 0.0f ? value - 0.5f : value + 0.5f);
}

static int32_t counts_of(const brace_servo_joint_t *joint, float turned_rad)
{
    return rounded((joint->is_reversed ? -turned_rad : turned_rad) * COUNTS_PER_RAD);
}

static uint32_t value_of(const uint8_t *bytes, uint32_t count)
{
    uint32_t value = 0;
    for (uint32_t i = count; i > 0u; i--) { /* at most 4 */
        value = value << 8 | bytes[i - 1u];
    }
    return value;
}

static int32_t signed16(const uint8_t *bytes)
{
    return (int16_t)(uint16_t)value_of(bytes, 2);
}

static int32_t signed32(const uint8_t *bytes)
{
    return (int32_t)value_of(bytes, 4);
}

/* ------------------------------------------------------------------------------------------ samples -- */

static int32_t distance(int32_t a, int32_t b)
{
    const int64_t apart = (int64_t)a - b;
    return (int32_t)(apart < 0 ? (apart < -INT32_MAX ? INT32_MAX : -apart) : (apart > INT32_MAX ? INT32_MAX : apart));
}

static bool is_possible(const brace_servo_raw_t *raw)
{
    return distance(raw->current, 0) <= CURRENT_MOST && distance(raw->velocity, 0) <= VELOCITY_MOST &&
           distance(raw->position, 0) <= TURNS_MOST * COUNTS_PER_TURN;
}

static bool is_near(const brace_servo_raw_t *a, const brace_servo_raw_t *b)
{
    return distance(a->position, b->position) <= POSITION_JUMP && distance(a->current, b->current) <= CURRENT_JUMP;
}

static void take_sample(brace_servo_t *servo, const uint8_t *data, uint32_t taken_us)
{
    const brace_servo_raw_t raw = {signed16(data), signed32(&data[2]), signed32(&data[6]), taken_us};
    const bool is_believed = is_possible(&raw) && ((servo->has_sample && is_near(&servo->sample, &raw)) ||
                                                   (servo->has_wild && is_near(&servo->wild, &raw)));
    servo->wild = raw;
    servo->has_wild = !is_believed && is_possible(&raw);
    if (is_believed) {
        servo->sample = raw;
        servo->has_sample = servo->is_new = true;
        servo->report.velocity_rad_per_s = (float)raw.velocity * VELOCITY_RAD_PER_S;
        count_up(&servo->report.samples);
    } else {
        count_up(&servo->report.doubted);
    }
}

/* ------------------------------------------------------------------------------- a servo's own state -- */

static void begin_silence(brace_servo_t *servo, uint32_t now_us)
{
    servo->report.state = BRACE_SERVO_SILENT;
    servo->step = IDENTIFY;
    servo->asked_us = now_us;
    servo->has_sample = servo->has_wild = servo->is_new = false;
}

static void lose_answer(brace_servo_t *servo, uint32_t now_us)
{
    count_up(&servo->report.lost);
    servo->misses += servo->misses < SILENT_MISSES ? 1u : 0u;
    if (servo->misses >= SILENT_MISSES && servo->report.state != BRACE_SERVO_SILENT) {
        begin_silence(servo, now_us);
    }
}

static void take_identity(brace_servo_t *servo, const brace_servo_joint_t *joint, const uint8_t *data)
{
    enum { FIRMWARE = 6, DRIVE_MODE = 10, OPERATING_MODE = 11, REVERSED = 1, DEPENDS_ON_OTHER = 2 };
    servo->report.model = (uint16_t)value_of(data, 2);
    servo->report.firmware = data[FIRMWARE];
    servo->report.operating_mode = data[OPERATING_MODE];
    const dxl_model_t *model = dxl_model(servo->report.model);
    if (model == NULL) {
        servo->report.state = BRACE_SERVO_UNKNOWN;
    } else if (data[OPERATING_MODE] < DXL_MODE_POSITION || data[OPERATING_MODE] > DXL_MODE_CURRENT_POSITION ||
               (data[DRIVE_MODE] & (REVERSED | DEPENDS_ON_OTHER)) != 0u) {
        servo->report.state = BRACE_SERVO_MODE;
    } else {
        servo->report.state = BRACE_SERVO_STARTING;
        servo->torque_per_count_n_mm = 1e-3f * model->step_ma * model->n_mm_per_a * joint->torque_ratio *
                                       (joint->is_reversed ? -1.0f : 1.0f);
        servo->step = READ_LIMIT;
    }
}

/* Torque that is off although it was on: the servo has started anew, or has switched itself off. */
static void take_state(brace_servo_t *servo, bool holds, const uint8_t *data)
{
    enum { TORQUE = 0, HARDWARE_ERROR = 6 };
    const bool had_torque = servo->report.has_torque;
    servo->report.has_torque = data[TORQUE] != 0u;
    servo->report.hardware_error = data[HARDWARE_ERROR];
    servo->state_is_due = false;
    if (servo->report.hardware_error != 0u && !servo->report.has_torque) {
        servo->report.state = BRACE_SERVO_FAILED;
        servo->has_goal = false; /* it is told anew where to stand when it has started again */
        return;
    }
    if (had_torque && !servo->report.has_torque) {
        count_up(&servo->report.restarts);
        servo->has_goal = false;
    }
    const bool needs_place = !servo->has_goal && (servo->report.has_torque || holds);
    if (needs_place) {
        servo->report.state = BRACE_SERVO_STARTING;
        servo->step = READ_PLACE;
    } else {
        servo->report.state = BRACE_SERVO_READY;
        servo->step = READ_STATE_AGAIN;
    }
}

static void take_care_answer(brace_dynamixel_t *driver, const uint8_t *data)
{
    brace_servo_t *servo = &driver->servo[driver->cared];
    switch (servo->step) {
    case IDENTIFY:
        take_identity(servo, &driver->setup.joint[driver->cared], data);
        break;
    case READ_LIMIT:
        servo->current_limit = servo->current_sent = (uint16_t)value_of(data, 2);
        servo->step = READ_STATE;
        break;
    case READ_STATE:
    case READ_STATE_AGAIN:
        take_state(servo, driver->setup.holds, data);
        servo->temperature_is_next = true;
        break;
    case READ_PLACE:
        servo->base = servo->goal_sent = signed32(data);
        servo->has_goal = true;
        servo->offset_rad = 0.0f;
        servo->step = servo->report.has_torque ? READ_STATE : WRITE_PLACE;
        break;
    case WRITE_PLACE:
        servo->step = WRITE_TORQUE;
        break;
    case WRITE_TORQUE:
        servo->step = READ_STATE;
        servo->report.has_torque = true; /* READ_STATE judges it */
        break;
    default: /* READ_TEMPERATURE */
        servo->report.temp_degc = (float)data[0];
        servo->temperature_is_next = false;
        servo->step = READ_STATE_AGAIN;
        break;
    }
}

/* ------------------------------------------------------------------------------------------ answers -- */

static uint32_t bytes_of_step(uint8_t step)
{
    static const uint8_t bytes[] = {[IDENTIFY] = DXL_IDENTITY_BYTES, [READ_LIMIT] = 2, [READ_STATE] = DXL_STATE_BYTES,
                                    [READ_PLACE] = 4, [WRITE_PLACE] = 0, [WRITE_TORQUE] = 0,
                                    [READ_STATE_AGAIN] = DXL_STATE_BYTES, [READ_TEMPERATURE] = 1};
    return bytes[step];
}

/* What every answer says, whatever it answers. true: its data may be used. */
static bool note_answer(brace_servo_t *servo, uint8_t error)
{
    servo->misses = 0;
    servo->state_is_due = servo->state_is_due || (error & DXL_ERROR_ALERT) != 0u;
    if ((error & DXL_ERROR_NUMBER) != 0u) {
        count_up(&servo->report.refused);
    }
    return (error & DXL_ERROR_NUMBER) == 0u;
}

static void answer_sample(brace_dynamixel_t *driver, uint32_t joint, uint8_t error, const uint8_t *data)
{
    driver->asked &= (uint8_t)~(1u << joint);
    if (note_answer(&driver->servo[joint], error)) {
        take_sample(&driver->servo[joint], data, driver->began_us);
    }
}

static bool take_fast(brace_dynamixel_t *driver, const dxl_packet_t *packet)
{
    dxl_answer_t answer[BRACE_SERVO_JOINTS];
    for (uint32_t i = 0; i < driver->listed_count; i++) { /* at most BRACE_SERVO_JOINTS */
        if (!dxl_fast_answer(packet, driver->listed_count, DXL_PRESENT_BYTES, i, &answer[i]) ||
            answer[i].id != driver->setup.joint[driver->listed[i]].id) {
            return false;
        }
    }
    for (uint32_t i = 0; i < driver->listed_count; i++) { /* at most BRACE_SERVO_JOINTS */
        answer_sample(driver, driver->listed[i], answer[i].error, answer[i].data);
    }
    driver->fast_has_worked = true;
    return true;
}

/* The joint that a servo's own packet answers for; -1: none was asked. */
static int32_t joint_asked(const brace_dynamixel_t *driver, uint8_t id)
{
    for (int32_t i = 0; i < BRACE_SERVO_JOINTS; i++) {
        if ((driver->asked >> i & 1u) != 0u && driver->setup.joint[i].id == id) {
            return i;
        }
    }
    return -1;
}

static bool take_single(brace_dynamixel_t *driver, const dxl_packet_t *packet)
{
    uint8_t data[1 + DXL_IDENTITY_BYTES]; /* the longest */
    const int32_t joint = joint_asked(driver, packet->id);
    if (joint < 0) {
        return false;
    }
    const bool is_sample = driver->pending == SAMPLES;
    const uint32_t wanted = 1u + (is_sample ? DXL_PRESENT_BYTES : bytes_of_step(driver->servo[joint].step));
    const uint32_t count = dxl_unstuff(packet, data, sizeof data);
    const bool is_refusal = count == 1u && (data[0] & DXL_ERROR_NUMBER) != 0u;
    if (count != wanted && !is_refusal) {
        return false;
    }
    if (is_sample && !is_refusal) {
        answer_sample(driver, (uint32_t)joint, data[0], &data[1]);
        return true;
    }
    driver->asked &= (uint8_t)~(1u << joint);
    if (note_answer(&driver->servo[joint], data[0]) && !is_sample) {
        take_care_answer(driver, &data[1]);
    }
    return true;
}

static void take_packet(brace_dynamixel_t *driver, const dxl_packet_t *packet)
{
    if (packet->instruction != DXL_STATUS) {
        return; /* our own request, heard by a line that hears itself */
    }
    const bool is_ours = driver->asked != 0u && (driver->pending == SAMPLES && !driver->is_plain
                                                     ? take_fast(driver, packet)
                                                     : take_single(driver, packet));
    count_up(is_ours ? &driver->counters.answers : &driver->counters.foreign);
}

static void take_bytes(brace_dynamixel_t *driver)
{
    uint8_t bytes[SERVE_BYTES];
    dxl_packet_t packet;
    for (uint32_t i = 0; i < SERVE_READS; i++) {
        const int32_t count = driver->line.receive(driver->line.context, bytes, sizeof bytes);
        if (count <= 0) {
            break;
        }
        (void)dxl_receiver_take(&driver->receiver, bytes, (uint32_t)count);
        while (dxl_receiver_next(&driver->receiver, &packet)) { /* at most 16: each takes 10 bytes or more away */
            take_packet(driver, &packet);
        }
    }
    driver->counters.damaged = driver->receiver.damaged;
    driver->counters.skipped_bytes = driver->receiver.skipped;
}

/* ------------------------------------------------------------------------------------------- requests -- */

static void end_request(brace_dynamixel_t *driver)
{
    if (driver->pending == SAMPLES) {
        uint8_t all = 0;
        for (uint32_t i = 0; i < driver->listed_count; i++) { /* at most BRACE_SERVO_JOINTS */
            all |= (uint8_t)(1u << driver->listed[i]);
        }
        driver->silences = driver->asked == all ? driver->silences + 1u : 0u;
        driver->until_care += driver->asked != 0u && driver->until_care == 0u ? 1u : 0u; /* samples first */
        if (driver->silences >= PLAIN_MISSES) { /* one silent servo silences all behind it: who is it? */
            driver->is_plain = !driver->is_plain;
            driver->silences = 0;
            for (uint32_t i = 0; i < driver->listed_count; i++) { /* at most BRACE_SERVO_JOINTS */
                driver->servo[driver->listed[i]].state_is_due = true;
            }
        }
    }
    for (uint32_t i = 0; i < BRACE_SERVO_JOINTS; i++) {
        if ((driver->asked >> i & 1u) != 0u) {
            lose_answer(&driver->servo[i], driver->now_us);
            if (driver->servo[i].report.state == BRACE_SERVO_SILENT) {
                driver->is_plain = driver->is_plain && !driver->fast_has_worked;
            }
        }
    }
    driver->pending = NOTHING;
    driver->asked = 0;
}

/* Adds one register of every ready servo with torque to what is sent. */
static void add_goals(brace_dynamixel_t *driver, bool is_current)
{
    const uint32_t bytes = is_current ? 2u : 4u;
    dxl_begin(&driver->out, DXL_ID_ALL, DXL_SYNC_WRITE);
    dxl_add(&driver->out, is_current ? DXL_AT_GOAL_CURRENT : DXL_AT_GOAL_POSITION, 2);
    dxl_add(&driver->out, bytes, 2);
    for (uint32_t i = 0; i < BRACE_SERVO_JOINTS; i++) {
        const brace_servo_t *servo = &driver->servo[i];
        const bool has_current = servo->report.operating_mode == DXL_MODE_CURRENT_POSITION;
        if (servo->report.state == BRACE_SERVO_READY && servo->has_goal && (!is_current || has_current)) {
            dxl_add(&driver->out, driver->setup.joint[i].id, 1);
            dxl_add(&driver->out, is_current ? servo->current_sent : (uint32_t)servo->goal_sent, bytes);
        }
    }
    (void)dxl_end(&driver->out);
}

static void fade(brace_servo_t *servo, uint32_t now_us, uint32_t passed_us)
{
    if (servo->is_commanded && now_us - servo->commanded_us > COMMAND_HOLDS_US) {
        const float step_rad = FADE_RAD_PER_US * (float)passed_us;
        servo->limit_n_mm = INFINITY;
        servo->offset_rad = magnitude(servo->offset_rad) <= step_rad ? 0.0f
                            : servo->offset_rad > 0.0f               ? servo->offset_rad - step_rad
                                                                     : servo->offset_rad + step_rad;
        servo->is_commanded = servo->offset_rad != 0.0f;
    }
}

static uint16_t current_of(const brace_servo_t *servo)
{
    const float counts = servo->limit_n_mm / magnitude(servo->torque_per_count_n_mm);
    return counts < (float)servo->current_limit ? (uint16_t)counts : servo->current_limit;
}

static int32_t goal_of(const brace_servo_t *servo, const brace_servo_joint_t *joint)
{
    const int32_t goal = servo->base + counts_of(joint, servo->offset_rad);
    if (servo->report.operating_mode != DXL_MODE_POSITION) {
        return goal;
    }
    return goal < 0 ? 0 : goal > COUNTS_PER_TURN - 1 ? COUNTS_PER_TURN - 1 : goal;
}

/* Goals leave when they change, and now and then, because nobody answers them. */
static void add_due_goals(brace_dynamixel_t *driver)
{
    bool position_is_due = false, current_is_due = false;
    const uint32_t passed_us = driver->now_us - driver->faded_us;
    const bool is_refresh = driver->now_us - driver->refreshed_us >= REFRESH_US;
    driver->faded_us = driver->now_us;
    for (uint32_t i = 0; i < BRACE_SERVO_JOINTS; i++) {
        brace_servo_t *servo = &driver->servo[i];
        fade(servo, driver->now_us, passed_us);
        if (servo->report.state == BRACE_SERVO_READY && servo->has_goal) {
            const bool has_current = servo->report.operating_mode == DXL_MODE_CURRENT_POSITION;
            const int32_t goal = goal_of(servo, &driver->setup.joint[i]);
            const uint16_t current = current_of(servo);
            position_is_due = position_is_due || is_refresh || goal != servo->goal_sent;
            current_is_due = current_is_due || (has_current && (is_refresh || current != servo->current_sent));
            servo->goal_sent = goal;
            servo->current_sent = current;
            servo->report.goal_rad = angle_of(&driver->setup.joint[i], goal);
        }
    }
    if (current_is_due) {
        add_goals(driver, true);
    }
    if (position_is_due) {
        add_goals(driver, false);
    }
    driver->refreshed_us = is_refresh ? driver->now_us : driver->refreshed_us;
}

static bool ask_samples(brace_dynamixel_t *driver)
{
    driver->listed_count = 0;
    driver->asked = 0;
    for (uint32_t i = 0; i < BRACE_SERVO_JOINTS; i++) {
        if (driver->servo[i].report.state == BRACE_SERVO_READY || driver->servo[i].report.state == BRACE_SERVO_FAILED) {
            driver->listed[driver->listed_count++] = (uint8_t)i;
            driver->asked |= (uint8_t)(1u << i);
        }
    }
    if (driver->listed_count == 0u) {
        return false;
    }
    add_due_goals(driver);
    dxl_begin(&driver->out, DXL_ID_ALL, driver->is_plain ? DXL_SYNC_READ : DXL_FAST_SYNC_READ);
    dxl_add(&driver->out, DXL_AT_PRESENT, 2);
    dxl_add(&driver->out, DXL_PRESENT_BYTES, 2);
    for (uint32_t i = 0; i < driver->listed_count; i++) { /* at most BRACE_SERVO_JOINTS */
        dxl_add(&driver->out, driver->setup.joint[driver->listed[i]].id, 1);
    }
    driver->pending = SAMPLES;
    return dxl_end(&driver->out);
}

/* Is a servo to be asked alone now? A servo at work only when its turn has come. */
static bool needs_care(const brace_dynamixel_t *driver, uint32_t joint)
{
    const brace_servo_t *servo = &driver->servo[joint];
    switch (servo->report.state) {
    case BRACE_SERVO_NONE:
        return false;
    case BRACE_SERVO_STARTING:
        return true;
    case BRACE_SERVO_READY:
        return driver->until_care == 0u || (servo->state_is_due && driver->until_care < CARE_EVERY / 2);
    default:
        return driver->now_us - servo->asked_us >= ASK_SILENT_US;
    }
}

static bool ask_one(brace_dynamixel_t *driver, uint32_t joint)
{
    brace_servo_t *servo = &driver->servo[joint];
    const uint8_t id = driver->setup.joint[joint].id;
    dxl_out_t *out = &driver->out;
    servo->asked_us = driver->now_us;
    driver->cared = (uint8_t)joint;
    driver->asked = (uint8_t)(1u << joint);
    driver->pending = CARE;
    if (servo->report.state == BRACE_SERVO_FAILED) {
        servo->step = READ_STATE;
    } else if (servo->report.state != BRACE_SERVO_READY && servo->report.state != BRACE_SERVO_STARTING) {
        servo->step = IDENTIFY;
    } else if (servo->report.state == BRACE_SERVO_READY) {
        servo->step = servo->temperature_is_next && !servo->state_is_due ? READ_TEMPERATURE : READ_STATE_AGAIN;
    }
    switch (servo->step) {
    case IDENTIFY:
        return dxl_ask_read(out, id, DXL_AT_IDENTITY, DXL_IDENTITY_BYTES);
    case READ_LIMIT:
        return dxl_ask_read(out, id, DXL_AT_CURRENT_LIMIT, 2);
    case READ_STATE:
    case READ_STATE_AGAIN:
        return dxl_ask_read(out, id, DXL_AT_TORQUE, DXL_STATE_BYTES);
    case READ_PLACE: /* a servo that holds goes on holding where it was told to */
        return dxl_ask_read(out, id, servo->report.has_torque ? DXL_AT_GOAL_POSITION : DXL_AT_PRESENT_POSITION, 4);
    case WRITE_PLACE:
        return dxl_ask_write(out, id, DXL_AT_GOAL_POSITION, (uint32_t)servo->base, 4);
    case WRITE_TORQUE:
        return dxl_ask_write(out, id, DXL_AT_TORQUE, 1, 1);
    default: /* READ_TEMPERATURE */
        return dxl_ask_read(out, id, DXL_AT_TEMPERATURE, 1);
    }
}

static bool ask_next(brace_dynamixel_t *driver)
{
    driver->out.count = 0;
    driver->out.overflows = false;
    driver->until_care -= driver->until_care > 0u ? 1u : 0u;
    for (uint32_t i = 0; i < BRACE_SERVO_JOINTS; i++) {
        const uint32_t joint = (driver->next_cared + i) % BRACE_SERVO_JOINTS;
        /* Servos that are at work are sampled between two such requests, whatever the others need. */
        if (driver->until_care < CARE_EVERY - 1u && needs_care(driver, joint)) {
            driver->next_cared = (uint8_t)((joint + 1u) % BRACE_SERVO_JOINTS);
            driver->until_care = CARE_EVERY;
            return ask_one(driver, joint);
        }
    }
    return ask_samples(driver);
}

void brace_dynamixel_serve(brace_dynamixel_t *driver, uint32_t now_us)
{
    driver->now_us = now_us;
    take_bytes(driver);
    if (driver->pending != NOTHING && (driver->asked == 0u || now_us - driver->began_us >= driver->setup.timeout_us)) {
        end_request(driver);
    }
    if (driver->pending != NOTHING || (driver->has_begun && now_us - driver->began_us < driver->setup.period_us)) {
        return;
    }
    dxl_receiver_clear(&driver->receiver); /* what is left of an answer that was cut off */
    if (ask_next(driver)) {
        if (driver->line.send(driver->line.context, driver->out.bytes, driver->out.count) != BRACE_HAL_OK) {
            count_up(&driver->counters.line_busy);
            driver->pending = NOTHING;
            driver->asked = 0;
        } else {
            count_up(&driver->counters.requests);
        }
    }
    driver->began_us = now_us;
    driver->has_begun = true;
}

/* ------------------------------------------------------------------------------------------ the door -- */

static bool is_sound(const brace_servo_setup_t *setup)
{
    bool sound = setup->period_us >= 500u && setup->period_us <= 100000u && setup->timeout_us >= 300u &&
                 setup->timeout_us <= 100000u && setup->joint[1].id != BRACE_SERVO_NO_ID &&
                 setup->joint[2].id != BRACE_SERVO_NO_ID;
    for (uint32_t i = 0; i < BRACE_SERVO_JOINTS; i++) {
        const brace_servo_joint_t *joint = &setup->joint[i];
        const bool is_fitted = joint->id != BRACE_SERVO_NO_ID;
        sound = sound && (!is_fitted || (joint->id <= DXL_ID_MOST && magnitude(joint->zero_rad) <= 100.0f &&
                                         joint->torque_ratio > 0.0f && joint->torque_ratio <= 10.0f));
        for (uint32_t other = 0; other < i; other++) {
            sound = sound && !(is_fitted && setup->joint[other].id == joint->id);
        }
    }
    return sound;
}

int32_t brace_dynamixel_start(brace_dynamixel_t *driver, const brace_servo_setup_t *setup,
                              const brace_servo_line_t *line)
{
    if (!is_sound(setup)) {
        return BRACE_HAL_E_RANGE;
    }
    *driver = (brace_dynamixel_t){.setup = *setup, .line = *line};
    dxl_receiver_start(&driver->receiver);
    for (uint32_t i = 0; i < BRACE_SERVO_JOINTS; i++) {
        brace_servo_t *servo = &driver->servo[i];
        const bool is_fitted = setup->joint[i].id != BRACE_SERVO_NO_ID;
        servo->report.state = is_fitted ? BRACE_SERVO_STARTING : BRACE_SERVO_NONE;
        servo->report.temp_degc = servo->report.goal_rad = servo->report.velocity_rad_per_s = NAN;
        servo->limit_n_mm = INFINITY;
    }
    return BRACE_HAL_OK;
}

static bool has_joint(const brace_dynamixel_t *driver, int32_t joint_index)
{
    return joint_index >= 0 && joint_index < BRACE_SERVO_JOINTS &&
           driver->servo[joint_index].report.state != BRACE_SERVO_NONE;
}

int32_t brace_dynamixel_read(brace_dynamixel_t *driver, int32_t joint_index, brace_hal_joint_t *joint)
{
    if (!has_joint(driver, joint_index)) {
        return BRACE_HAL_E_UNSUPPORTED;
    }
    brace_servo_t *servo = &driver->servo[joint_index];
    if (servo->report.state != BRACE_SERVO_READY && servo->report.state != BRACE_SERVO_STARTING &&
        servo->report.state != BRACE_SERVO_FAILED) {
        return BRACE_HAL_E_DEVICE;
    }
    if (!servo->has_sample) {
        return BRACE_HAL_AGAIN;
    }
    *joint = (brace_hal_joint_t){.motor_rad = NAN,
                                 .torque_n_mm = (float)servo->sample.current * servo->torque_per_count_n_mm,
                                 .link_rad = angle_of(&driver->setup.joint[joint_index], servo->sample.position),
                                 .temp_degc = servo->report.temp_degc,
                                 .taken_us = servo->sample.taken_us};
    const bool is_new = servo->is_new;
    servo->is_new = false;
    return is_new ? BRACE_HAL_OK : BRACE_HAL_AGAIN;
}

int32_t brace_dynamixel_command(brace_dynamixel_t *driver, int32_t joint_index,
                                const brace_hal_joint_command_t *command)
{
    if (!has_joint(driver, joint_index)) {
        return BRACE_HAL_E_UNSUPPORTED;
    }
    brace_servo_t *servo = &driver->servo[joint_index];
    if (!(magnitude(command->offset_rad) <= 100.0f) || !(command->torque_limit_n_mm >= 0.0f)) {
        return BRACE_HAL_E_RANGE;
    }
    if (servo->report.state != BRACE_SERVO_READY || !servo->report.has_torque || !servo->has_goal) {
        return BRACE_HAL_E_DEVICE;
    }
    if (command->torque_limit_n_mm < INFINITY && servo->report.operating_mode != DXL_MODE_CURRENT_POSITION) {
        return BRACE_HAL_E_UNSUPPORTED;
    }
    servo->offset_rad = command->offset_rad;
    servo->limit_n_mm = command->torque_limit_n_mm;
    servo->commanded_us = driver->now_us;
    servo->is_commanded = true;
    return BRACE_HAL_OK;
}

int32_t brace_dynamixel_move(brace_dynamixel_t *driver, int32_t joint_index, float angle_rad)
{
    if (!has_joint(driver, joint_index)) {
        return BRACE_HAL_E_UNSUPPORTED;
    }
    brace_servo_t *servo = &driver->servo[joint_index];
    const brace_servo_joint_t *joint = &driver->setup.joint[joint_index];
    if (!(magnitude(angle_rad - joint->zero_rad) * COUNTS_PER_RAD < (float)(TURNS_MOST * COUNTS_PER_TURN))) {
        return BRACE_HAL_E_RANGE;
    }
    if (servo->report.state != BRACE_SERVO_READY || !servo->report.has_torque || !servo->has_goal) {
        return BRACE_HAL_E_DEVICE;
    }
    servo->base = MIDDLE + counts_of(joint, angle_rad - joint->zero_rad);
    return BRACE_HAL_OK;
}

void brace_dynamixel_report(const brace_dynamixel_t *driver, int32_t joint_index, brace_servo_report_t *report)
{
    if (joint_index >= 0 && joint_index < BRACE_SERVO_JOINTS) {
        *report = driver->servo[joint_index].report;
    }
}

void brace_dynamixel_counters(const brace_dynamixel_t *driver, brace_servo_counters_t *counters)
{
    *counters = driver->counters;
}
