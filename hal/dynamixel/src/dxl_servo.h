/* One servo: what its answers say, and what it is commanded. The driver (dynamixel.c) carries both over the line. */
#ifndef DXL_SERVO_H
#define DXL_SERVO_H

#include <stdbool.h>
#include <stdint.h>

#include "brace_dynamixel.h"

#define DXL_COUNTS_PER_TURN 4096
#define DXL_COUNTS_PER_RAD 651.898647f /* 4096 / 2 pi */
#define DXL_MIDDLE 2048
#define DXL_TURNS_MOST 256
#define DXL_NEAR_RAD 0.02f /* as far as an offset goes back in 0.2 s */

/* What a servo is asked alone (brace_servo_t.step). A servo that has been silent goes through all steps up to
 * READ_STATE_AGAIN. */
enum {
    DXL_STEP_IDENTIFY = 0,
    DXL_STEP_READ_LIMITS,
    DXL_STEP_READ_STATE,
    DXL_STEP_READ_GOALS,
    DXL_STEP_READ_PLACE,
    DXL_STEP_WRITE_PLACE,
    DXL_STEP_WRITE_TORQUE,
    DXL_STEP_READ_STATE_AGAIN,
    DXL_STEP_READ_TEMPERATURE
};

static inline void dxl_count(uint32_t *counter)
{
    *counter += *counter < UINT32_MAX ? 1u : 0u;
}

static inline float dxl_magnitude(float value)
{
    return value < 0.0f ? -value : value;
}

/* The joint's angle at a position of the servo [counts], and how many counts it turns by for an angle. */
float dxl_angle_rad(const brace_servo_joint_t *joint, int32_t position);
int32_t dxl_counts(const brace_servo_joint_t *joint, float turned_rad);

/* Takes current, velocity and position as they come over the line: DXL_PRESENT_BYTES. */
void dxl_servo_sample(brace_servo_t *servo, const uint8_t *data, uint32_t taken_us);

/* What every answer says, whatever it answers. returns whether its data may be used */
bool dxl_servo_note(brace_servo_t *servo, uint8_t error);

/* Takes the answer to the servo's present step, and goes on to the next one.
 *   data: as many bytes as the step's answer has */
void dxl_servo_take(brace_servo_t *servo, const brace_servo_setup_t *setup, uint32_t joint, const uint8_t *data);

/* The servo has refused its present step. Ten times in a row: it cannot be set up as it is. */
void dxl_servo_refuse(brace_servo_t *servo);

/* An answer did not come. After ten in a row the servo counts as silent. */
void dxl_servo_lose_answer(brace_servo_t *servo, uint32_t now_us);

/* An offset that nobody has commanded for 100 ms goes back to nothing, at 0.1 rad/s. */
void dxl_servo_fade(brace_servo_t *servo, uint32_t now_us, uint32_t passed_us);

/* May an offset be commanded now? Not one that would move the servo at once, away from an offset on its way back. */
static inline bool dxl_servo_accepts(const brace_servo_t *servo, float offset_rad)
{
    return !servo->goes_back || dxl_magnitude(offset_rad - servo->offset_rad) <= DXL_NEAR_RAD;
}

/* What the servo is to be sent: its current's limit and its position [counts]. */
uint16_t dxl_servo_current(const brace_servo_t *servo);
int32_t dxl_servo_goal(const brace_servo_t *servo, const brace_servo_joint_t *joint);

#endif
