/* The door (brace_hal.h) on a POSIX host: clock, non-volatile memory, CAN and serial ports of a controller that runs as
 * a process. The program provides joints and force sensor (brace_posix_limb_t).
 *
 *   bus      one CAN bus in the process. Any number of its controllers are on it, and it is joined to one outside
 *     world:
 *            nothing, SLCAN over tcp (several clients at once), SLCAN on a pty or tty, or SocketCAN
 *   stream   a serial port: nothing, stderr, a file, a pty, a tty, a tcp listener for one client
 *   modbus   a Modbus TCP listener that cuts requests by their MBAP length
 *   nvm      two slots in memory, or in a file
 *
 * Only the file's write to disk blocks. A client that reads slowly loses frames, which are counted, but costs no time.
 * No heap, no global state. One thread uses a brace_posix_bus_t and everything on it. Listeners bind to the host that
 * the URL names, which is loopback unless somebody asks for another. SIGPIPE need not be ignored.
 */
#ifndef BRACE_HAL_POSIX_H
#define BRACE_HAL_POSIX_H

#include <stdbool.h>
#include <stdint.h>

#include "brace_hal.h"

/* Why something could not be opened. When a system call refused, errno says more. */
enum {
    BRACE_POSIX_OK = 0,
    BRACE_POSIX_E_URL = -1, /* not a URL of a known kind */
    BRACE_POSIX_E_IN_USE = -2, /* another program listens on this port, or holds this device */
    BRACE_POSIX_E_NO_DEVICE = -3, /* there is no such device, interface, host or folder */
    BRACE_POSIX_E_NO_CAN = -4, /* this kernel has no CAN */
    BRACE_POSIX_E_DENIED = -5,
    BRACE_POSIX_E_SYSTEM = -6, /* another refusal of the system: errno */
    BRACE_POSIX_E_SIZE = -7 /* the file's size is not that of a controller's memory */
};

/* One line of English for these; constant storage, never null. */
const char *brace_posix_status_text(int32_t status);

enum {
    BRACE_POSIX_NODES = 16, /* controllers on one bus */
    BRACE_POSIX_CLIENTS = 16, /* SLCAN clients of one bus; Modbus TCP connections of one port */
    BRACE_POSIX_RING = 64, /* received frames that wait for a controller; as on the STM32F405 */
    BRACE_POSIX_OUT_BYTES = 32768, /* text that waits for a client */
    BRACE_POSIX_WHERE = 128,
    BRACE_POSIX_SLOT_BYTES = 16384,
    BRACE_POSIX_WRITE_BYTES = 4
};

/* -------------------------------------------------------------------------------------- byte queue -- */

/* Bytes that wait for a reader. */
typedef struct {
    uint32_t start, count;
    uint8_t bytes[BRACE_POSIX_OUT_BYTES];
} brace_posix_queue_t;

/* ---------------------------------------------------------------------------------------- CAN, bus -- */

/* A frame as the bus carries it. Clients may send each other frames that no controller accepts. */
typedef struct {
    brace_can_frame_t frame; /* id: 29 bits when extended */
    bool extended, remote;
} brace_posix_wire_frame_t;

typedef struct {
    int file; /* -1: no client */
    bool open, listen_only, stamps;
    uint32_t bit_rate; /* as the client set it; 0: not set, so the client accepts the bus' rate */
    uint32_t frames_lost; /* frames that found no room: the client reads too slowly */
    uint32_t refused; /* commands answered with BEL */
    uint32_t command_count;
    bool command_too_long;
    char command[160];
    brace_posix_queue_t out;
} brace_posix_slcan_t;

/* A controller on the bus. */
typedef struct {
    bool used, on; /* on: can_setup has been called */
    brace_can_setup_t setup;
    bool fault_bus_off; /* injected: the bus is off and stays off */
    bool bus_off; /* stays until can_recover */
    uint32_t frames_lost, sent, received;
    bool has_urgent; /* a frame of setup.urgent_id waits: the newest, outside the ring */
    brace_can_frame_t urgent;
    uint32_t start, count;
    brace_can_frame_t ring[BRACE_POSIX_RING];
} brace_posix_node_t;

typedef enum {
    BRACE_POSIX_BUS_NONE = 0,
    BRACE_POSIX_BUS_TCP = 1,
    BRACE_POSIX_BUS_LINE = 2, /* pty or tty */
    BRACE_POSIX_BUS_SOCKETCAN = 3
} brace_posix_bus_kind_t;

typedef struct {
    brace_posix_bus_kind_t kind;
    char where[BRACE_POSIX_WHERE]; /* the place that a client connects to: tcp://127.0.0.1:29536, /dev/pts/3, vcan0 */
    int listener, kept; /* kept: the pty's other end, held open so that the pty outlives its clients */
    int socket_can;
    bool socket_can_fd;
    uint32_t socket_lost; /* frames that the kernel had no room for */
    uint32_t milliseconds; /* for clients that want time stamps */
    brace_posix_slcan_t client[BRACE_POSIX_CLIENTS];
    brace_posix_node_t node[BRACE_POSIX_NODES];
} brace_posix_bus_t;

/* Opens the bus' connection to the outside.
 *   url: "none"; "tcp://HOST:PORT" listens there for SLCAN clients, port 0 any free one; "slcan:pty" makes a pty;
 *     "slcan:/dev/ttyX[@BAUD]" speaks SLCAN on a serial line; anything else is the name of a SocketCAN interface
 * returns BRACE_POSIX_OK or the reason; on a refusal nothing stays open. */
int32_t brace_posix_bus_open(brace_posix_bus_t *bus, const char *url);
void brace_posix_bus_close(brace_posix_bus_t *bus);

/* Takes the frames that have come from outside and sends those that wait. Call it once a tick; it does not block.
 * now_us is for time stamps. */
void brace_posix_bus_poll(brace_posix_bus_t *bus, uint32_t now_us);

/* The number of clients with an open channel. */
uint32_t brace_posix_bus_clients(const brace_posix_bus_t *bus);

/* ------------------------------------------------------------------------------------------ serial -- */

typedef enum {
    BRACE_POSIX_STREAM_NONE = 0,
    BRACE_POSIX_STREAM_FILE = 1, /* also stderr: written, never read */
    BRACE_POSIX_STREAM_PTY = 2,
    BRACE_POSIX_STREAM_TTY = 3,
    BRACE_POSIX_STREAM_TCP = 4
} brace_posix_stream_kind_t;

typedef struct {
    brace_posix_stream_kind_t kind;
    char where[BRACE_POSIX_WHERE];
    int file, kept, listener;
} brace_posix_stream_t;

/* url: "none", "stderr", "file:PATH" (appends), "pty", "/dev/ttyX[@BAUD]", "tcp://HOST:PORT" (one client at a time).
 * returns as brace_posix_bus_open */
int32_t brace_posix_stream_open(brace_posix_stream_t *stream, const char *url);
void brace_posix_stream_close(brace_posix_stream_t *stream);

/* Bytes of a stream that is no serial port of a controller: as serial_write and serial_read of the door. */
int32_t brace_posix_stream_write(brace_posix_stream_t *stream, const uint8_t *bytes, uint32_t count);
int32_t brace_posix_stream_read(brace_posix_stream_t *stream, uint8_t *bytes, uint32_t room);

/* ---------------------------------------------------------------------------------------- Modbus TCP -- */

enum { BRACE_POSIX_ADU_BYTES = 260, BRACE_POSIX_ADUS_BYTES = 4096 /* of one connection, that wait to be read */ };

typedef struct {
    int file; /* -1: no connection */
    uint32_t serial; /* number of the connection, so that an answer never reaches a later one */
    uint32_t last_poll; /* poll in which it last sent something */
    uint32_t start, count;
    uint8_t in[BRACE_POSIX_ADUS_BYTES];
    brace_posix_queue_t out;
} brace_posix_modbus_client_t;

typedef struct {
    int listener;
    char where[BRACE_POSIX_WHERE];
    uint32_t polls, serials, next;
    uint32_t refused; /* connections dropped because they sent no Modbus */
    uint32_t current_serial; /* the connection of the ADU that was read last */
    uint32_t given, whole; /* bytes of the ADU that is being read: given so far, and all */
    uint8_t adu[BRACE_POSIX_ADU_BYTES];
    brace_posix_modbus_client_t client[BRACE_POSIX_CLIENTS];
} brace_posix_modbus_t;

/* url: "none", "modbus-tcp://HOST:PORT[/UNIT]"; port 0 takes any free one. returns as brace_posix_bus_open */
int32_t brace_posix_modbus_open(brace_posix_modbus_t *modbus, const char *url);
void brace_posix_modbus_close(brace_posix_modbus_t *modbus);

/* --------------------------------------------------------------------------------- non-volatile memory -- */

typedef struct {
    int file; /* -1: memory only */
    bool fails; /* injected: write and erase answer E_DEVICE */
    bool forgets; /* injected: write and erase answer OK and change nothing */
    uint8_t bytes[BRACE_NVM_SLOT_COUNT][BRACE_POSIX_SLOT_BYTES];
} brace_posix_nvm_t;

/* path: the file with both slots, created (erased) if it does not exist; null: memory only, erased. One process at a
 * time holds a file. is_new (optional): nothing has ever been written. returns as brace_posix_bus_open, E_SIZE */
int32_t brace_posix_nvm_open(brace_posix_nvm_t *nvm, const char *path, bool *is_new);
void brace_posix_nvm_close(brace_posix_nvm_t *nvm);

/* ------------------------------------------------------------------------------------------- the door -- */

/* Joints and force sensor, as in brace_hal_t; tip_force_read and joint_command may be null. */
typedef struct {
    void *context;
    int32_t (*joint_read)(void *context, int32_t joint_index, brace_hal_joint_t *joint);
    int32_t (*joint_command)(void *context, int32_t joint_index, const brace_hal_joint_command_t *command);
    int32_t (*tip_force_read)(void *context, float *force_x_n, float *force_z_n);
} brace_posix_limb_t;

typedef struct {
    brace_posix_limb_t limb;
    bool time_is_given; /* now_us is given_us; else the system's monotonic clock since brace_posix_init */
    uint32_t given_us;
    int64_t started_ns;
    brace_posix_bus_t *bus; /* null: no CAN */
    uint32_t node; /* index of this controller among the bus' nodes */
    brace_posix_nvm_t nvm;
    brace_posix_stream_t stream[BRACE_SERIAL_SLCAN + 1];
    brace_posix_modbus_t modbus;
    uint32_t fed_us; /* time at which the watchdog was last fed */
    bool restart_asked;
    brace_reset_cause_t cause;
    bool is_guarded; /* the board keeps a key: */
    bool has_key;
    uint8_t key[BRACE_HAL_KEY_BYTES];
} brace_posix_t;

/* Sets everything closed, the clock to zero, and the memory erased. */
void brace_posix_init(brace_posix_t *posix);

/* Takes a free place on the bus. false: no place is free. */
bool brace_posix_join(brace_posix_t *posix, brace_posix_bus_t *bus);

/* Fills in the door; posix has to live longer than the door. */
void brace_posix_hal(brace_posix_t *posix, brace_hal_t *hal);

/* Takes what has come over serial ports and Modbus connections, and sends what waits. Call it once a tick; it does not
 * block. */
void brace_posix_poll(brace_posix_t *posix);

/* Closes everything except the bus, and leaves the bus. */
void brace_posix_close(brace_posix_t *posix);

#endif
