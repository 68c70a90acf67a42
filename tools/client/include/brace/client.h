/* A limb controller as the robot's computer sees it: K of now and the load that it counts, K elsewhere and under other
 * forces, sag, over CAN or Modbus.
 *
 *   can0                              SocketCAN
 *   slcan:/dev/ttyACM0[@baud]         SLCAN over a serial device, 115200
 *   tcp://host:port                   SLCAN over TCP
 *   modbus:/dev/ttyUSB0[@baud][/unit] Modbus RTU, 115200 baud 8E1, unit 1
 *   modbus-tcp://host:port[/unit]     Modbus TCP, unit 1
 *
 * Lengths in mm, forces in N, stiffness in N/mm, angles in rad; x outwards, z up. An unknown value is NaN, never zero.
 * Every call ends within its time-out and returns a status; brace_client_why then says what, why and what to try. A
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

#include "brace/code_names.h"

typedef enum {
    BRACE_CLIENT_OK = 0,
    BRACE_CLIENT_E_USAGE = -1,       /* the URL cannot be read, or a number is out of range */
    BRACE_CLIENT_E_NO_DEVICE = -2,   /* there is no such interface, device, host or port */
    BRACE_CLIENT_E_NO_KERNEL = -3,   /* this kernel has no CAN */
    BRACE_CLIENT_E_DOWN = -4,        /* the interface is down, or the connection was closed */
    BRACE_CLIENT_E_TIMEOUT = -5,     /* the controller is there, but did not answer in time */
    BRACE_CLIENT_E_FULL = -6,        /* the bus accepts no more: nobody acknowledges, or it is overloaded */
    BRACE_CLIENT_E_SILENT = -7,      /* the bus is silent: nobody sends anything */
    BRACE_CLIENT_E_BIT_RATE = -8,    /* something sends, but it cannot be read: a wrong bit or baud rate */
    BRACE_CLIENT_E_NODE = -9,        /* other controllers send, this one does not */
    BRACE_CLIENT_E_VERSION = -10,    /* the controller uses another dictionary than this library */
    BRACE_CLIENT_E_REFUSED = -11,    /* the controller cannot or will not; brace_client_refusal says why */
    BRACE_CLIENT_E_UNSUPPORTED = -12 /* this kind of bus cannot do it, or it is not built in */
} brace_client_status_t;

enum { BRACE_CLIENT_WHY_ROOM = 400 };

typedef struct brace_client brace_client_t;

/* Parts of a snapshot. A CAN FD frame carries all of them. */
enum {
    BRACE_PART_K = 1,           /* K, flags, play states, mode: in every snapshot, 200 Hz (controller.stiffness_hz) */
    BRACE_PART_EIGENVALUES = 2, /* lambda_min, lambda_max, stiff axis: 20 Hz (controller.posture_hz) */
    BRACE_PART_POSTURE = 4,     /* joint angles, parameter tag: 20 Hz */
    BRACE_PART_ALL = 7,         /* the three parts above, which every limb has */
    BRACE_PART_SPACE = 8,       /* K in space of a limb whose coxa joint is fitted: in every snapshot */
    BRACE_PART_LOAD = 16,       /* the load that K counts: at controller.load_hz, which is 0 at first */
    BRACE_PART_LOAD_ACROSS = 32, /* its y and K across without load, of a limb whose coxa joint is fitted: beside it */
    BRACE_PART_SIGMA = 64, /* how sure K is: 10 Hz (controller.sigma_hz) */
    BRACE_PART_SIGMA_SPACE = 128 /* how sure K in space is, of a limb whose coxa joint is fitted: beside it */
};

/* K in the robot's base frame. */
typedef struct {
    float k_xx_n_per_mm, k_xy_n_per_mm, k_xz_n_per_mm, k_yy_n_per_mm, k_yz_n_per_mm, k_zz_n_per_mm;
    float lambda_n_per_mm[3]; /* eigenvalues, ascending */
    uint32_t flags; /* BRACE_CLIENT_FLAG_... */
} brace_client_space_k_t;

typedef struct {
    bool k_is_valid; /* K in space may be used, with its flags */
    brace_client_space_k_t k;
    float stiff_axis[3]; /* unit vector along which K is largest */
    float theta0_rad; /* true angle of the coxa joint */
    float k_across_n_per_mm; /* K across the limb's plane */
    uint32_t play_coxa; /* state of the coxa joint's backlash, numbered as play_femur */
} brace_client_space_t;

/* One sigma of each value of K in the limb's plane, every gap closed; NaN: not known. */
typedef struct {
    float k_xx_n_per_mm, k_xz_n_per_mm, k_zz_n_per_mm;
    float lambda_min_n_per_mm, lambda_max_n_per_mm, stiff_axis_rad;
} brace_client_sigma_t;

/* The same of K in space, and of K across the limb's plane. */
typedef struct {
    float k_xx_n_per_mm, k_xy_n_per_mm, k_xz_n_per_mm, k_yy_n_per_mm, k_yz_n_per_mm, k_zz_n_per_mm;
    float lambda_n_per_mm[3]; /* of the eigenvalues, ascending */
    float k_across_n_per_mm;
} brace_client_space_sigma_t;

/* The load that K counts, and what it does to the limb. x and z in the limb's plane, y across it, to the left: NaN for
 * a limb in its plane, and over CAN in a snapshot without BRACE_PART_LOAD_ACROSS. */
typedef struct {
    bool is_counted; /* K is the one under this load; else K is the one without load, flagged LOAD_UNKNOWN */
    float force_x_n, force_y_n, force_z_n; /* force of the ground on the tip */
    float unloaded_k_xx_n_per_mm, unloaded_k_xz_n_per_mm, unloaded_k_zz_n_per_mm; /* K without force and weight */
    float unloaded_k_across_n_per_mm; /* the same across the plane */
    float moved_x_mm, moved_y_mm, moved_z_mm; /* how far force and weight have moved the tip */
    float buckling_factor; /* multiple of the load at which the limb, held as it stands, would have no
                                         stiffness left in some direction; infinite: none. Below 3: flag SOFTENED */
    float gravity_direction_rad, gravity_lean_rad; /* where down is: in the plane from +x, and out of the plane */
} brace_client_load_t;

typedef struct {
    uint32_t parts; /* parts that this snapshot has; members of the other parts are NaN or all ones */
    uint32_t sequence; /* 8 bits, over CAN FD too */
    uint64_t received_us; /* time of its first frame, CLOCK_MONOTONIC */
    float age_ms; /* age of the samples when the frame was sent; over classic CAN 127 at most */
    bool k_is_valid; /* K may be used, with its flags */
    uint32_t flags; /* BRACE_CLIENT_FLAG_... */
    float k_xx_n_per_mm, k_xz_n_per_mm, k_zz_n_per_mm;
    uint32_t play_femur, play_tibia; /* 0 unknown, 1 taking up, 2 + side loaded, 3 - side loaded, 4 crossing, 5 fault */
    uint32_t parameter_tag; /* low half of the CRC of the parameters in force */
    float lambda_min_n_per_mm, lambda_max_n_per_mm, stiff_axis_rad;
    float theta1_rad, theta2_rad;
    uint32_t mode; /* 0 start, 1 monitor, 2 configuration, 3 taking up, 4 loading test, 5 fault */
    uint32_t faults; /* bits as docs/protocol.md lists them; all ones: not heard yet. Over CAN they come at a change and
                        with each heartbeat (controller.heartbeat_hz), so these are the newest that were heard */
    brace_client_sigma_t sigma;
    brace_client_space_sigma_t space_sigma;
    brace_client_space_t space;
    brace_client_load_t load;
} brace_client_snapshot_t;

/* K at the place that the caller asked for. */
typedef struct {
    float k_xx_n_per_mm, k_xz_n_per_mm, k_zz_n_per_mm;
    float lambda_min_n_per_mm, lambda_max_n_per_mm, stiff_axis_rad;
    uint32_t flags;
} brace_client_k_t;

/* K at the equilibrium under a force and the limb's weight. */
typedef struct {
    brace_client_k_t k;
    float moved_x_mm, moved_z_mm; /* how far force and weight move the tip there */
    float buckling_factor; /* as in brace_client_load_t */
} brace_client_loaded_k_t;

/* The same in space. */
typedef struct {
    brace_client_space_k_t k;
    float moved_x_mm, moved_y_mm, moved_z_mm; /* as in brace_client_load_t */
} brace_client_loaded_space_k_t;

enum {
    BRACE_CLIENT_FLAG_UNCALIBRATED = 1,
    BRACE_CLIENT_FLAG_NEAR_SINGULAR = 2,
    BRACE_CLIENT_FLAG_SATURATED = 4,
    BRACE_CLIENT_FLAG_GAP_OPEN = 8,
    BRACE_CLIENT_FLAG_STALE = 16,
    BRACE_CLIENT_FLAG_OUT_OF_RANGE = 32,
    BRACE_CLIENT_FLAG_LOAD_UNKNOWN = 64, /* K counts no load */
    BRACE_CLIENT_FLAG_SOFTENED = 128, /* the load has made the limb much softer */
    BRACE_CLIENT_FLAG_MOVED_FAR = 256, /* the load moves the tip further than the accuracy is promised for */
    BRACE_CLIENT_FLAG_PLAY_ASSUMED = 512 /* a joint counts as engaged because the load says so; nothing has proven it */
};

typedef struct {
    float fx_n, fz_n; /* force on the tip */
    float low_n, high_n; /* least and largest force that a displacement of this size gives in any direction */
} brace_client_force_t;

typedef struct {
    float margin_n; /* force that may be added along the surface before the foot slides */
    float angle_left_rad; /* angle from the force to the edge of the friction cone */
    uint32_t contact; /* 0 holds, 1 slides, 2 lifts */
} brace_client_margin_t;

/* What the drift check knows. brace/code_names.h has one sentence for each number. */
typedef struct {
    uint32_t state; /* brace_drift_state_text; 2: drifted */
    uint32_t cause; /* brace_drift_cause_text: the likeliest; 0: none */
    uint32_t could_be; /* every cause that is nearly as likely, a bit each: brace_drift_could_be_text */
    uint32_t next_step; /* brace_drift_next_step_text */
    float evidence; /* the largest log likelihood ratio of all causes; the alarm is at 20 */
    float loss_ratio; /* share of stiffness that the likeliest cause has lost; negative: it has become stiffer */
    float loss_sigma_ratio; /* one sigma of loss_ratio */
    uint32_t since_readings; /* readings of loading tests since the change began; 65535: so many or more */
    uint32_t readings; /* readings taken in since the check began to learn */
} brace_client_drift_t;

typedef struct {
    uint32_t node, dictionary_hash;
    uint32_t firmware_version; /* major * 65536 + minor * 256 + patch */
    uint32_t parameter_crc, parameter_origin;
} brace_client_identity_t;

/* Opens a bus, finds the controller, and refuses one with another dictionary. node [1, 127; 0: the first that sends]
 * counts on CAN only; a Modbus URL names its unit. bit_rate [bit/s; 0: 1 000 000] is set on SLCAN adapters only.
 * timeout_ms [100, 60 000] is for the whole call but the look-up of a host's name; 2500 is enough to find a controller.
 * On anything but OK *client is null and `why`, when not null, gets one line (at most why_room characters with its
 * end). */
brace_client_status_t brace_client_open(const char *url, uint32_t node, uint32_t bit_rate, int timeout_ms,
                                        brace_client_t **client, char *why, unsigned why_room);

/* Closes the client and frees it; null is allowed. */
void brace_client_close(brace_client_t *client);

void brace_client_identity(const brace_client_t *client, brace_client_identity_t *identity);

/* The newest snapshot that has all wanted parts (BRACE_PART_..., added) and was not read before. If there is none, the
 * call waits for the next one; where none comes in time, it gives one that came up to a second before the call. Its
 * frames are of one tick: they carry one number, came together, and nothing was lost between them. Over Modbus the
 * parts of BRACE_PART_ALL are always there, and each call reads anew. BRACE_PART_SPACE, BRACE_PART_LOAD and
 * BRACE_PART_SIGMA are further reads, each of one tick, which may be later than that of the other parts. For K in space
 * of a limb without a coxa joint the call returns E_TIMEOUT over CAN, where no such frame comes, and E_UNSUPPORTED over
 * Modbus.
 * BRACE_PART_LOAD over CAN returns E_TIMEOUT while controller.load_hz is 0; brace_client_load then asks.
 * returns OK, E_USAGE (wanted), E_TIMEOUT, E_SILENT, E_BIT_RATE, E_NODE, E_DOWN, E_VERSION, E_UNSUPPORTED,
 * E_REFUSED (an exception over Modbus) */
brace_client_status_t brace_client_read(brace_client_t *client, uint32_t wanted, int timeout_ms,
                                        brace_client_snapshot_t *snapshot);

/* K at any true joint angles [rad] within -3.9 to 3.9, and further as far as the limb's model reaches; beyond that the
 * controller refuses. Over Modbus the client asks again, until the time-out, when another client's question comes
 * between. */
brace_client_status_t brace_client_k_at_posture(brace_client_t *client, float theta1_rad, float theta2_rad,
                                                int timeout_ms, brace_client_k_t *k);

/* K at any joint angles under a force of the ground on the tip [N, each at most 8388, their magnitudes added at most
 * 10000] and the limb's weight. The angles are those before the load turns the joints; their range is that of
 * brace_client_k_at_posture. The controller refuses where no stable equilibrium is near: the load folds the limb. When
 * another client asks for K under a force at the same time, both ask again, until the time-out. */
brace_client_status_t brace_client_k_under_load_at_posture(brace_client_t *client, float theta1_rad, float theta2_rad,
                                                           float fx_n, float fz_n, int timeout_ms,
                                                           brace_client_loaded_k_t *k);

/* The same with the tip at a place, before the load moves it. */
brace_client_status_t brace_client_k_under_load_at_tip(brace_client_t *client, float x_mm, float z_mm, bool knee_up,
                                                       float fx_n, float fz_n, int timeout_ms,
                                                       brace_client_loaded_k_t *k);

/* The load that K counts now. Over CAN it is asked for value by value, so its values are of several ticks;
 * BRACE_PART_LOAD has them of one. Over Modbus it is one read. */
brace_client_status_t brace_client_load(brace_client_t *client, int timeout_ms, brace_client_load_t *load);

/* Sends the controller where down is: its direction in the limb's plane, from +x, and how far it leans out of the plane
 * [rad; the ranges of gravity.direction_rad and gravity.lean_rad]. It holds until the controller's next start, for
 * every client; the parameters stay as they are. NaN for both: what the parameters say holds again. */
brace_client_status_t brace_client_set_gravity(brace_client_t *client, float direction_rad, float lean_rad,
                                               int timeout_ms);

/* K in space at any true joint angles [rad, -3.27 to 3.27], under the limb's weight. The controller refuses if the limb
 * has no coxa joint. */
brace_client_status_t brace_client_k_in_space(brace_client_t *client, float theta0_rad, float theta1_rad,
                                              float theta2_rad, int timeout_ms, brace_client_space_k_t *k);

/* The same under a force of the ground on the tip, too.
 *   theta_rad: of coxa, femur, knee, before the load turns the joints
 *   force_n: outwards in the limb's plane, across it to the left, upwards [N, each at most 327] */
brace_client_status_t brace_client_k_in_space_under_load(brace_client_t *client, const float theta_rad[3],
                                                         const float force_n[3], int timeout_ms,
                                                         brace_client_loaded_space_k_t *k);

/* K with the tip at a place [mm from the femur axis, -8388 to 8388]. */
brace_client_status_t brace_client_k_at_tip(brace_client_t *client, float x_mm, float z_mm, bool knee_up,
                                            int timeout_ms, brace_client_k_t *k);

/* Force on the tip that holds it at a displacement [mm, -838 to 838], with the present K. The controller refuses this
 * and the sag while K is not valid, or flagged GAP_OPEN: then nothing carries the tip in some direction. CAN only. */
brace_client_status_t brace_client_contact_force(brace_client_t *client, float dx_mm, float dz_mm, int timeout_ms,
                                                 brace_client_force_t *force);

/* Displacement of the tip under a force on it [N, -8388 to 8388], with the present K. CAN only. */
brace_client_status_t brace_client_sag(brace_client_t *client, float fx_n, float fz_n, int timeout_ms, float *dx_mm,
                                       float *dz_mm);

/* How far the tip's present force is from sliding on a surface with a friction coefficient [0, 10]. The surface's
 * normal points towards the limb, along normal_rad from +x [rad, -3.27 to 3.27]. The controller refuses if it knows no
 * force. CAN only. */
brace_client_status_t brace_client_margin(brace_client_t *client, float normal_rad, float friction_ratio,
                                          int timeout_ms, brace_client_margin_t *margin);

/* Why the limb differs from its model, how sure that is, and what to do next. */
brace_client_status_t brace_client_drift(brace_client_t *client, int timeout_ms, brace_client_drift_t *drift);

/* How the last take-up of a joint went (0 coxa, 1 femur, 2 tibia): 0 none, 1 running, 2 held, negative if it failed;
 * brace_take_up_outcome_text of brace/code_names.h says why. */
brace_client_status_t brace_client_take_up(brace_client_t *client, uint32_t joint, int timeout_ms, int32_t *outcome);

/* Number of a measured value, from its member of brace_measured_t. brace/parameter_list.h has the numbers of
 * parameters. */
#define BRACE_CLIENT_ENTRY(member) (BRACE_ENTRY_MEASURED + (uint32_t)(offsetof(brace_measured_t, member) / 4u))

/* Reads any entry of the dictionary, one call for entries of type u32 and one for entries of type f32. */
brace_client_status_t brace_client_entry_u32(brace_client_t *client, uint32_t index, int timeout_ms, uint32_t *value);
brace_client_status_t brace_client_entry_f32(brace_client_t *client, uint32_t index, int timeout_ms, float *value);

/* One line about the last call that did not return OK: what, why, what to try. Never null. */
const char *brace_client_why(const brace_client_t *client);

/* After E_REFUSED: the controller's status (negative, as docs/errors.md lists them) or the Modbus exception. */
int32_t brace_client_refusal(const brace_client_t *client);

/* The exit code that the brace command would use: 0 done, 2 usage, 4 no device or time-out, 5 refused, 6 version. */
int brace_client_exit_code(brace_client_status_t status);

#ifdef __cplusplus
}
#endif
#endif
