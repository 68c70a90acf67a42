/* The only door between the firmware and the world: one struct of functions and a context.
 *
 * The application calls these functions from its tick and from nowhere else. There is one caller, and it is never an
 * interrupt. So an implementation needs locks only between its own interrupts and these calls. Nothing blocks longer
 * than its entry says. Interrupts of an implementation move bytes and frames into its own ring buffers; they never call
 * the firmware, and use no floating point.
 *
 * To port: start from hal/blank, fill in one entry after another, run hal/selftest; docs/porting.md shows each step.
 * An entry marked optional may be null. Then this board has no such thing.
 */
#ifndef BRACE_HAL_H
#define BRACE_HAL_H

#include <stdbool.h>
#include <stdint.h>

/* What an entry returns: BRACE_HAL_OK or a count >= 0, or one of these refusals. The values never change. */
enum {
    BRACE_HAL_OK = 0,
    BRACE_HAL_AGAIN = -1,         /* not now: no mailbox is free, or no sample is new; ask again in the next tick */
    BRACE_HAL_E_UNSUPPORTED = -2, /* this board cannot do that (CAN FD on bxCAN) */
    BRACE_HAL_E_RANGE = -3,       /* an argument is outside its range: a programming error */
    BRACE_HAL_E_DEVICE = -4,      /* the device refused or does not answer */
    BRACE_HAL_E_BUS_OFF = -5,     /* the CAN controller has left the bus; can_recover brings it back */
    BRACE_HAL_E_DAMAGED = -6      /* what the memory holds is neither blank nor whole */
};

/* ------------------------------------------------------------------------------------------- joints -- */

/* A joint as its drive sees it: on the joint's side of the reduction, positive as theta0, theta1, theta2 are. */
typedef struct {
    float motor_rad;    /* encoder before the gearbox, divided by the ratio; NaN: there is none, but link_rad */
    float torque_n_mm;  /* motor torque from its current */
    float link_rad;     /* true joint angle, by an encoder behind the gearbox; NaN: there is none */
    float temp_degc;    /* temperature of gearbox or motor; NaN: nothing measures it */
    uint32_t taken_us;  /* time of the sample, on the clock of now_us */
} brace_hal_joint_t;

/* What the application adds to a drive's set-point while it moves the limb itself: to take up backlash, or for a
 * loading test. Whoever else commands the posture goes on doing so; the drive follows the sum. */
typedef struct {
    float offset_rad;         /* added to the joint's set-point */
    float torque_limit_n_mm;  /* the motor's torque stays within +-this; INFINITY: only the drive's own limit holds */
} brace_hal_joint_command_t;

/* ---------------------------------------------------------------------------------------------- CAN -- */

typedef struct {
    uint32_t id;     /* 11 bits; no extended identifiers, no remote frames */
    uint8_t length;  /* bytes of data: 0-8; with CAN FD also 12, 16, 20, 24, 32, 48, 64 */
    bool fd;         /* a CAN FD frame, with bit-rate switch */
    uint8_t data[64];
} brace_can_frame_t;

typedef struct {
    uint32_t bit_rate;     /* bit rate of arbitration [bit/s]: 125000, 250000, 500000 or 1000000 */
    uint32_t fd_bit_rate;  /* bit rate of an FD frame's data [bit/s]; 0: classic CAN only */
    bool listen_only;      /* the controller neither sends nor acknowledges */
    bool loopback;         /* for the self-test: the controller receives what it sends, and the bus neither sees nor
                              disturbs it; can_setup returns E_UNSUPPORTED where the controller cannot do that */
    uint32_t filter_id, filter_mask; /* only frames whose identifier has filter_id's bits under the mask take room in
                              the ring; mask 0: all frames. By the controller's own filters, else in its interrupt */
    uint32_t urgent_id;    /* frames of this identifier pass whatever filter_id is, take no room in the ring, and
                              can_receive gives them before all others. At least one is kept until it is taken,
                              however full the ring is; more of them, which say the same, may be dropped and count as
                              no frames_lost. 0: there is none */
} brace_can_setup_t;

typedef struct {
    uint8_t tx_errors, rx_errors;  /* the controller's own counters */
    bool error_passive;
    bool bus_off;                  /* it has left the bus, or has not come onto it since can_setup */
    uint32_t frames_lost;          /* frames but urgent ones that found no room in the ring; saturates */
} brace_can_health_t;

/* ------------------------------------------------------------------------------------------- serial -- */

typedef enum {
    BRACE_SERIAL_CONSOLE = 0,    /* boot banner and crash record, as text */
    BRACE_SERIAL_MODBUS = 1,     /* Modbus RTU */
    BRACE_SERIAL_SLCAN = 2,      /* CAN frames as LAWICEL text, for boards without a transceiver */
    BRACE_SERIAL_MODBUS_TCP = 3, /* Modbus TCP, hosts only: a stream of whole ADUs of all connections, one of each in
                                    turn; serial_peer says whose was read last, serial_write_to answers */
    BRACE_SERIAL_PORT_COUNT = 4
} brace_serial_port_t;

typedef enum { BRACE_PARITY_NONE = 0, BRACE_PARITY_EVEN = 1, BRACE_PARITY_ODD = 2 } brace_parity_t;

/* ------------------------------------------------------------------------- non-volatile memory, crash -- */

/* Two slots. An erase sets a whole slot to 0xff. Then each unit is written once, in rising order. The first 4096 bytes
 * and the bytes behind them count separately: each part has its own rising order. Zeros may be written over any unit at
 * any time, and stay. The first part holds the parameters, the second what the drift check has learned. The firmware
 * uses at most 32768 bytes of a slot. A record of the drift check takes some 384 bytes, so choose slots of 16384 bytes
 * or more. */
enum { BRACE_NVM_SLOT_COUNT = 2 };

typedef struct {
    uint32_t slot_bytes;   /* size of each slot [4096, 1048576] */
    uint32_t write_bytes;  /* size of a unit of writing: 1, 2, 4 or 8 */
} brace_nvm_shape_t;

typedef enum {
    BRACE_RESET_POWER = 0,
    BRACE_RESET_REQUESTED = 1, /* restart was called */
    BRACE_RESET_WATCHDOG = 2,
    BRACE_RESET_FAULT = 3, /* a processor fault; the crash record describes it */
    BRACE_RESET_PIN = 4
} brace_reset_cause_t;

/* What a processor fault leaves behind, in memory that a reset does not clear. */
typedef struct {
    uint32_t exception;                       /* number of the exception: 3 hard, 4 memory, 5 bus, 6 usage fault */
    uint32_t pc, lr, psr, sp; /* where it happened, who had called, the processor's state, the stack */
    uint32_t cfsr, hfsr, mmfar, bfar; /* the processor's own registers on the cause */
    uint32_t uptime_us; /* by now_us */
    uint32_t count; /* crashes since power came on */
} brace_crash_record_t;

/* --------------------------------------------------------------------------------------- who may -- */

enum { BRACE_HAL_KEY_BYTES = 16 };

/* What key_read finds. */
enum {
    BRACE_HAL_KEY_NONE = 0, /* the board has none yet */
    BRACE_HAL_KEY_LOCKED = 1, /* one that nothing takes away or replaces */
    BRACE_HAL_KEY_OPEN = 2 /* one that another program on this board can replace */
};

/* What a joint may be commanded at most, whatever its parameters say; of the board's own file. INFINITY: no bound. */
typedef struct {
    float torque_most_n_mm;
    float angle_least_rad, angle_most_rad; /* true joint angle */
    float speed_most_rad_per_s; /* of what the firmware itself adds to the set-point */
} brace_hal_ceiling_t;

/* --------------------------------------------------------------------------------------------- door -- */

typedef struct {
    void *context; /* the first argument of every function; lives as long as the firmware runs */
    const char *board; /* name for the banner and the self-test; constant storage */

    /* Time since start [us]. Wraps after 71.6 minutes, never runs backwards, steps by at most 10 us. Does not block. */
    uint32_t (*now_us)(void *context);

    /* The newest sample of joint 0-2 (coxa, femur, tibia). Blocks for at most 50 us.
     * returns OK; AGAIN: there is nothing newer than last time (joint then holds the last sample again); E_DEVICE;
     * E_UNSUPPORTED: there is no such joint. joint is untouched on E_... */
    int32_t (*joint_read)(void *context, int32_t joint_index, brace_hal_joint_t *joint);

    /* Optional: null where the firmware cannot move the limb. Takes effect within a tick, and holds until the next call
     * or for 100 ms. After that the drive goes back to no offset at 0.1 rad/s, and to no limit. Does not block.
     * returns OK, E_DEVICE, E_RANGE, E_UNSUPPORTED */
    int32_t (*joint_command)(void *context, int32_t joint_index, const brace_hal_joint_command_t *command);

    /* Optional: null where there is no force sensor. Force of the ground on the tip in the limb's plane, x outwards and
     * z up [N]. Does not block. returns OK, AGAIN (the last reading again), E_DEVICE */
    int32_t (*tip_force_read)(void *context, float *force_x_n, float *force_z_n);

    /* Bytes of the non-volatile slots. Reading does not block. A write is of whole units, begins at a multiple of
     * write_bytes, and blocks for at most 1 ms in any mode. An erase may stop the processor for up to 2 s; so the
     * firmware erases in configuration mode only, and the watchdog waits longer than that. When power fails within a
     * call, the units of that call may read as anything, and differently each time. returns OK, E_RANGE, E_DEVICE. An
     * entry need not check that a write reads back; the firmware does. */
    brace_nvm_shape_t nvm_shape;
    int32_t (*nvm_read)(void *context, uint32_t slot, uint32_t offset, uint8_t *bytes, uint32_t count);
    int32_t (*nvm_write)(void *context, uint32_t slot, uint32_t offset, const uint8_t *bytes, uint32_t count);
    int32_t (*nvm_erase)(void *context, uint32_t slot);

    /* Optional: all five, or all null where there is no CAN. can_setup starts the controller anew: OK, E_UNSUPPORTED
     * (no such controller), E_RANGE, E_DEVICE (not now; the tick tries again every 2 s). It may block for 1 ms, and
     * does not wait until the bus is quiet; can_health reports bus_off until then. can_send queues one frame: OK,
     * AGAIN, E_BUS_OFF, E_UNSUPPORTED, E_RANGE. Queued frames of one identifier leave in order. can_receive returns 1
     * and a frame, or 0. can_recover starts the standard's way back to the bus (128 x 11 recessive bits) and does not
     * wait for its end. Only can_setup blocks. */
    int32_t (*can_setup)(void *context, const brace_can_setup_t *setup);
    int32_t (*can_send)(void *context, const brace_can_frame_t *frame);
    int32_t (*can_receive)(void *context, brace_can_frame_t *frame);
    int32_t (*can_health)(void *context, brace_can_health_t *health);
    int32_t (*can_recover)(void *context);

    /* Bytes of a serial port. serial_write takes as many bytes as fit, serial_read gives those that have come. Both
     * return the count (which may be 0), E_UNSUPPORTED (no such port on this board) or E_DEVICE. Neither blocks.
     * serial_setup: 8 data bits, one stop bit. Returns OK, E_UNSUPPORTED, E_RANGE. */
    int32_t (*serial_setup)(void *context, brace_serial_port_t port, uint32_t baud, brace_parity_t parity);
    int32_t (*serial_write)(void *context, brace_serial_port_t port, const uint8_t *bytes, uint32_t count);
    int32_t (*serial_read)(void *context, brace_serial_port_t port, uint8_t *bytes, uint32_t room);

    /* Optional: null where every port has one other end. Number of the connection that the bytes read last came from;
     * no two connections have the same number. Does not block. */
    uint32_t (*serial_peer)(void *context, brace_serial_port_t port);

    /* Optional, with serial_peer: bytes for that connection. Takes all of them, or none where they find no room; for a
     * connection that has closed they are lost, as on a line. Does not block. returns as serial_write */
    int32_t (*serial_write_to)(void *context, brace_serial_port_t port, uint32_t peer, const uint8_t *bytes,
                               uint32_t count);

    /* Optional, with serial_peer: is the connection of that number still open? Does not block. */
    bool (*serial_peer_is_open)(void *context, brace_serial_port_t port, uint32_t peer);

    /* Optional: null where everybody on the board's buses may move the limb, on a bench. The key of this board, from
     * memory of its own: KEY_LOCKED or KEY_OPEN and its bytes, KEY_NONE, E_DAMAGED (a piece of a key, a key that has
     * lost bits, or memory that was locked without one), E_DEVICE (it does not answer). key_write keeps a key, once,
     * and locks it: OK, AGAIN (kept, but not locked; the next start tries again), E_RANGE (there is one already),
     * E_DEVICE; it may block for 2 ms, and is called by the console alone. random_read gives a word
     * that nobody can predict: OK, AGAIN, E_DEVICE; without it a board with a key refuses motion. */
    int32_t (*key_read)(void *context, uint8_t key[BRACE_HAL_KEY_BYTES]);
    int32_t (*key_write)(void *context, const uint8_t key[BRACE_HAL_KEY_BYTES]);
    int32_t (*random_read)(void *context, uint32_t *word);

    /* How long whoever moves the limb may be silent [us]; 0: 130,000. More only where the clock of now_us runs faster
     * than that of people: in a simulation. */
    uint32_t silence_us;

    /* Optional: three ceilings, of coxa, femur and tibia; null: there are none. */
    const brace_hal_ceiling_t *ceiling;

    /* Shows the watchdog that the firmware runs. The watchdog waits 2.5 to 5 s, longer than an erase of 2 s. */
    void (*watchdog_feed)(void *context);

    /* Why the processor started. crash_read: 1 and the record of the last crash, or 0. crash_clear forgets the
     * record. */
    brace_reset_cause_t (*reset_cause)(void *context);
    int32_t (*crash_read)(void *context, brace_crash_record_t *record);
    void (*crash_clear)(void *context);

    /* Bytes of the stack that nothing has used since start; 0 when that is not known. */
    uint32_t (*stack_unused_bytes)(void *context);

    /* Starts the processor anew, as a reset does. Returns on hosts only. */
    void (*restart)(void *context);
} brace_hal_t;

#endif
