/* Written by tools/interface from dictionary.toml; do not edit. */
#ifndef BRACE_CODES_H
#define BRACE_CODES_H

/* What numbers mean: modes, faults, causes, next steps. Names and sentences for people: brace/code_names.h. The
 * constants of the other tables stand in hand-written headers; codes.c asserts that they agree with the dictionary. */

/* What the controller is doing. */
typedef enum {
    /* The controller has started and waits for sound samples of its joints. */
    BRACE_MODE_START = 0,
    /* The controller computes K in every tick; others move the limb. */
    BRACE_MODE_MONITOR = 1,
    /* Parameters may be written; nothing moves the limb, and K is not reported. */
    BRACE_MODE_CONFIGURATION = 2,
    /* The controller takes up the play of joints, holds it, or lets it go. */
    BRACE_MODE_TAKING_UP = 3,
    /* The controller runs a loading test. */
    BRACE_MODE_LOADING_TEST = 4,
    /* A fault makes every K invalid; the mode ends by itself when the fault is over. */
    BRACE_MODE_FAULT = 5
} brace_mode_t;

/* Who may move the limb and write to its controller: docs/security.md. */
typedef enum {
    /* Everybody on the buses: for simulators, emulated boards and a board on a desk. */
    BRACE_SETTING_BENCH = 1,
    /* Whoever has the controller's key, one at a time. */
    BRACE_SETTING_GUARDED = 2,
    /* Nobody: the board is guarded and has no key yet. */
    BRACE_SETTING_NO_KEY = 3
} brace_setting_t;

/* The port of the one whose session is open. */
typedef enum {
    /* No session is open. */
    BRACE_OWNER_NONE = 0,
    /* The program around the controller. */
    BRACE_OWNER_PROGRAM = 1,
    /* A master on CAN. */
    BRACE_OWNER_CAN = 2,
    /* The other end of the SLCAN port. */
    BRACE_OWNER_SLCAN = 3,
    /* The master of the Modbus line. */
    BRACE_OWNER_MODBUS_LINE = 4,
    /* A master over Modbus TCP. */
    BRACE_OWNER_MODBUS_TCP = 5
} brace_owner_t;

/* The likeliest cause of a drift. The core's number of the same cause is one less. */
typedef enum {
    /* No change has shown. */
    BRACE_DRIFT_CAUSE_NONE = 0,
    /* The femur's bending has changed. */
    BRACE_DRIFT_CAUSE_FEMUR_LINK = 1,
    /* The tibia's bending or the knee joint's spring has changed; forces at the tip cannot tell these two apart. */
    BRACE_DRIFT_CAUSE_TIBIA_LINK_OR_KNEE_JOINT = 2,
    /* The femur joint's spring or the base's rotation has changed; forces at the tip cannot tell these two apart. */
    BRACE_DRIFT_CAUSE_FEMUR_JOINT_OR_BASE = 3,
    /* The readings scatter more than their noise, and no change of a part explains it. */
    BRACE_DRIFT_CAUSE_UNEXPLAINED = 4
} brace_drift_cause_code_t;

/* What to do next about a drift. */
typedef enum {
    /* There is nothing to do. */
    BRACE_DRIFT_NEXT_NOTHING = 0,
    /* Go on learning: run loading tests at other postures. */
    BRACE_DRIFT_NEXT_LEARN = 1,
    /* Repeat the loading test at this posture. */
    BRACE_DRIFT_NEXT_REPEAT_TEST = 2,
    /* Run a loading test at another posture: it tells apart the causes that are left. */
    BRACE_DRIFT_NEXT_TEST_ANOTHER_POSTURE = 3,
    /* Inspect the femur link. */
    BRACE_DRIFT_NEXT_INSPECT_FEMUR_LINK = 4,
    /* Inspect the tibia link and the knee joint. */
    BRACE_DRIFT_NEXT_INSPECT_TIBIA_LINK_AND_KNEE_JOINT = 5,
    /* Inspect the femur joint and the base. */
    BRACE_DRIFT_NEXT_INSPECT_FEMUR_JOINT_AND_BASE = 6,
    /* Check the force sensor and how the limb is mounted. */
    BRACE_DRIFT_NEXT_CHECK_SENSOR_AND_MOUNTING = 7
} brace_drift_next_t;

/* What is wrong with the controller or the limb; a bit stays set while its cause does. */
enum {
    /* The femur joint's drive gives no sound sample. */
    BRACE_FAULT_SENSOR_FEMUR = 1u << 0,
    /* The tibia joint's drive gives no sound sample. */
    BRACE_FAULT_SENSOR_TIBIA = 1u << 1,
    /* A motor's torque works and its angle does not follow, or a joint's sensor reports the same whatever the limb
     * does. */
    BRACE_FAULT_ENCODER_STUCK = 1u << 2,
    /* A tick came more than two periods late. */
    BRACE_FAULT_TICK_LATE = 1u << 3,
    /* Neither slot holds a valid parameter set: the controller uses safe defaults, and K is UNCALIBRATED. */
    BRACE_FAULT_PARAMETERS = 1u << 4,
    /* The non-volatile memory does not keep what is written to it. */
    BRACE_FAULT_STORE = 1u << 5,
    /* The CAN controller has left the bus after too many errors, or does not come onto it. */
    BRACE_FAULT_CAN_BUS_OFF = 1u << 6,
    /* Measurement and model have drifted apart; drift_cause names the likeliest cause. */
    BRACE_FAULT_MODEL_DRIFT = 1u << 7,
    /* The last start came after a crash; the record says more. */
    BRACE_FAULT_CRASHED = 1u << 8,
    /* The coxa joint's drive gives no sound sample. */
    BRACE_FAULT_SENSOR_COXA = 1u << 9,
    /* A drive has refused its commands for 50 ms; what moved the limb was ended. */
    BRACE_FAULT_DRIVE_REFUSES = 1u << 10,
    /* Parameters or constants in RAM have changed by themselves; they are taken from the store again. */
    BRACE_FAULT_MEMORY = 1u << 11,
    /* A parameter set was stored and is not whole any more: the set before it is in force, and K is UNCALIBRATED. */
    BRACE_FAULT_OLD_PARAMETERS = 1u << 12,
    /* An encoder of the coxa joint says what cannot be: it has jumped further than the joint can turn, or
     * contradicts the other one. */
    BRACE_FAULT_JUMP_COXA = 1u << 13,
    /* An encoder of the femur joint says what cannot be: it has jumped further than the joint can turn, or
     * contradicts the other one. */
    BRACE_FAULT_JUMP_FEMUR = 1u << 14,
    /* An encoder of the tibia joint says what cannot be: it has jumped further than the joint can turn, or
     * contradicts the other one. */
    BRACE_FAULT_JUMP_TIBIA = 1u << 15
};
enum { BRACE_FAULT_COUNT = 16 };
/* X(fault, code) for every fault in the order of the bits: its CANopen emergency code. */
#define BRACE_FAULTS(X) \
    X(BRACE_FAULT_SENSOR_FEMUR, 0x7300) \
    X(BRACE_FAULT_SENSOR_TIBIA, 0x7300) \
    X(BRACE_FAULT_ENCODER_STUCK, 0x7305) \
    X(BRACE_FAULT_TICK_LATE, 0x6100) \
    X(BRACE_FAULT_PARAMETERS, 0x6320) \
    X(BRACE_FAULT_STORE, 0x5530) \
    X(BRACE_FAULT_CAN_BUS_OFF, 0x8140) \
    X(BRACE_FAULT_MODEL_DRIFT, 0xff01) \
    X(BRACE_FAULT_CRASHED, 0x6010) \
    X(BRACE_FAULT_SENSOR_COXA, 0x7300) \
    X(BRACE_FAULT_DRIVE_REFUSES, 0x7120) \
    X(BRACE_FAULT_MEMORY, 0x5510) \
    X(BRACE_FAULT_OLD_PARAMETERS, 0x6320) \
    X(BRACE_FAULT_JUMP_COXA, 0x7305) \
    X(BRACE_FAULT_JUMP_FEMUR, 0x7305) \
    X(BRACE_FAULT_JUMP_TIBIA, 0x7305)

#endif
