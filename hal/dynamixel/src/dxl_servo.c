#include "dxl_servo.h"

#include <math.h>
#include <stddef.h>

#include "dxl_models.h"

enum {
    SILENT_MISSES = 10, /* in a row: the servo is silent */
    REFUSALS_MOST = 10, /* in a row */
    COMMAND_HOLDS_US = 100000
};

#define VELOCITY_RAD_PER_S 0.0239809f /* of a count: 0.229 turns a minute */
#define FADE_RAD_PER_US 0.1e-6f
#define RETURN_DELAY_US 2u /* of a count */

/* The CRC misses some bursts on the line. Each of them makes a sample impossible, or makes it jump by more than this. A
 * servo that really jumps is believed one sample later. */
#define POSITION_JUMP 100
#define CURRENT_JUMP 100
#define CURRENT_MOST 2047
#define VELOCITY_MOST 2047 /* twice what any of these servos reaches */

/* ------------------------------------------------------------------------------------------- units -- */

float dxl_angle_rad(const brace_servo_joint_t *joint, int32_t position)
{
    const float turned_rad = (float)(position - DXL_MIDDLE) / DXL_COUNTS_PER_RAD;
    return joint->zero_rad + (joint->is_reversed ? -turned_rad : turned_rad);
}

static int32_t rounded(float value)
{
    return (int32_t)(value < 0.0f ? value - 0.5f : value + 0.5f);
}

int32_t dxl_counts(const brace_servo_joint_t *joint, float turned_rad)
{
    return rounded((joint->is_reversed ? -turned_rad : turned_rad) * DXL_COUNTS_PER_RAD);
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
           distance(raw->position, 0) <= DXL_TURNS_MOST * DXL_COUNTS_PER_TURN;
}

static bool is_near(const brace_servo_raw_t *a, const brace_servo_raw_t *b)
{
    return distance(a->position, b->position) <= POSITION_JUMP && distance(a->current, b->current) <= CURRENT_JUMP;
}

void dxl_servo_sample(brace_servo_t *servo, const uint8_t *data, uint32_t taken_us)
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
        dxl_count(&servo->report.samples);
    } else {
        dxl_count(&servo->report.doubted);
    }
}

/* ------------------------------------------------------------------------------- a servo's own state -- */

static void begin_silence(brace_servo_t *servo, uint32_t now_us)
{
    servo->report.state = BRACE_SERVO_SILENT;
    servo->step = DXL_STEP_IDENTIFY;
    servo->asked_us = now_us;
    servo->has_sample = servo->has_wild = servo->is_new = false;
}

void dxl_servo_lose_answer(brace_servo_t *servo, uint32_t now_us)
{
    dxl_count(&servo->report.lost);
    servo->misses += servo->misses < SILENT_MISSES ? 1u : 0u;
    if (servo->misses >= SILENT_MISSES && servo->report.state != BRACE_SERVO_SILENT) {
        begin_silence(servo, now_us);
    }
}

/* Torque follows from the model, and the mode says which goals may be sent. The CRC misses some bursts: who a servo is,
 * is believed when two answers say the same. */
static void take_identity(brace_servo_t *servo, const brace_servo_setup_t *setup, const brace_servo_joint_t *joint,
                          const uint8_t *data)
{
    enum { FIRMWARE = 6, RETURN_DELAY = 9, DRIVE_MODE = 10, OPERATING_MODE = 11, REVERSED = 1, DEPENDS_ON_OTHER = 2 };
    const uint16_t number = (uint16_t)value_of(data, 2);
    const bool is_confirmed = servo->report.model == number && servo->report.operating_mode == data[OPERATING_MODE] &&
                              servo->drive_mode == data[DRIVE_MODE] && servo->return_delay == data[RETURN_DELAY];
    servo->report.model = number;
    servo->report.firmware = data[FIRMWARE];
    servo->report.operating_mode = data[OPERATING_MODE];
    servo->drive_mode = data[DRIVE_MODE];
    servo->return_delay = data[RETURN_DELAY];
    servo->refusals = 0;
    const dxl_model_t *model = dxl_model(number);
    if (!is_confirmed) {
        servo->report.state = BRACE_SERVO_STARTING;
        servo->step = DXL_STEP_IDENTIFY;
    } else if (model == NULL) {
        servo->report.state = BRACE_SERVO_UNKNOWN;
    } else if (data[OPERATING_MODE] < DXL_MODE_POSITION || data[OPERATING_MODE] > DXL_MODE_CURRENT_POSITION ||
               (data[DRIVE_MODE] & (REVERSED | DEPENDS_ON_OTHER)) != 0u ||
               4u * RETURN_DELAY_US * data[RETURN_DELAY] > setup->timeout_us) {
        servo->report.state = BRACE_SERVO_MODE;
    } else {
        servo->report.state = BRACE_SERVO_STARTING;
        servo->torque_per_count_n_mm =
            1e-3f * model->step_ma * model->n_mm_per_a * joint->torque_ratio * (joint->is_reversed ? -1.0f : 1.0f);
        servo->step = DXL_STEP_READ_LIMITS;
        servo->has_limits = false;
    }
}

/* As the model, the limits are believed when two answers say the same. */
static void take_limits(brace_servo_t *servo, const uint8_t *data)
{
    enum { CURRENT = 0, MOST_POSITION = 10, LEAST_POSITION = 14 };
    const uint16_t current = (uint16_t)value_of(&data[CURRENT], 2);
    const int32_t most = signed32(&data[MOST_POSITION]), least = signed32(&data[LEAST_POSITION]);
    const bool is_believed = servo->has_limits && servo->current_limit == current && servo->place_most == most &&
                             servo->place_least == least;
    servo->step = is_believed ? DXL_STEP_READ_STATE : DXL_STEP_READ_LIMITS;
    servo->current_limit = servo->current_sent = current;
    servo->place_most = most;
    servo->place_least = least;
    servo->has_limits = true;
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
        servo->has_goal = false; /* after a restart the servo gets a new goal */
        return;
    }
    if (had_torque && !servo->report.has_torque) {
        dxl_count(&servo->report.restarts);
        servo->has_goal = false;
    }
    const bool needs_place = !servo->has_goal && (servo->report.has_torque || holds);
    if (needs_place) {
        servo->report.state = BRACE_SERVO_STARTING;
        servo->step = servo->report.has_torque ? DXL_STEP_READ_GOALS : DXL_STEP_READ_PLACE;
        servo->has_place = false;
    } else {
        servo->report.state = BRACE_SERVO_READY;
        servo->step = DXL_STEP_READ_STATE_AGAIN;
    }
}

/* Where the servo has to stand from now on. What is commanded beside it stays: a servo which has started anew stands
 * where it is, and the next command, which is the one before, does not move it. */
static void stand_at(brace_servo_t *servo, const brace_servo_joint_t *joint, int32_t place, uint8_t next_step)
{
    servo->base = place - dxl_counts(joint, servo->offset_rad);
    servo->goes_back = servo->offset_rad != 0.0f;
    servo->has_goal = true;
    servo->step = next_step;
}

/* The goals of a servo that holds: it holds on where it was commanded to. As a sample that jumps, they are believed
 * when the next answer agrees. An earlier controller may have bounded its current. A servo that has yielded at such a
 * bound stands far from its goal, and without the bound it would snap to the goal. So the servo gets its present place
 * as its goal. */
static void take_goals(brace_servo_t *servo, const brace_servo_joint_t *joint, const uint8_t *data)
{
    enum { CURRENT = 0, POSITION = 14 };
    const uint16_t current = (uint16_t)value_of(&data[CURRENT], 2);
    const int32_t goal = signed32(&data[POSITION]);
    const bool is_believed =
        servo->has_place && servo->current_sent == current && distance(goal, servo->goal_sent) <= POSITION_JUMP;
    const bool is_bound = servo->report.operating_mode == DXL_MODE_CURRENT_POSITION && current < servo->current_limit;
    servo->current_sent = current;
    servo->goal_sent = goal;
    servo->has_place = true;
    if (is_believed && is_bound) {
        servo->step = DXL_STEP_READ_PLACE;
        servo->has_place = false;
    } else if (is_believed) {
        stand_at(servo, joint, goal, DXL_STEP_READ_STATE);
    }
}

/* Where the servo stands, believed as its goals are. */
static void take_place(brace_servo_t *servo, const brace_servo_joint_t *joint, int32_t place)
{
    const bool is_believed = servo->has_place && distance(place, servo->goal_sent) <= POSITION_JUMP;
    const bool takes_it = servo->report.operating_mode != DXL_MODE_POSITION ||
                          (place >= servo->place_least && place <= servo->place_most);
    servo->goal_sent = place;
    servo->has_place = true;
    if (is_believed && !takes_it) {
        servo->report.state = BRACE_SERVO_MODE; /* it takes no goal where it stands, and the nearest would move it */
    } else if (is_believed) {
        stand_at(servo, joint, place, DXL_STEP_WRITE_PLACE);
    }
}

void dxl_servo_take(brace_servo_t *servo, const brace_servo_setup_t *setup, uint32_t index, const uint8_t *data)
{
    const brace_servo_joint_t *joint = &setup->joint[index];
    servo->refusals = 0;
    switch (servo->step) {
    case DXL_STEP_IDENTIFY: take_identity(servo, setup, joint, data); break;
    case DXL_STEP_READ_LIMITS: take_limits(servo, data); break;
    case DXL_STEP_READ_STATE:
    case DXL_STEP_READ_STATE_AGAIN:
        take_state(servo, setup->holds, data);
        servo->temperature_is_next = true;
        break;
    case DXL_STEP_READ_GOALS: take_goals(servo, joint, data); break;
    case DXL_STEP_READ_PLACE: take_place(servo, joint, signed32(data)); break;
    case DXL_STEP_WRITE_PLACE: servo->step = DXL_STEP_WRITE_TORQUE; break;
    case DXL_STEP_WRITE_TORQUE:
        servo->step = DXL_STEP_READ_STATE;
        servo->report.has_torque = true; /* DXL_STEP_READ_STATE judges it */
        break;
    default: /* DXL_STEP_READ_TEMPERATURE */
        servo->report.temp_degc = (float)data[0];
        servo->temperature_is_next = false;
        servo->step = DXL_STEP_READ_STATE_AGAIN;
        break;
    }
}

void dxl_servo_refuse(brace_servo_t *servo)
{
    if (servo->report.state == BRACE_SERVO_STARTING) {
        servo->refusals++;
        servo->report.state = servo->refusals >= REFUSALS_MOST ? BRACE_SERVO_MODE : BRACE_SERVO_STARTING;
    }
}

/* What every answer says, whatever it answers. true: its data may be used. An alert that is known already, of an error
 * that leaves the torque on, is no reason to ask for the state before its turn: it comes with every answer. */
bool dxl_servo_note(brace_servo_t *servo, uint8_t error)
{
    const bool is_news = (error & DXL_ERROR_ALERT) != 0u && servo->report.hardware_error == 0u;
    servo->misses = 0;
    servo->state_is_due = servo->state_is_due || is_news;
    if ((error & DXL_ERROR_NUMBER) != 0u) {
        dxl_count(&servo->report.refused);
    }
    return (error & DXL_ERROR_NUMBER) == 0u;
}

/* ------------------------------------------------------------------------------------------ goals -- */

void dxl_servo_fade(brace_servo_t *servo, uint32_t now_us, uint32_t passed_us)
{
    if (servo->is_commanded && now_us - servo->commanded_us > COMMAND_HOLDS_US) {
        const float step_rad = FADE_RAD_PER_US * (float)passed_us;
        servo->limit_n_mm = INFINITY;
        servo->offset_rad = dxl_magnitude(servo->offset_rad) <= step_rad ? 0.0f
                            : servo->offset_rad > 0.0f                   ? servo->offset_rad - step_rad
                                                                         : servo->offset_rad + step_rad;
        servo->is_commanded = servo->goes_back = servo->offset_rad != 0.0f;
    }
}

uint16_t dxl_servo_current(const brace_servo_t *servo)
{
    const float counts = servo->limit_n_mm / dxl_magnitude(servo->torque_per_count_n_mm);
    return counts < (float)servo->current_limit ? (uint16_t)counts : servo->current_limit;
}

int32_t dxl_servo_goal(const brace_servo_t *servo, const brace_servo_joint_t *joint)
{
    const int32_t goal = servo->base + dxl_counts(joint, servo->offset_rad);
    if (servo->report.operating_mode != DXL_MODE_POSITION) {
        return goal;
    }
    return goal < servo->place_least ? servo->place_least : goal > servo->place_most ? servo->place_most : goal;
}
