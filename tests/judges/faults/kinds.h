/* Kinds of faults of sensors, and one fault of a kind by lot. */
#ifndef FAULTS_KINDS_H
#define FAULTS_KINDS_H

#include "plant.h"

typedef enum {
    /* These break a bound of physics: no drive, no motor and no sensor does what they say. */
    KIND_ANGLE_JUMP,
    KIND_ANGLE_CONSTANT,
    KIND_ANGLE_TURN,
    KIND_ANGLE_BIT,
    KIND_ANGLE_SWAPPED,
    KIND_ANGLE_SIGN,
    KIND_ANGLE_SCALE,
    KIND_ANGLE_NOISE,
    KIND_ANGLE_FLIPS,
    KIND_ANGLE_NONE,
    KIND_SAMPLES_LOST,
    KIND_LOST_AND_ELSEWHERE,
    KIND_STAMPS,
    KIND_SAMPLES_OLD,
    KIND_APART_FROM_START,
    KIND_TORQUE_BEYOND,
    KIND_TORQUE_NONE,
    KIND_FORCE_BEYOND,
    KIND_FORCE_NONE,
    KIND_DEGC_BEYOND,
    /* These do not: a sensor that lies within what could be. */
    KIND_ANGLE_SMALL,
    KIND_ANGLE_STUCK,
    KIND_ANGLE_DRIFT,
    KIND_ANGLE_LATE,
    KIND_ANGLE_TREMBLE,
    KIND_TORQUE_OFFSET,
    KIND_TORQUE_SCALE,
    KIND_TORQUE_STUCK,
    KIND_FORCE_OFFSET,
    KIND_FORCE_SCALE,
    KIND_FORCE_STUCK,
    KIND_FORCE_SWAPPED,
    KIND_DEGC_OFFSET,
    KIND_COUNT
} kind_t;

typedef enum { ENCODER_MOTOR, ENCODER_LINK } encoder_t;

typedef struct {
    kind_t kind;
    int joint;
    encoder_t encoder;
    int32_t from, until; /* ticks */
    double size, other;  /* what they are depends on the kind */
    uint32_t variant;    /* of a kind that has several */
    uint32_t lots;
    sensors_t at_begin;  /* what the sensors said as it began */
} fault_t;

const char *kind_name(kind_t kind);
const char *kind_says(kind_t kind);
bool kind_breaks_a_bound(kind_t kind);

/* A fault of this kind on this limb, from a tick on. returns whether there can be one: the limb has the sensor, and the
 * change is one of that kind. */
bool fault_draw(fault_t *fault, kind_t kind, const plant_t *plant, int32_t from, uint32_t seed);

/* What the sensors say with the fault. tick_us: the time of this tick */
void fault_spoil(fault_t *fault, const plant_t *plant, int32_t tick, uint32_t tick_us, sensors_t *sensors);

#endif
