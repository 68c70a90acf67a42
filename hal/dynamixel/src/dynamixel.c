/* One request at a time is under way. A sync read asks all servos that are ready for current, velocity and position;
 * the goals leave in front of it, in the same piece. Every eighth request is for one servo alone: who it is, whether it
 * has its torque, how warm it is. dxl_servo.c takes what a servo answers. */
#include "brace_dynamixel.h"

#include <math.h>
#include <stddef.h>

#include "dxl_models.h"
#include "dxl_servo.h"

enum { NOTHING = 0, SAMPLES = 1, CARE = 2 }; /* what is pending */

enum {
    CARE_EVERY = 8,
    PLAIN_MISSES = 4,       /* sync reads that nobody answered: try the other kind */
    ASK_SILENT_US = 50000,
    REFRESH_US = 20000,     /* goals are sent again, because nobody answers a sync write */
    SERVE_BYTES = 64,
    SERVE_READS = 2
};

/* ------------------------------------------------------------------------------------------ answers -- */

static uint32_t bytes_of_step(uint8_t step)
{
    static const uint8_t bytes[] = {[DXL_STEP_IDENTIFY] = DXL_IDENTITY_BYTES,
                                    [DXL_STEP_READ_LIMITS] = DXL_LIMITS_BYTES,
                                    [DXL_STEP_READ_STATE] = DXL_STATE_BYTES,
                                    [DXL_STEP_READ_GOALS] = DXL_GOALS_BYTES,
                                    [DXL_STEP_READ_PLACE] = 4,
                                    [DXL_STEP_WRITE_PLACE] = 0,
                                    [DXL_STEP_WRITE_TORQUE] = 0,
                                    [DXL_STEP_READ_STATE_AGAIN] = DXL_STATE_BYTES,
                                    [DXL_STEP_READ_TEMPERATURE] = 1};
    return bytes[step];
}

static void answer_sample(brace_dynamixel_t *driver, uint32_t joint, uint8_t error, const uint8_t *data)
{
    driver->asked &= (uint8_t) ~(1u << joint);
    if (dxl_servo_note(&driver->servo[joint], error)) {
        dxl_servo_sample(&driver->servo[joint], data, driver->began_us);
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
    uint8_t data[1 + DXL_LIMITS_BYTES]; /* the longest */
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
    driver->asked &= (uint8_t) ~(1u << joint);
    const bool is_taken = dxl_servo_note(&driver->servo[joint], data[0]);
    if (!is_sample && is_taken) {
        dxl_servo_take(&driver->servo[joint], &driver->setup, (uint32_t)joint, &data[1]);
    } else if (!is_sample) {
        dxl_servo_refuse(&driver->servo[joint]);
    }
    return true;
}

static void take_packet(brace_dynamixel_t *driver, const dxl_packet_t *packet)
{
    if (packet->instruction != DXL_STATUS) {
        return; /* our own request, heard by a line that hears itself */
    }
    const bool is_ours =
        driver->asked != 0u &&
        (driver->pending == SAMPLES && !driver->is_plain ? take_fast(driver, packet) : take_single(driver, packet));
    dxl_count(is_ours ? &driver->counters.answers : &driver->counters.foreign);
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
            dxl_servo_lose_answer(&driver->servo[i], driver->now_us);
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

/* Goals leave when they change, and now and then, because nobody answers them. A servo that does not hear stands at
 * the goal that it has, so its offset stays, too. */
static void add_due_goals(brace_dynamixel_t *driver, uint32_t passed_us)
{
    bool position_is_due = false, current_is_due = false;
    const bool is_refresh = driver->now_us - driver->refreshed_us >= REFRESH_US;
    for (uint32_t i = 0; i < BRACE_SERVO_JOINTS; i++) {
        brace_servo_t *servo = &driver->servo[i];
        if (servo->report.state == BRACE_SERVO_READY && servo->has_goal) {
            dxl_servo_fade(servo, driver->now_us, passed_us);
            const bool has_current = servo->report.operating_mode == DXL_MODE_CURRENT_POSITION;
            const int32_t goal = dxl_servo_goal(servo, &driver->setup.joint[i]);
            const uint16_t current = dxl_servo_current(servo);
            position_is_due = position_is_due || is_refresh || goal != servo->goal_sent;
            current_is_due = current_is_due || (has_current && (is_refresh || current != servo->current_sent));
            servo->goal_sent = goal;
            servo->current_sent = current;
            servo->report.goal_rad = dxl_angle_rad(&driver->setup.joint[i], goal);
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
    const uint32_t passed_us = driver->now_us - driver->faded_us;
    driver->faded_us = driver->now_us;
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
    add_due_goals(driver, passed_us);
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
    case BRACE_SERVO_NONE: return false;
    case BRACE_SERVO_STARTING: return true;
    case BRACE_SERVO_READY:
        return driver->until_care == 0u || (servo->state_is_due && driver->until_care < CARE_EVERY / 2);
    default: return driver->now_us - servo->asked_us >= ASK_SILENT_US;
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
        servo->step = DXL_STEP_READ_STATE;
    } else if (servo->report.state != BRACE_SERVO_READY && servo->report.state != BRACE_SERVO_STARTING) {
        servo->step = DXL_STEP_IDENTIFY;
    } else if (servo->report.state == BRACE_SERVO_READY) {
        servo->step =
            servo->temperature_is_next && !servo->state_is_due ? DXL_STEP_READ_TEMPERATURE : DXL_STEP_READ_STATE_AGAIN;
    }
    switch (servo->step) {
    case DXL_STEP_IDENTIFY: return dxl_ask_read(out, id, DXL_AT_IDENTITY, DXL_IDENTITY_BYTES);
    case DXL_STEP_READ_LIMITS: return dxl_ask_read(out, id, DXL_AT_LIMITS, DXL_LIMITS_BYTES);
    case DXL_STEP_READ_STATE:
    case DXL_STEP_READ_STATE_AGAIN: return dxl_ask_read(out, id, DXL_AT_TORQUE, DXL_STATE_BYTES);
    case DXL_STEP_READ_GOALS: return dxl_ask_read(out, id, DXL_AT_GOAL_CURRENT, DXL_GOALS_BYTES);
    case DXL_STEP_READ_PLACE: return dxl_ask_read(out, id, DXL_AT_PRESENT_POSITION, 4);
    case DXL_STEP_WRITE_PLACE: return dxl_ask_write(out, id, DXL_AT_GOAL_POSITION, (uint32_t)servo->goal_sent, 4);
    case DXL_STEP_WRITE_TORQUE: return dxl_ask_write(out, id, DXL_AT_TORQUE, 1, 1);
    default: /* DXL_STEP_READ_TEMPERATURE */ return dxl_ask_read(out, id, DXL_AT_TEMPERATURE, 1);
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
            dxl_count(&driver->counters.line_busy);
            driver->pending = NOTHING;
            driver->asked = 0;
            driver->refreshed_us = now_us - REFRESH_US; /* goals that were in it have not left */
        } else {
            dxl_count(&driver->counters.requests);
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
        sound = sound && (!is_fitted || (joint->id <= DXL_ID_MOST && dxl_magnitude(joint->zero_rad) <= 100.0f &&
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
                                 .link_rad = dxl_angle_rad(&driver->setup.joint[joint_index], servo->sample.position),
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
    if (!(dxl_magnitude(command->offset_rad) <= 100.0f) || !(command->torque_limit_n_mm >= 0.0f)) {
        return BRACE_HAL_E_RANGE;
    }
    if (servo->report.state != BRACE_SERVO_READY || !servo->report.has_torque || !servo->has_goal) {
        return BRACE_HAL_E_DEVICE;
    }
    if (command->torque_limit_n_mm < INFINITY && servo->report.operating_mode != DXL_MODE_CURRENT_POSITION) {
        return BRACE_HAL_E_UNSUPPORTED;
    }
    if (!dxl_servo_accepts(servo, command->offset_rad)) {
        return BRACE_HAL_E_DEVICE;
    }
    servo->offset_rad = command->offset_rad;
    servo->limit_n_mm = command->torque_limit_n_mm;
    servo->commanded_us = driver->now_us;
    servo->is_commanded = true;
    servo->goes_back = false;
    return BRACE_HAL_OK;
}

int32_t brace_dynamixel_move(brace_dynamixel_t *driver, int32_t joint_index, float angle_rad)
{
    if (!has_joint(driver, joint_index)) {
        return BRACE_HAL_E_UNSUPPORTED;
    }
    brace_servo_t *servo = &driver->servo[joint_index];
    const brace_servo_joint_t *joint = &driver->setup.joint[joint_index];
    const float counts = dxl_magnitude(angle_rad - joint->zero_rad) * DXL_COUNTS_PER_RAD;
    if (!(counts < (float)(DXL_TURNS_MOST * DXL_COUNTS_PER_TURN))) {
        return BRACE_HAL_E_RANGE;
    }
    if (servo->report.state != BRACE_SERVO_READY || !servo->report.has_torque || !servo->has_goal) {
        return BRACE_HAL_E_DEVICE;
    }
    servo->base = DXL_MIDDLE + dxl_counts(joint, angle_rad - joint->zero_rad);
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
