/* The only door between the firmware and the world: one struct of functions and a context.
 *
 * The application calls these from its tick and from nowhere else: one caller, never from an interrupt, so an
 * implementation needs no locks towards the firmware, only between its own interrupts and these calls. Nothing blocks
 * longer than stated at each entry. Interrupts of an implementation move bytes and frames into its own ring buffers;
 * they never call the firmware, and use no floating point.
 *
 * To port: start from hal/blank, fill in one entry after another, run hal/selftest; docs/porting.md.
 * Entries marked optional may be null, which means that this board has no such thing.
 */
#ifndef BRACE_HAL_H
#define BRACE_HAL_H

#include <stdbool.h>
#include <stdint.h>

/* What an entry answers: BRACE_HAL_OK or a count >= 0, or one of the refusals. Values never change. */
enum {
    BRACE_HAL_OK = 0,
    BRACE_HAL_AGAIN = -1,         /* not now: no mailbox free, no new sample; ask at the next tick */
    BRACE_HAL_E_UNSUPPORTED = -2, /* this board can not do that (CAN FD on bxCAN) */
    BRACE_HAL_E_RANGE = -3,       /* an argument out of its range: a programming error */
    BRACE_HAL_E_DEVICE = -4,      /* the device refused or does not answer */
    BRACE_HAL_E_BUS_OFF = -5      /* the CAN controller has left the bus; can_recover brings it back */
};

/* ------------------------------------------------------------------------------------------- joints -- */

/* A joint as its drive sees it, joint side of the reduction, in the joint's own sense (theta0, theta1, theta2). */
typedef struct {
    float motor_rad;    /* encoder before the gearbox, divided by the ratio */
    float torque_n_mm;  /* motor torque from its current */
    float link_rad;     /* encoder behind the gearbox; NaN: none */
    float temp_degc;    /* of gearbox or motor; NaN: none */
    uint32_t taken_us;  /* when it was sampled, by now_us */
} brace_hal_joint_t;

/* What the drive's set-point is changed by while the application moves a limb itself: taking up play, loading test.
 * Whoever else commands the posture keeps doing so; this is added. */
typedef struct {
    float offset_rad;         /* added to the joint's set-point */
    float torque_limit_n_mm;  /* the motor's torque stays within +-this; INFINITY: no limit but the drive's own */
} brace_hal_joint_command_t;

/* ---------------------------------------------------------------------------------------------- CAN -- */

typedef struct {
    uint32_t id;     /* 11 bits; no extended identifiers, no remote frames */
    uint8_t length;  /* of data: 0-8; with CAN FD also 12, 16, 20, 24, 32, 48, 64 */
    bool fd;         /* a CAN FD frame, with bit-rate switch */
    uint8_t data[64];
} brace_can_frame_t;

typedef struct {
    uint32_t bit_rate;     /* of arbitration [bit/s]: 125000, 250000, 500000 or 1000000 */
    uint32_t fd_bit_rate;  /* of an FD frame's data [bit/s]; 0: classic CAN only */
    bool listen_only;      /* neither sends nor acknowledges */
    bool loopback;         /* for the self-test: what is sent is received, and the bus neither sees it nor is heard;
                              E_UNSUPPORTED when the controller can not */
} brace_can_setup_t;

typedef struct {
    uint8_t tx_errors, rx_errors;  /* the controller's own counters */
    bool error_passive, bus_off;
    uint32_t frames_lost;          /* received with no room in the ring; saturates */
} brace_can_health_t;

/* ------------------------------------------------------------------------------------------- serial -- */

typedef enum {
    BRACE_SERIAL_CONSOLE = 0,    /* boot banner and crash record, as text */
    BRACE_SERIAL_MODBUS = 1,     /* Modbus RTU */
    BRACE_SERIAL_SLCAN = 2,      /* CAN frames as LAWICEL text, for boards without a transceiver */
    BRACE_SERIAL_MODBUS_TCP = 3, /* Modbus TCP, hosts only: a stream of whole ADUs of however many connections; the
                                    answer goes to the connection of the ADU read last */
    BRACE_SERIAL_PORT_COUNT = 4
} brace_serial_port_t;

typedef enum { BRACE_PARITY_NONE = 0, BRACE_PARITY_EVEN = 1, BRACE_PARITY_ODD = 2 } brace_parity_t;

/* ------------------------------------------------------------------------- non-volatile memory, crash -- */

/* Two slots, each erased as a whole to 0xff and then written in rising order, its first 4096 bytes and what it has
 * beyond them each for itself, each unit once; save that zeros may be written over any unit at any time, and stay.
 * Parameters stand in the former, what the drift check has learned in the latter, up to 32768: some 384 bytes a record,
 * so slots of 16384 bytes or more are worth having. */
enum { BRACE_NVM_SLOT_COUNT = 2 };

typedef struct {
    uint32_t slot_bytes;   /* of each slot [4096, 1048576] */
    uint32_t write_bytes;  /* unit of writing [1, 8]: 1, 2, 4 or 8 */
} brace_nvm_shape_t;

typedef enum {
    BRACE_RESET_POWER = 0,
    BRACE_RESET_REQUESTED = 1, /* hal restart */
    BRACE_RESET_WATCHDOG = 2,
    BRACE_RESET_FAULT = 3, /* a processor fault; the crash record tells */
    BRACE_RESET_PIN = 4
} brace_reset_cause_t;

/* What a processor fault leaves behind, in memory that a reset does not clear. */
typedef struct {
    uint32_t exception;                       /* number of the exception: 3 hard, 4 memory, 5 bus, 6 usage fault */
    uint32_t pc, lr, psr, sp;                 /* where, from where, in what state */
    uint32_t cfsr, hfsr, mmfar, bfar;         /* the processor's own account of why */
    uint32_t uptime_us;                       /* by now_us */
    uint32_t count;                           /* crashes since power came on */
} brace_crash_record_t;

/* --------------------------------------------------------------------------------------------- door -- */

typedef struct {
    void *context; /* handed to every function; lives as long as the firmware runs */
    const char *board; /* name for the banner and the self-test; constant storage */

    /* Time since start [us]; wraps after 71.6 minutes, never runs backwards, steps by at most 10 us. Does not block. */
    uint32_t (*now_us)(void *context);

    /* The newest sample of joint 0-2 (coxa, femur, tibia). Does not block: at most 50 us.
     * returns OK; AGAIN: nothing newer than the last one (joint is written with the last one); E_DEVICE; E_UNSUPPORTED:
     * there is no such joint. joint is untouched on E_... */
    int32_t (*joint_read)(void *context, int32_t joint_index, brace_hal_joint_t *joint);

    /* Optional: the limb can not be moved by the firmware. Takes effect within a tick; holds until the next call or for
     * 100 ms, after which the drive goes back to no offset at 0.1 rad/s and no limit. Does not block.
     * returns OK, E_DEVICE, E_RANGE, E_UNSUPPORTED */
    int32_t (*joint_command)(void *context, int32_t joint_index, const brace_hal_joint_command_t *command);

    /* Optional: no force sensor. Force of the ground on the tip in the limb's plane, x outwards and z up [N]. Does not
     * block. returns OK, AGAIN (the last one again), E_DEVICE */
    int32_t (*tip_force_read)(void *context, float *force_x_n, float *force_z_n);

    /* Bytes of the non-volatile slots. Reading does not block. A write is whole units at a multiple of write_bytes and
     * blocks at most 1 ms, in any mode; an erase may stop the processor for up to 2 s, so it is for the configuration
     * mode only, and the watchdog's patience is longer. When power fails within a call, the units it was about may read
     * as anything, differently each time. returns OK, E_RANGE,
     * E_DEVICE (what was written is not what reads back is NOT checked) */
    brace_nvm_shape_t nvm_shape;
    int32_t (*nvm_read)(void *context, uint32_t slot, uint32_t offset, uint8_t *bytes, uint32_t count);
    int32_t (*nvm_write)(void *context, uint32_t slot, uint32_t offset, const uint8_t *bytes, uint32_t count);
    int32_t (*nvm_erase)(void *context, uint32_t slot);

    /* Optional, all five or none: no CAN. can_setup (re)starts the controller, may block 20 ms; not within the tick.
     * can_send queues one frame: OK, AGAIN, E_BUS_OFF, E_UNSUPPORTED, E_RANGE; queued frames of one identifier leave in
     * order. can_receive: 1 and a frame, or 0. can_recover starts the standard's way back to the bus (128 x 11
     * recessive bits) without waiting for its end. None but can_setup blocks. */
    int32_t (*can_setup)(void *context, const brace_can_setup_t *setup);
    int32_t (*can_send)(void *context, const brace_can_frame_t *frame);
    int32_t (*can_receive)(void *context, brace_can_frame_t *frame);
    int32_t (*can_health)(void *context, brace_can_health_t *health);
    int32_t (*can_recover)(void *context);

    /* Bytes of a serial port. serial_write takes what there is room for, serial_read gives what has come; both answer
     * the count, 0 when none, or E_UNSUPPORTED (no such port on this board), E_DEVICE. Neither blocks.
     * serial_setup: 8 data bits, one stop bit. OK, E_UNSUPPORTED, E_RANGE. */
    int32_t (*serial_setup)(void *context, brace_serial_port_t port, uint32_t baud, brace_parity_t parity);
    int32_t (*serial_write)(void *context, brace_serial_port_t port, const uint8_t *bytes, uint32_t count);
    int32_t (*serial_read)(void *context, brace_serial_port_t port, uint8_t *bytes, uint32_t room);

    /* Tells the watchdog that the firmware lives. Its patience is 2.5 to 5 s (an erase is 2 s). */
    void (*watchdog_feed)(void *context);

    /* Why the processor started, and what the last crash left: 1 and a record, or 0. crash_clear forgets it. */
    brace_reset_cause_t (*reset_cause)(void *context);
    int32_t (*crash_read)(void *context, brace_crash_record_t *record);
    void (*crash_clear)(void *context);

    /* Bytes of the stack that have never been used since start; 0 when it is not known. */
    uint32_t (*stack_unused_bytes)(void *context);

    /* Starts the processor anew, as after a reset. Returns on hosts only. */
    void (*restart)(void *context);
} brace_hal_t;

#endif
