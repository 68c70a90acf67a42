/* Does a joint's sensor still measure? One that is frozen reports the same again and again, with a new time stamp. What
 * the limb does meanwhile parts it from a joint that rests:
 *
 *   commanded  the drive is commanded to move and has torque left, and neither angle nor torque moves by a bit
 *   loaded     the tip's sensor and the weight say that the joint's load has changed by more than friction can hide,
 *              and neither angle nor torque moves by a bit
 *   unheld     the angle stands, and the torque swings further than load and friction can hold: the motor must have
 *              turned
 *   swings     the angle stands, and the torque swings by a quarter of its range and by more than friction can hide:
 *              any position servo gives way by more than an encoder's step then
 *   left       the angle stands, and the link's own encoder moves further than backlash and spring let it
 *
 * A joint is frozen when one of the first three has lasted for a quarter of a second, so a drive may take its time to
 * answer, or one of the last two is seen of an angle that has stood for so long. "loaded" and "unheld" need a sensor at
 * the tip. An angle stands while it stays within half an encoder's step. Fault: ENCODER_STUCK.
 *
 * The torque alone cannot say whether it lied or the encoder stood. So the claim stays as long as the angle stands,
 * even when the torque is as it was. It ends when the joint moves, or when somebody who has looked at it clears it. */
#ifndef BRACE_WATCH_FROZEN_H
#define BRACE_WATCH_FROZEN_H

#include <stdbool.h>
#include <stdint.h>

#include "brace/parameters.h"
#include "brace/vec.h"
#include "posture/posture.h"
#include "sense/joints.h"
#include "sense/tip_force.h"

typedef struct {
    float low, high;
} frozen_span_t;

typedef struct {
    bool is_frozen;
    bool is_settled; /* the torque's mean is one of several samples */
    float motor_rad, torque_n_mm; /* of the sample of the look before, */
    uint32_t taken_us; /* and its time */
    float stood_at_rad; /* where the angle began to stand */
    uint32_t stood_us; /* how long; counts to a quarter of a second */
    uint32_t proven_us; /* how long one of the first three proofs has lasted */
    frozen_span_t commanded_offset_rad; /* offsets that were commanded since both stand and the drive has torque left */
    frozen_span_t same_load_n_mm; /* what the joint carries by sensor and weight, since both stand */
    frozen_span_t load_n_mm; /* the same, since the angle stands; NaN: it was not known for a while */
    frozen_span_t pulls_n_mm; /* the motor's torque since then, less single wild samples */
    frozen_span_t link_rad; /* the link's own encoder since then; NaN: there is none */
} frozen_joint_t;

typedef struct {
    frozen_joint_t joint[BRACE_LINK_COUNT];
    uint8_t turn; /* the joint that the next tick looks at */
} frozen_t;

typedef struct {
    const joints_t *joints;
    const posture_t *posture;
    const tip_force_t *force;
    const brace_parameters_t *parameters;
    brace_vec3_t down;
    const float *commanded_offset_rad; /* of each joint: what is added to its set-point, */
    const float *limit_n_mm; /* and the torque within which it may follow */
} frozen_inputs_t;

/* Looks at one joint's sample of this tick, each joint in its turn: a tick is spared two of three joints, and a dear
 * tick all of them. A proof lasts as long as the samples' times say, so that it is late by two looks at most. At most
 * 310 instructions. */
void frozen_watch(frozen_t *frozen, const frozen_inputs_t *inputs);

/* Forgets all evidence against every joint. Only what a joint does after this call counts. */
void frozen_start(frozen_t *frozen);

/* Is any joint's sensor frozen? */
bool frozen_any(const frozen_t *frozen);

#endif
