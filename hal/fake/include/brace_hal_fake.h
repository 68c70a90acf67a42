/* A controller board that exists in memory only, for tests: the test scripts its samples and provokes its faults, and
 * it counts every call.
 *
 *     static brace_fake_t fake;
 *     brace_fake_start(&fake);
 *     fake.joint[1].sample.motor_rad = 0.3f;                      the femur's drive will report this
 *     brace_fake_fail(&fake, BRACE_FAKE_JOINT_READ, 10, 19, BRACE_HAL_E_DEVICE);   calls 10 to 19 fail
 *     brace_app_start(&app, &fake.hal);
 *
 * Time stands still until the test sets now_us. The test may write every member between calls. The fake has no clock
 * and no heap.
 */
#ifndef BRACE_HAL_FAKE_H
#define BRACE_HAL_FAKE_H

#include "brace_hal.h"

/* The door's entries, which the fake counts and can make fail. */
typedef enum {
    BRACE_FAKE_NOW_US = 0,
    BRACE_FAKE_JOINT_READ,
    BRACE_FAKE_JOINT_COMMAND,
    BRACE_FAKE_TIP_FORCE_READ,
    BRACE_FAKE_NVM_READ,
    BRACE_FAKE_NVM_WRITE,
    BRACE_FAKE_NVM_ERASE,
    BRACE_FAKE_CAN_SETUP,
    BRACE_FAKE_CAN_SEND,
    BRACE_FAKE_CAN_RECEIVE,
    BRACE_FAKE_CAN_HEALTH,
    BRACE_FAKE_CAN_RECOVER,
    BRACE_FAKE_SERIAL_SETUP,
    BRACE_FAKE_SERIAL_WRITE,
    BRACE_FAKE_SERIAL_READ,
    BRACE_FAKE_WATCHDOG_FEED,
    BRACE_FAKE_CRASH_READ,
    BRACE_FAKE_RESTART,
    BRACE_FAKE_ENTRY_COUNT
} brace_fake_entry_t;

enum {
    BRACE_FAKE_SLOT_BYTES = 8192,
    BRACE_FAKE_FRAMES = 64,      /* room of each queue */
    BRACE_FAKE_SERIAL_BYTES = 512,
    BRACE_FAKE_CONNECTIONS = 15,
    BRACE_FAKE_FAILURES = 8,
    BRACE_FAKE_JOINTS = 3
};

typedef struct brace_fake brace_fake_t;

/* A joint: what its drive reports, and the last command it got. */
typedef struct {
    brace_hal_joint_t sample;  /* each read sets taken_us to now_us, unless the joint keeps its own clock */
    bool keeps_taken_us;
    bool absent;               /* joint_read answers E_UNSUPPORTED */
    bool not_newer;            /* joint_read answers AGAIN */
    brace_hal_joint_command_t command; /* the last command */
    uint32_t commanded_us;     /* time of that command */
} brace_fake_joint_t;

/* Calls number first to last (from 1) of an entry return this answer and do nothing else. */
typedef struct {
    brace_fake_entry_t entry;
    uint32_t first, last;
    int32_t answer;
} brace_fake_failure_t;

typedef struct {
    brace_can_frame_t frame[BRACE_FAKE_FRAMES];
    uint32_t first, count;
    uint32_t lost; /* frames that found no room */
} brace_fake_frames_t;

typedef struct {
    uint8_t byte[BRACE_FAKE_SERIAL_BYTES];
    uint32_t first, count;
} brace_fake_bytes_t;

/* A connection of Modbus TCP; its number is its place. */
typedef struct {
    brace_fake_bytes_t received, sent;
} brace_fake_connection_t;

struct brace_fake {
    brace_hal_t hal;
    uint32_t now_us;

    brace_fake_joint_t joint[BRACE_FAKE_JOINTS];
    /* Optional: called before each sample is given out. A test can compute the sample from the commands, as a limb
     * would. */
    void (*play)(void *user, brace_fake_t *fake, int32_t joint_index);
    void *user;
    float force_x_n, force_z_n;
    bool force_not_newer;

    uint8_t nvm[BRACE_NVM_SLOT_COUNT][BRACE_FAKE_SLOT_BYTES];
    bool nvm_forgets;     /* a write answers OK and does nothing */
    uint8_t nvm_stuck;    /* bits that stay 0 in every write */

    brace_can_setup_t can_setup;
    brace_can_health_t can_health;
    uint32_t can_room;    /* frames that may wait to be sent; a further one gets AGAIN */
    bool can_takes_fd;    /* false: CAN FD is refused */
    brace_fake_frames_t can_sent, can_received; /* the test fills can_received */
    bool can_has_urgent;  /* a frame of can_setup.urgent_id waits: the newest, and outside can_received */
    brace_can_frame_t can_urgent;
    bool can_filters;     /* as a board's filters do, drop arriving frames that can_setup's filter keeps out */

    uint32_t baud[BRACE_SERIAL_PORT_COUNT];
    brace_parity_t parity[BRACE_SERIAL_PORT_COUNT];
    brace_fake_bytes_t serial_sent[BRACE_SERIAL_PORT_COUNT], serial_received[BRACE_SERIAL_PORT_COUNT];

    bool has_key;
    uint8_t key[BRACE_HAL_KEY_BYTES];
    uint32_t random;             /* the last word of random_read: another one each time */
    uint32_t peer;               /* number of the connection of Modbus TCP that speaks */
    uint32_t open_from;          /* connections with smaller numbers are closed */
    brace_fake_connection_t connection[BRACE_FAKE_CONNECTIONS]; /* with brace_fake_with_connections */
    uint32_t reads_from, left_of_adu; /* the connection that is read from, and bytes of its ADU that are left */

    brace_reset_cause_t reset_cause;
    brace_crash_record_t crash;
    bool crashed;
    uint32_t stack_unused_bytes;

    uint32_t calls[BRACE_FAKE_ENTRY_COUNT];
    brace_fake_failure_t failure[BRACE_FAKE_FAILURES];
    uint32_t failure_count;
};

/* A board that has just been powered on: three joints at rest, a force sensor, CAN, every serial port and erased
 * memory. The struct must stay where it is, because the door's context points to it. */
void brace_fake_start(brace_fake_t *fake);

/* Power off and on: volatile state is as at start, memory is kept, and the reset cause is the given one. */
void brace_fake_reset(brace_fake_t *fake, brace_reset_cause_t cause);

/* Removes optional parts of the door. */
void brace_fake_without_can(brace_fake_t *fake);
void brace_fake_without_commands(brace_fake_t *fake);
void brace_fake_without_force(brace_fake_t *fake);

/* A guarded board. key: null: it has none yet. Before brace_app_start. */
void brace_fake_guarded(brace_fake_t *fake, const uint8_t key[BRACE_HAL_KEY_BYTES]);

/* A board whose port of Modbus TCP has several connections: members peer and open_from. */
void brace_fake_with_peers(brace_fake_t *fake);

/* The same with BRACE_FAKE_CONNECTIONS of them, which hand over their ADUs in turn. What arrives is put whole into
 * connection[].received, answers are in connection[].sent. */
void brace_fake_with_connections(brace_fake_t *fake);
bool brace_fake_adu_arrives(brace_fake_t *fake, uint32_t connection, const uint8_t *bytes, uint32_t count);

/* Makes calls fail. Takes at most BRACE_FAKE_FAILURES rules; false when there is no room for another. */
bool brace_fake_fail(brace_fake_t *fake, brace_fake_entry_t entry, uint32_t first, uint32_t last, int32_t answer);

/* Makes the next `count` calls fail. */
bool brace_fake_fail_next(brace_fake_t *fake, brace_fake_entry_t entry, uint32_t count, int32_t answer);

/* A frame arrives, or the test takes a frame that was sent. false: no room for the first, or no frame to take. An
 * urgent frame always finds room. */
bool brace_fake_frame_arrives(brace_fake_t *fake, const brace_can_frame_t *frame);
bool brace_fake_frame_take(brace_fake_t *fake, brace_can_frame_t *frame);

/* Bytes arrive at a port, or the test takes the bytes that were written to it. Both return how many. */
uint32_t brace_fake_bytes_arrive(brace_fake_t *fake, brace_serial_port_t port, const uint8_t *bytes, uint32_t count);
uint32_t brace_fake_bytes_take(brace_fake_t *fake, brace_serial_port_t port, uint8_t *bytes, uint32_t room);

#endif
