/* A limb controller as the robot's computer sees it: K of now, K elsewhere, forces, sag - over CAN or Modbus.
 *
 *   can0                              SocketCAN
 *   slcan:/dev/ttyACM0[@baud]         SLCAN over a serial device, 115200
 *   tcp://host:port                   SLCAN over TCP
 *   modbus:/dev/ttyUSB0[@baud][/unit] Modbus RTU, 115200 baud 8E1, unit 1
 *   modbus-tcp://host:port[/unit]     Modbus TCP, unit 1
 *
 * Lengths in mm, forces in N, stiffness in N/mm, angles in rad; x outwards, z up. What is not known is NaN, never zero.
 * Every call ends within its time-out and answers a status; brace_client_why then says what, why and what to try. A
 * call that refuses leaves its outputs untouched. One thread per client; several clients may share a bus.
 */
#ifndef BRACE_CLIENT_H
#define BRACE_CLIENT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "brace/measured.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum {
    BRACE_CLIENT_OK = 0,
    BRACE_CLIENT_E_USAGE = -1,       /* a URL or number that can not be */
    BRACE_CLIENT_E_NO_DEVICE = -2,   /* no such interface, device, host or port */
    BRACE_CLIENT_E_NO_KERNEL = -3,   /* this kernel has no CAN */
    BRACE_CLIENT_E_DOWN = -4,        /* the interface is down, the connection was closed */
    BRACE_CLIENT_E_TIMEOUT = -5,     /* the controller is there and did not answer in time */
    BRACE_CLIENT_E_FULL = -6,        /* the bus takes no more: nobody acknowledges, or it is overloaded */
    BRACE_CLIENT_E_SILENT = -7,      /* nothing at all is heard */
    BRACE_CLIENT_E_BIT_RATE = -8,    /* there is something, and it can not be read: a wrong bit or baud rate */
    BRACE_CLIENT_E_NODE = -9,        /* other controllers are heard, this one is not */
    BRACE_CLIENT_E_VERSION = -10,    /* it speaks another dictionary than this library */
    BRACE_CLIENT_E_REFUSED = -11,    /* the controller can not or will not; see brace_client_refusal */
    BRACE_CLIENT_E_UNSUPPORTED = -12 /* not over this kind of bus, or not built in */
} brace_client_status_t;

enum { BRACE_CLIENT_WHY_ROOM = 400 };

typedef struct brace_client brace_client_t;

/* Parts of a snapshot; over CAN FD all of them come with each. */
enum {
    BRACE_PART_K = 1,           /* K, flags, play states: with every snapshot sent, 200 Hz (controller.stiffness_hz) */
    BRACE_PART_EIGENVALUES = 2, /* lambda_min, lambda_max, stiff axis: 20 Hz (controller.posture_hz) */
    BRACE_PART_POSTURE = 4,     /* joint angles, mode, faults: 20 Hz */
    BRACE_PART_ALL = 7
};

typedef struct {
    uint32_t parts;       /* that are of this snapshot; members of the others are NaN or all ones */
    uint32_t sequence;    /* 8 bits over CAN, over CAN FD too */
    uint64_t received_us; /* when its first frame came, CLOCK_MONOTONIC */
    float age_ms;         /* of the samples when it was sent; over classic CAN 127 at most */
    bool k_is_valid;      /* K may be used, with its flags */
    uint32_t flags;       /* BRACE_CLIENT_FLAG_... */
    float k_xx_n_per_mm, k_xz_n_per_mm, k_zz_n_per_mm;
    uint32_t play_femur, play_tibia; /* 0 unknown, 1 taking up, 2 + flank, 3 - flank, 4 crossing, 5 fault */
    uint32_t parameter_tag;          /* low half of the CRC of the parameters in force */
    float lambda_min_n_per_mm, lambda_max_n_per_mm, stiff_axis_rad;
    float theta1_rad, theta2_rad;
    uint32_t mode;   /* 0 start, 1 monitor, 2 configuration, 3 taking up, 4 loading test, 5 fault */
    uint32_t faults; /* bits as docs/protocol.md lists them */
} brace_client_snapshot_t;

/* K at a place that was asked for. */
typedef struct {
    float k_xx_n_per_mm, k_xz_n_per_mm, k_zz_n_per_mm;
    float lambda_min_n_per_mm, lambda_max_n_per_mm, stiff_axis_rad;
    uint32_t flags;
} brace_client_k_t;

enum {
    BRACE_CLIENT_FLAG_UNCALIBRATED = 1,
    BRACE_CLIENT_FLAG_NEAR_SINGULAR = 2,
    BRACE_CLIENT_FLAG_SATURATED = 4,
    BRACE_CLIENT_FLAG_GAP_OPEN = 8,
    BRACE_CLIENT_FLAG_STALE = 16,
    BRACE_CLIENT_FLAG_OUT_OF_RANGE = 32
};

typedef struct {
    float fx_n, fz_n;    /* on the tip */
    float low_n, high_n; /* what any displacement of this size gives at least and at most */
} brace_client_force_t;

typedef struct {
    float margin_n;       /* what may be added along the surface before the foot slides */
    float angle_left_rad; /* from the force to the edge of the friction cone */
    uint32_t contact;     /* 0 holds, 1 slides, 2 lifts */
} brace_client_margin_t;

typedef struct {
    uint32_t node, dictionary_hash;
    uint32_t firmware_version; /* major * 65536 + minor * 256 + patch */
    uint32_t parameter_crc, parameter_origin;
} brace_client_identity_t;

/* Opens a bus, finds the controller, and refuses one that speaks another dictionary. node [1, 127; 0: the first that is
 * heard] counts on CAN only; a Modbus URL names its unit. bit_rate [bit/s; 0: 1 000 000] is set on SLCAN adapters only.
 * timeout_ms [100, 60 000]: of the whole call; 2500 finds what is there. On anything but OK *client is null and why,
 * when not null, gets one line (at most why_room characters with its end). */
brace_client_status_t brace_client_open(const char *url, uint32_t node, uint32_t bit_rate, int timeout_ms,
                                        brace_client_t **client, char *why, unsigned why_room);

/* Closes and frees; null is fine. */
void brace_client_close(brace_client_t *client);

void brace_client_identity(const brace_client_t *client, brace_client_identity_t *identity);

/* The newest snapshot that is whole in the wanted parts (of BRACE_PART_ALL) and was not read before; waits for the next
 * one when there is none. Its frames are of one tick: they carry one number, came together, and nothing was lost
 * between them. Over Modbus every part is always there, and each call reads anew.
 * returns OK, E_TIMEOUT, E_SILENT, E_BIT_RATE, E_NODE, E_DOWN, E_VERSION */
brace_client_status_t brace_client_read(brace_client_t *client, uint32_t wanted, int timeout_ms,
                                        brace_client_snapshot_t *snapshot);

/* K at true joint angles [rad] that the limb need not have: each from -3.9 to 3.9, and further as far as the limb's
 * model reaches; beyond that it is refused. Over Modbus it is asked again, until the time-out, where another client's
 * question comes between. */
brace_client_status_t brace_client_k_at_posture(brace_client_t *client, float theta1_rad, float theta2_rad,
                                                int timeout_ms, brace_client_k_t *k);

/* K with the tip at a place [mm from the femur axis, -8388 to 8388]. CAN only. */
brace_client_status_t brace_client_k_at_tip(brace_client_t *client, float x_mm, float z_mm, bool knee_up,
                                            int timeout_ms, brace_client_k_t *k);

/* Force on the tip that holds it at a displacement [mm, -838 to 838], with the K of now. This and the sag are refused
 * while K is not valid, or flagged GAP_OPEN: then nothing carries the tip in some direction. CAN only. */
brace_client_status_t brace_client_contact_force(brace_client_t *client, float dx_mm, float dz_mm, int timeout_ms,
                                                 brace_client_force_t *force);

/* Displacement of the tip under a force on it [N, -8388 to 8388], with the K of now. CAN only. */
brace_client_status_t brace_client_sag(brace_client_t *client, float fx_n, float fz_n, int timeout_ms, float *dx_mm,
                                       float *dz_mm);

/* How far the tip's force of now is from sliding on a surface whose normal, towards the limb, points along normal_rad
 * from +x [rad, -3.27 to 3.27], with friction coefficient [0, 10]. Where no force is known it is refused. CAN only. */
brace_client_status_t brace_client_margin(brace_client_t *client, float normal_rad, float friction_ratio,
                                          int timeout_ms, brace_client_margin_t *margin);

/* Number of a measured value, by its member of brace_measured_t.
 * Parameters are numbered as in brace/parameter_list.h. */
#define BRACE_CLIENT_ENTRY(member) (BRACE_ENTRY_MEASURED + (uint32_t)(offsetof(brace_measured_t, member) / 4u))

/* Any entry of the dictionary: of a u32's, of a f32's type. */
brace_client_status_t brace_client_entry_u32(brace_client_t *client, uint32_t index, int timeout_ms, uint32_t *value);
brace_client_status_t brace_client_entry_f32(brace_client_t *client, uint32_t index, int timeout_ms, float *value);

/* What the last call that did not answer OK has to say: one line, what, why, what to try. Never null. */
const char *brace_client_why(const brace_client_t *client);

/* Of the last E_REFUSED: the controller's status (negative, as docs/errors.md lists them) or the Modbus exception. */
int32_t brace_client_refusal(const brace_client_t *client);

/* As the brace command ends: 0 done, 2 usage, 4 no device or time-out, 5 refused, 6 version. */
int brace_client_exit_code(brace_client_status_t status);

#ifdef __cplusplus
}
#endif
#endif
